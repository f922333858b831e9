"""Quadratic programs: their box is kept exactly, whatever the tolerance, and their steps are the best in it."""

import numpy as np
import pytest
import qpsolvers
from numpy.testing import assert_allclose
from scipy.optimize import lsq_linear

import pin_metaik as mik
from pin_metaik.errors import InvalidSetting, UnknownName
from pin_metaik.ik.refine import QP
from pin_metaik.ik.refine.qp import null_space
from tests.robots_under_test import chain_of

EXACT = [name for name in ("daqp", "quadprog") if name in qpsolvers.available_solvers]
SOLVERS = [name for name in ("osqp", "daqp", "proxqp", "piqp", "quadprog") if name in qpsolvers.available_solvers]

every_solver = pytest.mark.parametrize("solver", SOLVERS)


def problem_of(robot: str, seed: int = 0) -> mik.IKProblem:
    chain = chain_of(robot)
    x = chain.box.sample(np.random.default_rng(seed), 1)[0]
    return mik.IKProblem.of(chain, chain.placements(chain.q(x))[0])


def linearized(problem: mik.IKProblem, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    chain, m = problem.chain, len(problem.rows)
    r, J = np.empty(m), np.empty((chain.n, m))
    square, _ = chain.kernels.linearize(chain.bare, problem.records, problem.rows, x, r, J)
    return r, J.T, square


@pytest.mark.parametrize("tolerance", [1e-5, 1e-2])
def test_with_osqp_no_answer_of_300_is_outside_the_limits(tolerance: float) -> None:
    chain = mik.Chain(mik.load_robot("ur5").model, "tool0", limits={"elbow_joint": (-2.0, 0.5)})
    solver = mik.IKSolver(None, QP(tolerance=tolerance), mik.Budget(evaluations=30))
    X = chain.box.sample(np.random.default_rng(0), 300)
    X[:, ::2] = np.where(X[:, ::2] < 0.0, chain.box.lower[::2], chain.box.upper[::2])  # solutions at their limits
    results = [mik.solve_ik(chain, chain.placements(chain.q(x))[0], solver=solver) for x in X]
    assert all(chain.limits.contains(result.x) for result in results)
    assert np.mean([result.success for result in results]) > 0.4  # 30 evaluations are few: the limits are the point


@every_solver
def test_every_step_stays_in_its_box(solver: str) -> None:
    for robot in ("panda", "kinova"):
        problem = problem_of(robot)
        limits = problem.limits
        step = QP(solver, largest=0.3, tolerance=1e-2).steps(problem)
        for x in problem.box.sample(np.random.default_rng(1), 30):
            x[0] = problem.box.upper[0]  # one joint at a limit
            dx = step(x, *linearized(problem, x))
            assert np.abs(dx).max() <= 0.3
            assert (dx <= limits.upper - x).all()
            assert (dx >= limits.lower - x).all()


@every_solver
def test_the_step_is_the_best_one_in_its_box(solver: str) -> None:
    problem = problem_of("panda")
    step = QP(solver, damping=0.1, largest=0.4, tolerance=1e-8).steps(problem)
    for x in problem.box.sample(np.random.default_rng(2), 10):
        r, J, square = linearized(problem, x)
        damped = np.vstack((J, np.sqrt(0.1 * square + 1e-9) * np.eye(7)))
        box = np.maximum(problem.limits.lower - x, -0.4), np.minimum(problem.limits.upper - x, 0.4)
        best = lsq_linear(damped, np.append(-r, np.zeros(7)), box, method="bvls", tol=1e-14)
        assert_allclose(step(x, r, J, square), best.x, atol=1e-8 if solver in EXACT else 1e-4)


@every_solver
def test_random_poses_are_solved_by_every_solver(solver: str) -> None:
    for robot in ("panda", "kinova"):
        chain = chain_of(robot)
        method = mik.IKSolver(None, QP(solver), mik.Budget(evaluations=2000))
        for x in chain.box.sample(np.random.default_rng(3), 5):
            assert mik.solve_ik(chain, chain.placements(chain.q(x))[0], solver=method).success


def test_bad_tolerances_slow_a_descent_down_and_spoil_nothing() -> None:
    problem = problem_of("ur5")
    starts = problem.box.sample(np.random.default_rng(4), 20)
    coarse, fine = (QP(tolerance=tolerance).refine(problem, starts, 2000) for tolerance in (1e-2, 1e-6))
    assert coarse.met
    assert fine.met
    for refinement in (coarse, fine):
        assert linearized(problem, refinement.x)[2] < 1e-16


def test_a_posture_uses_the_freedom_that_the_target_leaves() -> None:
    chain = chain_of("panda")
    middle = 0.5 * (chain.box.lower + chain.box.upper)
    goals = [chain.placements(chain.q(x))[0] for x in chain.box.sample(np.random.default_rng(5), 40)]
    away = {}
    for posture in (None, "middle", tuple(middle)):
        solver = mik.IKSolver(None, QP(posture=posture), mik.Budget(evaluations=2000))
        results = [mik.solve_ik(chain, goal, solver=solver) for goal in goals]
        assert all(result.success for result in results)
        away[posture] = np.mean([np.linalg.norm(result.x - middle) for result in results])
    assert away["middle"] < 0.95 * away[None]
    assert away["middle"] == away[tuple(middle)]


def test_the_null_space_projection_projects_and_leaves_the_task_alone() -> None:
    J = np.random.default_rng(6).normal(size=(6, 7))
    N = null_space(J, 1e-12)
    assert_allclose(J @ N, 0.0, atol=1e-10)
    assert_allclose(N @ N, N, atol=1e-10)
    assert np.trace(N) == pytest.approx(1.0)


def test_settings_that_make_no_sense_are_refused() -> None:
    with pytest.raises(UnknownName, match=r"no QP solver named 'osqpp'.*osqp"):
        QP("osqpp")
    with pytest.raises(InvalidSetting, match="damping"):
        QP(damping=-1.0)
    with pytest.raises(InvalidSetting, match="largest"):
        QP(largest=0.0)
    with pytest.raises(InvalidSetting, match="posture"):
        QP(posture="low")  # type: ignore[arg-type]
    with pytest.raises(InvalidSetting, match="3 coordinates, the chain 6"):
        QP(posture=(0.0, 0.0, 0.0)).refine(problem_of("ur5"), np.zeros((1, 6)), 10)
