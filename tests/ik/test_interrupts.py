"""Ctrl-C: it reaches whoever called, at once, from a loop of solves as from a batch on all cores."""

import gc
import os
import signal
import threading
import time
from collections.abc import Callable

import numpy as np
import pinocchio as pin
import pytest

import pin_metaik as mik
from pin_metaik.collision import load_scene
from pin_metaik.ik.threads import run_parallel
from tests.robots_under_test import chain_of

DOWN = np.diag([1.0, -1.0, -1.0])
LATE = 3.0  # s of processor time, which other processes do not change; batches stop in hundredths of a second


def interrupt(work: Callable[[], object], after: float) -> float:
    """Press Ctrl-C that many seconds after work begins; the processor time (s) for which the work then goes on.

    The work must not end by itself. All of this is where a KeyboardInterrupt is expected: a busy machine may be late.
    """
    at: list[float] = []

    def press() -> None:
        at.append(time.process_time())
        os.kill(os.getpid(), signal.SIGINT)

    gc.collect()  # threads of former tests: what is raised while their end is noted, Python drops
    with pytest.raises(KeyboardInterrupt):
        threading.Timer(after, press).start()
        work()
    return time.process_time() - at[0]


def cups(count: int) -> np.ndarray:
    """Grasps (count, 4, 4) round a cup, from above at any angle; some of them cannot be met."""
    rng = np.random.default_rng(0)
    poses = np.repeat(np.eye(4)[None], count, axis=0)
    for pose, (around, spin) in zip(poses, rng.uniform(0.0, 2.0 * np.pi, (count, 2)), strict=True):
        pose[:3, :3] = pin.rpy.rpyToMatrix(np.pi, 0.4 * np.cos(around), spin)
        pose[:3, 3] = [0.75 + 0.25 * np.cos(around), 0.25 * np.sin(around), 0.3]
    return poses


@pytest.mark.parametrize("attempt", range(5))
@pytest.mark.parametrize("seeder", ["gwo", "auto"])
def test_a_loop_of_solves_hears_of_it(seeder: str, attempt: int) -> None:
    chain, solver = chain_of("panda"), mik.IKSolver(seeder, "dls")

    def loop() -> None:
        for i in range(10**9):
            mik.solve_ik(chain, pin.SE3(DOWN, np.array([0.4, 0.001 * (i % 60), 0.4])), solver=solver)

    assert interrupt(loop, 0.05 + 0.013 * attempt) < LATE


def batch(world: mik.CollisionWorld | None) -> Callable[[], object]:
    """A batch of 400,000 targets, which no machine is through with before Ctrl-C."""
    chain, targets = chain_of("panda"), np.tile(cups(4_000), (100, 1, 1))
    mik.solve_ik_batch(chain, targets[:4], world=world)
    return lambda: mik.solve_ik_batch(chain, targets, world=world, workers=2)


@pytest.mark.parametrize("scene", [None, "shelf"])
def test_a_batch_stops_and_so_do_its_threads(scene: str | None) -> None:
    world = None if scene is None else mik.CollisionWorld(mik.load_robot("panda"), load_scene(scene))
    work, before = batch(world), threading.active_count()
    for after in (0.02, 0.2, 0.5):
        assert interrupt(work, after) < LATE
        assert threading.active_count() <= before + 1  # the timer that pressed may be ending


def test_everything_at_once_stops_too() -> None:
    chain = chain_of("panda")
    far = chain.poses(chain.box.sample(np.random.default_rng(0), 1))[0, 0]
    calls: list[Callable[[], object]] = [
        lambda: mik.solve_ik_all(chain, far, limit=10**5, budget=mik.Budget(evaluations=10**9)),
        lambda: mik.solve_ik_path(chain, [far] * 10**5),
        lambda: mik.minimize(lambda X: (X**2).sum(axis=1), mik.Box([-1.0], [1.0]), "gwo", mik.Budget(10**9)),
    ]
    mik.solve_ik_all(chain, far, limit=2)  # what has to be compiled first is
    mik.solve_ik_path(chain, [far] * 2)
    for call in calls:
        assert interrupt(call, 0.1) < LATE


def test_an_error_in_one_thread_ends_the_work_of_all() -> None:
    started: list[int] = []
    before = threading.active_count()

    def work(part: int) -> None:
        started.append(part)
        if part == 3:
            raise ZeroDivisionError
        time.sleep(1e-3)

    with pytest.raises(ZeroDivisionError):
        run_parallel(work, range(10_000), 3)
    assert len(started) < 5_000  # a few, where nothing else runs
    assert threading.active_count() <= before


def test_a_refiner_that_spends_nothing_does_not_go_on_for_ever() -> None:
    class Idle:
        def refine(self, problem: mik.IKProblem, starts: np.ndarray, evaluations: int) -> mik.Refinement:
            return mik.Refinement(starts[0], False, 0)

    result = mik.solve_ik(chain_of("panda"), [0.4, 0.1, 0.5], solver=mik.IKSolver(None, Idle()))
    assert result.status is mik.IKStatus.OUT_OF_TOLERANCE
