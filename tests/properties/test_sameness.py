"""The same question has the same answer: alone or in a batch, from a pickle, in threads, elsewhere in the world."""

import multiprocessing
import pickle
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from random import Random

import numpy as np
import pinocchio as pin
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_array_equal
from random_models import placement

import pin_metaik as mik
from tests.properties.questions import EVALUATIONS, Question, questions

SOLVER = mik.IKSolver(budget=mik.Budget(evaluations=EVALUATIONS))
COPIES = 8


def said(result: mik.IKResult) -> tuple[bytes, mik.IKStatus, int]:
    return result.q.tobytes(), result.status, result.evaluations


@given(questions())
def test_threads_pickles_and_batches_give_the_same_bits(question: Question) -> None:
    alone = said(question.solve())
    assert said(question.solve()) == alone
    copy = pickle.loads(pickle.dumps(question.chain))
    assert said(mik.solve_ik(copy, question.targets(), question.start, solver=SOLVER, rng=0)) == alone
    with ThreadPoolExecutor(COPIES) as pool:
        assert set(pool.map(lambda _: said(question.solve()), range(COPIES))) == {alone}


@given(questions(), st.integers(1, 3))
def test_a_batch_is_its_targets_one_by_one(question: Question, workers: int) -> None:
    rng = np.random.default_rng(0)
    X = question.chain.box.sample(rng, 5)
    starts = question.chain.q(question.chain.box.sample(rng, 5))
    poses = question.chain.poses(X)
    given = poses[:, 0] if len(question.chain.frames) == 1 else None
    if given is not None:
        batch = mik.solve_ik_batch(question.chain, given, starts, solver=SOLVER, workers=workers)
        for i, pose in enumerate(given):
            one = mik.solve_ik(question.chain, pose, starts[i], solver=SOLVER)
            assert (batch.status[i], batch.evaluations[i]) == (one.status, one.evaluations)
            assert_array_equal(batch.q[i], one.q)


@given(questions(most=8), st.randoms(use_true_random=False))
def test_moving_the_base_and_all_that_is_asked_changes_nothing(question: Question, rnd: Random) -> None:
    base = placement(rnd)
    chain = question.robot.moved(base).chain()
    here = question.solve()
    there = mik.solve_ik(chain, question.targets(base), question.start, solver=SOLVER, rng=0)
    assert mik.IKStatus.UNREACHABLE not in (here.status, there.status)
    if here.success and here.evaluations < 200:  # what takes long may be found by another way, by the last bits
        assert there.success
        assert question.met(there.q)


def solved_elsewhere(handed: bytes) -> list[tuple[bytes, mik.IKStatus, int]]:
    """In another process."""
    chain, asked = pickle.loads(handed)
    return [said(mik.solve_ik(chain, pose, solver=SOLVER, rng=0)) for pose in asked]


@settings(max_examples=1)
@given(st.just("panda"))
def test_a_fork_and_a_fresh_process_give_the_same_bits(name: str) -> None:
    robot = mik.load_robot(name)
    chain = mik.Chain(robot, robot.frame)
    asked = [pin.SE3(pose[0]) for pose in chain.poses(chain.box.sample(np.random.default_rng(0), 20))]
    handed = pickle.dumps((chain, asked))
    here = solved_elsewhere(handed)
    for method in ("fork", "spawn"):
        with ProcessPoolExecutor(1, multiprocessing.get_context(method)) as pool:
            assert pool.submit(solved_elsewhere, handed).result() == here
