"""Small comparisons, and cases and methods of one's own, for the tests of comparisons."""

import os
import signal
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

import pin_metaik as mik
from pin_metaik.compare import CASES, Answer, Case, Suite, Task
from pin_metaik.compare.folder.store import read_rows

METHODS = ("lm+restarts", "gwo", "mtde@60+dls", "default")
SMALL = Suite(("ur5",), ("singular", "path"), METHODS, tasks=3, seeds=2, budget=300)


class Jumping:
    """Raises for every other target; for the others it answers where it started."""

    name = "jumping"

    def solve(self, problem: mik.IKProblem, x0: np.ndarray, budget: int, rng: np.random.Generator) -> Answer:
        if rng.random() < 0.5:
            raise ZeroDivisionError("one over nothing")
        return Answer(x0, True, 0)


class Spendthrift:
    """Solves everything, and spends one evaluation too many."""

    name = "spendthrift"

    def solve(self, problem: mik.IKProblem, x0: np.ndarray, budget: int, rng: np.random.Generator) -> Answer:
        found = mik.solve_ik(problem.chain, problem.targets[0])
        return Answer(found.x, True, budget + 1)


class Interrupted:
    """Gets a Ctrl-C while it works, on the third target."""

    name = "interrupted"

    def __init__(self) -> None:
        self.calls = 0

    def solve(self, problem: mik.IKProblem, x0: np.ndarray, budget: int, rng: np.random.Generator) -> Answer:
        self.calls += 1
        if self.calls == 4:  # the first call is for warming up
            os.kill(os.getpid(), signal.SIGINT)
        return Answer(x0, False, 1)


def draw_nothing(chain: mik.Chain, rng: np.random.Generator) -> Task:
    raise RuntimeError("no such pose")


JUMPING, SPENDTHRIFT = Jumping(), Spendthrift()
IMPOSSIBLE = Case("impossible", "Nothing.", draw_nothing)
MINE = Case("mine", "Random poses under a name of their own.", CASES["random"].draw)


def rows(folder: Path) -> dict[tuple[Any, ...], Mapping[str, Any]]:
    """The rows of a folder by their names, without times."""
    return {trial.key: trial.reproducible for trial in read_rows(folder)}
