"""``IKSolver`` is the one door: its refiner and its settings are used wherever there is a search."""

from dataclasses import dataclass, field

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_array_equal

import pin_metaik as mik
from pin_metaik.errors import InvalidSetting
from pin_metaik.ik.refine.descent import Stepwise
from tests.collision.worlds import world_of
from tests.robots_under_test import chain_of


@dataclass
class Counting:
    """Somebody's own refiner: of a library solver, and it notes its calls."""

    calls: list[int] = field(default_factory=list)

    def refine(self, problem: mik.IKProblem, starts: np.ndarray, evaluations: int) -> mik.Refinement:
        self.calls.append(len(starts))
        return mik.DLS().refine(problem, starts, evaluations)


def poses_of(name: str, count: int, seed: int = 0) -> list[pin.SE3]:
    chain = chain_of(name)
    return [chain.placements(q)[0] for q in chain.q(chain.box.sample(np.random.default_rng(seed), count))]


def colliding(name: str, scene: str, count: int) -> list[pin.SE3]:
    """Poses whose first solution collides."""
    chain, world = chain_of(name), world_of(name, scene)
    return [p for p in poses_of(name, 200) if world.in_collision(mik.solve_ik(chain, p).q)][:count]


@pytest.mark.parametrize("select", ["first", "nearest", "manipulability", "limits", lambda q: float(q[0])])
def test_the_refiner_given_is_the_one_that_chooses(select) -> None:
    refiner = Counting()
    result = mik.solve_ik(chain_of("z1"), poses_of("z1", 1)[0], solver=mik.IKSolver(refiner=refiner, select=select))
    assert result.success
    assert refiner.calls


def test_the_refiner_given_finds_all_solutions_and_clears_collisions() -> None:
    refiner = Counting()
    found = mik.solve_ik_all(chain_of("z1"), poses_of("z1", 1)[0], solver=mik.IKSolver(refiner=refiner))
    assert len(found)
    assert refiner.calls
    refiner.calls.clear()
    world, chain, solver = world_of("panda", "shelf"), chain_of("panda"), mik.IKSolver(refiner=refiner)
    poses = [p for p in poses_of("panda", 60) if world.in_collision(mik.solve_ik(chain, p, solver=solver).q)][:2]
    for pose in poses:
        refiner.calls.clear()
        result = mik.solve_ik(chain, pose, world=world, solver=solver)
        assert result.proof is mik.Proof.CONTACT or len(refiner.calls) > 1


def test_all_solutions_by_a_refiner_of_ones_own_are_those_of_the_compiled_loops() -> None:
    chain = chain_of("z1")
    for pose in poses_of("z1", 5):
        ours = mik.solve_ik_all(chain, pose)
        theirs = mik.solve_ik_all(chain, pose, solver=mik.IKSolver(refiner=Counting()))
        assert len(ours) == len(theirs)
        for x in ours.x:
            assert (chain.limits.separation(theirs.x, x).max(axis=1) < 1e-2).any()


def test_gathering_step_by_step_is_gathering_in_the_compiled_loop() -> None:
    chain, rng = chain_of("panda"), np.random.default_rng(4)
    for pose in poses_of("panda", 4):
        problem, starts = mik.IKProblem.of(chain, pose), chain.box.sample(rng, 12)
        rows = []
        for descent in (mik.DLS().descent(), Stepwise(mik.DLS())):
            found = np.empty((40, chain.n))
            spent, known, vain = descent.gather(problem, starts, found, 0, 1e-2, 60, 100_000)
            rows.append((spent, known, vain, found[:known]))
        for ours, theirs in zip(*rows, strict=True):
            assert_array_equal(ours, theirs)


@pytest.mark.parametrize("scene", [None, "shelf"])
def test_solving_a_problem_is_solving_its_target(scene: str | None) -> None:
    world = None if scene is None else world_of("panda", scene)
    chain, far = chain_of("panda"), pin.SE3(np.eye(3), np.array([2.0, 0.0, 0.0]))
    q0 = chain.q(chain.box.sample(np.random.default_rng(9), 1)[0])
    for solver in (mik.IKSolver(), mik.IKSolver("gwo"), mik.IKSolver(select="nearest")):
        for pose in [far, *(poses_of("panda", 3) if scene is None else colliding("panda", "shelf", 3))]:
            one = mik.solve_ik(chain, pose, q0, solver=solver, world=world, rng=5)
            same = solver.solve(mik.IKProblem.of(chain, pose, world), q0, 5)
            assert_array_equal(one.q, same.q)
            assert (one.status, one.proof, one.evaluations) == (same.status, same.proof, same.evaluations)


def test_a_criterion_of_ones_own_is_the_lowest_of_all_solutions() -> None:
    chain = chain_of("ur5")

    def height_of_the_elbow(q: np.ndarray) -> float:
        data = chain.model.createData()
        pin.forwardKinematics(chain.model, data, q)
        return -float(data.oMi[3].translation[2])

    for pose in poses_of("ur5", 10):
        chosen = mik.solve_ik(chain, pose, solver=mik.IKSolver(select=height_of_the_elbow))
        lowest = min(height_of_the_elbow(q) for q in mik.solve_ik_all(chain, pose).q)
        assert height_of_the_elbow(chosen.q) == pytest.approx(lowest, abs=1e-4)


@pytest.mark.parametrize("answer", [None, "low", np.nan, np.zeros(3)])
def test_a_criterion_that_gives_no_number_is_named(answer) -> None:
    solver = mik.IKSolver(select=lambda q: answer)
    with pytest.raises(InvalidSetting, match="select gives a number"):
        mik.solve_ik(chain_of("ur5"), poses_of("ur5", 1)[0], solver=solver)


def test_a_choice_or_all_solutions_without_a_refiner_are_refused() -> None:
    with pytest.raises(InvalidSetting, match="needs a refiner"):
        mik.IKSolver("gwo", None, select="nearest")
    with pytest.raises(InvalidSetting, match="found by a refiner"):
        mik.solve_ik_all(chain_of("ur5"), poses_of("ur5", 1)[0], solver=mik.IKSolver("gwo", None))
