"""What is said of an answer is so: of a success by Pinocchio alone, and of every other by its own numbers."""

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

import pin_metaik as mik
from tests.properties.questions import EVALUATIONS, Question, questions

SOLVERS = (
    mik.IKSolver(),
    mik.IKSolver(None, "lm", starts=3),
    mik.IKSolver("gwo", "dls"),
    mik.IKSolver("de", None),
    mik.IKSolver(None, "qp"),
    mik.IKSolver(select="limits"),
)


@given(questions(), st.sampled_from(SOLVERS), st.sampled_from((1, 7, 100, EVALUATIONS)))
def test_a_success_is_one_and_every_answer_is_inside_the_limits(
    question: Question, solver: mik.IKSolver, evaluations: int
) -> None:
    limited = mik.IKSolver(solver.seeder, solver.refiner, mik.Budget(evaluations), solver.starts, solver.select)
    result = question.solve(solver=limited)
    assert question.inside(result.q)
    assert result.evaluations <= evaluations
    assert bool(result) is result.success is (result.status is mik.IKStatus.SOLVED)
    if result.success:
        assert question.met(result.q)
        assert result.verify()
        assert result.position_error <= question.near and result.orientation_error <= question.aligned
    assert result.status is not mik.IKStatus.UNREACHABLE
    assert isinstance(result.why, str) and result.why.isprintable()
    assert math.isfinite(result.position_error) and math.isfinite(result.orientation_error)
    assert (result.proof is None) or not result.success


@given(questions())
def test_what_can_be_met_is_never_called_out_of_reach(question: Question) -> None:
    assert question.met(question.chain.q(question.x)) or question.near < 1e-6
    for seed in range(2):
        assert question.solve(rng=seed).status is not mik.IKStatus.UNREACHABLE
    one = mik.solve_ik_all(question.chain, question.targets(), limit=4, budget=mik.Budget(evaluations=1_000))
    assert all(question.inside(q) and question.met(q) for q in one.q)
    assert one.complete is None or len(one) > 0


@given(questions(most=8))
def test_what_is_proved_out_of_reach_no_search_reaches(question: Question) -> None:
    away = np.array(question.poses)
    away[:, :3, 3] *= 1.5
    asked = [
        mik.Target(pose, frame, position_tolerance=question.near, orientation_tolerance=question.aligned)
        for frame, pose in zip(question.chain.frames, away, strict=True)
    ]
    budget = mik.Budget(evaluations=EVALUATIONS)
    proved = mik.solve_ik(question.chain, asked, solver=mik.IKSolver(budget=budget))
    other = mik.solve_ik(question.chain, asked, solver=mik.IKSolver(None, "lm", budget), rng=1)
    if proved.status is mik.IKStatus.UNREACHABLE:
        assert proved.proof is not None
        assert not other.success
