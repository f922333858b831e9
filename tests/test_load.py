"""Work that goes on and on, and much of it at once: memory stays, answers stay, and Ctrl-C is heard."""

import asyncio
import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import load
import numpy as np
import pytest

import pin_metaik as mik
from pin_metaik.collision import load_scene
from tests.robots_under_test import chain_of

COUNTS = {"solves": 20_000, "checks": 2_000, "worlds": 100, "paths": 25}
FLAT = 5.0  # MiB
THREADS = 8


@pytest.mark.parametrize("kind", COUNTS)
def test_memory_stays_flat(kind: str) -> None:
    assert load.loaded(kind, COUNTS[kind]).growth < FLAT


def test_eight_threads_on_one_chain_and_one_world_get_the_answers_of_one() -> None:
    chain, world = chain_of("panda"), mik.CollisionWorld(mik.load_robot("panda"), load_scene("shelf"))
    X = chain.box.sample(np.random.default_rng(0), 24)
    poses, Q = chain.poses(X)[:, 0], chain.q(X)

    def asked(i: int) -> tuple[object, ...]:
        free = mik.solve_ik(chain, poses[i], world=world, solver=mik.IKSolver(budget=mik.Budget(evaluations=300)))
        alone = mik.solve_ik(chain, poses[i])
        return (
            free.q.tobytes(),
            free.status,
            alone.q.tobytes(),
            world.in_collision(Q[i]),
            world.min_distance(Q[i]).distance,
        )

    one = list(map(asked, range(len(X))))
    for _ in range(2):
        with ThreadPoolExecutor(THREADS) as pool:
            assert list(pool.map(asked, range(len(X)))) == one


def test_a_loop_of_events_goes_on_while_threads_solve() -> None:
    chain = chain_of("ur5")
    poses = chain.poses(chain.box.sample(np.random.default_rng(0), 20_000))[:, 0]
    ticks = 0

    async def tick() -> None:
        nonlocal ticks
        while True:
            await asyncio.sleep(1e-3)
            ticks += 1

    async def main() -> mik.IKBatch:
        ticking = asyncio.create_task(tick())
        batch = await asyncio.to_thread(mik.solve_ik_batch, chain, poses, workers=1)
        ticking.cancel()
        return batch

    assert asyncio.run(main()).success.mean() > 0.99
    assert ticks >= 3  # the interpreter is free while loops run


ASLEEP = """
import signal, threading, numpy as np, pin_metaik as mik
robot = mik.load_robot("ur5"); chain = mik.Chain(robot, robot.frame)
heard = []
signal.signal(signal.SIGUSR1, lambda *_: heard.append(1))
pose = chain.poses(chain.box.sample(np.random.default_rng(0), 1))[0, 0]
mik.solve_ik(chain, pose)
for _ in range(20):
    signal.raise_signal(signal.SIGUSR1)
    assert mik.solve_ik(chain, pose).success
assert len(heard) == 20
print("ready", flush=True)
while True:
    mik.solve_ik_batch(chain, np.repeat(pose[None], 2000, axis=0))
"""


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_signals_of_ones_own_are_kept_and_the_usual_ones_end_the_process(number: signal.Signals) -> None:
    with subprocess.Popen([sys.executable, "-c", ASLEEP], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as one:
        assert one.stdout is not None and one.stdout.readline() == b"ready\n"
        one.send_signal(number)
        assert one.wait(timeout=60) == -number
