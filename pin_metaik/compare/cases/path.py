"""A path: poses in a row, each solved from the answer before; a jump is a failure."""

from __future__ import annotations

import numpy as np

from pin_metaik.compare.cases.case import Attempt, Case, Task
from pin_metaik.kinematics import Chain

POSES, FAR, BOUND = 20, 1.0, 0.15  # of each joint from end to end, and from one pose to the next, rad or m


def draw(chain: Chain, rng: np.random.Generator) -> Task:
    """Poses along a straight line in joint space, each joint at most 0.05 rad or m from one to the next."""
    start = chain.box.sample(rng, 1)[0]
    end = np.clip(start + rng.uniform(-FAR, FAR, chain.n), chain.box.lower, chain.box.upper)
    share = np.linspace(0.0, 1.0, POSES + 1)[1:, None]
    return Task.at(chain, start + share * (end - start), start=start)


def smooth(task: Task, attempt: Attempt) -> bool:
    """Whether every pose is met without a jump of a joint."""
    X = np.vstack([attempt.x0, attempt.X])
    steps = task.chain.limits.way(X[:-1], X[1:])
    return attempt.reached and bool((np.abs(steps) <= BOUND).all())


PATH = Case(
    "path",
    "20 poses of configurations along a line in joint space, each to be solved from the answer to the one before.",
    draw,
    judge=smooth,
    success="Every pose is met, and no joint moves more than 0.15 rad (or m) from one pose to the next.",
)
