"""Kind 23: batches on all cores answer as one process does, whatever starts the others, and Ctrl-C ends them."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest

import pin_metaik as mik
from pin_metaik.collision import batch, load_scene
from pin_metaik.errors import InvalidSetting
from tests.collision.worlds import configurations, robot_of, world_of

SCRIPT = """
import multiprocessing, sys
import numpy as np
import pin_metaik as mik
from pin_metaik.collision import batch
from pin_metaik.collision.touch import random_configurations

def main():
    if sys.argv[1] != "default":
        multiprocessing.set_start_method(sys.argv[1])
    batch.TRIAL, batch.FORKING, batch.STARTING = 1e-3, 0.0, 0.0
    world = mik.CollisionWorld(mik.load_robot("ur5"))
    Q = random_configurations(world.model, np.random.default_rng(0), int(sys.argv[2]))
    world.in_collision(Q[0])
    print("begun", flush=True)
    answers = world.in_collision_batch(Q, workers=2)
    print((answers == world.in_collision_batch(Q, workers=1)).all())
"""


def script(folder: Path, guarded: bool) -> Path:
    path = folder / "script.py"
    path.write_text(SCRIPT + ('if __name__ == "__main__":\n    main()\n' if guarded else "main()\n"))
    return path


@pytest.mark.parametrize("workers", [1, 2, 3])
def test_answers_do_not_depend_on_the_number_of_processes(workers: int, monkeypatch: pytest.MonkeyPatch) -> None:
    world, Q = world_of("ur5", "table"), configurations("ur5", 3001, seed=1)
    hit = np.array([world.in_collision(q) for q in Q])
    distances = np.array([world.min_distance(q).distance for q in Q[:400]])
    for name, seconds in (("TRIAL", 1e-3), ("FORKING", 0.0), ("PART", 2e-3)):
        monkeypatch.setattr(batch, name, seconds)
    for _ in range(2):
        assert (world.in_collision_batch(Q, workers=workers) == hit).all()
    assert (world.min_distance_batch(Q[:400], workers=workers) == distances).all()


def test_processes_have_the_world_as_it_is_now(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, seconds in (("TRIAL", 1e-3), ("FORKING", 0.0), ("PART", 2e-3)):
        monkeypatch.setattr(batch, name, seconds)
    world, Q = mik.CollisionWorld(robot_of("ur5"), load_scene("table")), configurations("ur5", 2000, seed=2)
    before = world.in_collision_batch(Q, workers=2)
    world.remove("table")
    after = world.in_collision_batch(Q, workers=2)
    assert (after <= before).all() and (after != before).any()
    assert (after == world.in_collision_batch(Q, workers=1)).all()


@pytest.mark.parametrize("guarded", [True, False])
def test_processes_that_begin_from_nothing_answer_the_same_and_a_script_without_a_guard_ends(
    guarded: bool, tmp_path: Path
) -> None:
    command = [sys.executable, str(script(tmp_path, guarded)), "spawn", "3000"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.stdout.splitlines()[-1:] == ["True"], done.stderr


@pytest.mark.skipif(os.name != "posix", reason="signals of a terminal")
def test_ctrl_c_ends_a_batch_and_its_processes_at_once(tmp_path: Path) -> None:
    command = [sys.executable, str(script(tmp_path, True)), "default", "3000000"]
    with subprocess.Popen(command, stdout=-1, stderr=-1, text=True, start_new_session=True) as process:
        assert process.stdout
        assert process.stdout.readline() == "begun\n"
        time.sleep(1.0)
        os.killpg(process.pid, signal.SIGINT)  # as a terminal does: to all of them
        printed, stderr = process.communicate(timeout=300)
    assert (process.returncode, printed) == (-signal.SIGINT, "")
    assert stderr.count("Traceback") == 1
    until = time.monotonic() + 60.0  # the last of its processes may be ending
    with pytest.raises(ProcessLookupError):
        while time.monotonic() < until:
            os.killpg(process.pid, 0)
            time.sleep(0.01)


def test_a_process_that_must_have_none_of_its_own_works_alone() -> None:
    with get_context("fork").Pool(1) as pool:  # its processes are daemons
        assert pool.apply(batch._can_start, (2,)) is False
    assert batch._can_start(2)


def test_workers_that_are_none_are_told() -> None:
    for workers in (0, -1, 1.5, "all"):
        with pytest.raises(InvalidSetting, match="workers"):
            world_of("ur5").in_collision_batch(np.zeros((1, 6)), workers=workers)  # type: ignore[arg-type]
    assert world_of("ur5").in_collision_batch(np.empty((0, 6))).shape == (0,)
