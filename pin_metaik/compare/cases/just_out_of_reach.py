"""Just out of reach: success is to report the target as unreachable."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.compare.cases.case import Attempt, Case, Task
from pin_metaik.kinematics import Chain

REPORTED = "The method says UNREACHABLE, and does not claim to have solved it; finding no solution is not enough."
BEYOND = (0.001, 0.05)  # m past the bound on the arm's reach


def pushed_out(
    chain: Chain, poses: NDArray[np.float64], rng: np.random.Generator, beyond: tuple[float, float] = BEYOND
) -> NDArray[np.float64]:
    """The poses (k, 4, 4) moved outward, away from the first axis of the arm, until past the bound on its reach."""
    reach = chain.reach(0, oriented=True)
    far = poses.copy()
    for pose in far:
        out = pin.SE3(pose).act(reach.end) - reach.anchor
        span = float(np.linalg.norm(out))
        pose[:3, 3] += out / span * (reach.most + rng.uniform(*beyond) - span)
    return far


def draw(chain: Chain, rng: np.random.Generator, beyond: tuple[float, float] = BEYOND) -> Task:
    """A random pose, pushed out."""
    pose = chain.placements(chain.q(chain.box.sample(rng, 1)[0]))[0].homogeneous
    return Task(chain, (pin.SE3(pushed_out(chain, pose[None], rng, beyond)[0]),))


def reported_unreachable(task: Task, attempt: Attempt) -> bool:
    """Whether the method said that the target is out of reach, and claimed nothing."""
    return attempt.unreachable and not any(answer.claimed for answer in attempt.answers)


JUST_OUT_OF_REACH = Case(
    "just_out_of_reach",
    "Random poses pushed outward, 1 mm to 5 cm past the bound on the arm's reach that its links give.",
    draw,
    judge=reported_unreachable,
    success=REPORTED,
)
