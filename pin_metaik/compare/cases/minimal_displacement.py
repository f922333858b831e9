"""Minimal displacement: only a solution as near to the start as a known one is a success."""

from __future__ import annotations

import numpy as np

from pin_metaik.compare.cases.case import Attempt, Case, Task
from pin_metaik.kinematics import Chain

FAR, SLACK = 0.6, 0.01  # of each joint, rad or m; and how much longer the way may be


def draw(chain: Chain, rng: np.random.Generator) -> Task:
    """A pose that every joint is at most 0.6 rad or m away from, and the configuration to start from."""
    x0 = chain.box.sample(rng, 1)[0]
    x = np.clip(x0 + rng.uniform(-FAR, FAR, chain.n), chain.box.lower, chain.box.upper)
    return Task.at(chain, x[None], start=x0)


def near_enough(task: Task, attempt: Attempt) -> bool:
    """Whether the target is met no farther from the start than the configuration it was made from."""
    assert task.planted is not None
    way, planted = task.chain.limits.way(attempt.x0, np.stack([attempt.X[0], task.planted[0]]))
    return attempt.reached and bool(np.linalg.norm(way) <= (1.0 + SLACK) * np.linalg.norm(planted))


MINIMAL_DISPLACEMENT = Case(
    "minimal_displacement",
    "Poses of configurations within 0.6 rad (or m), joint by joint, of the one to start from.",
    draw,
    judge=near_enough,
    success="The target is met, and |x - x0| is at most 1 % more than that of the configuration it was made from.",
)
