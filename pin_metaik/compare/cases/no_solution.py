"""No solution: a reachable position with an orientation that is unreachable there; success is to report that."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.compare.cases.case import Case, NoTask, Task
from pin_metaik.compare.cases.just_out_of_reach import REPORTED, reported_unreachable
from pin_metaik.ik import DLS, IKProblem
from pin_metaik.kinematics import Chain

DRAWS, VAIN = 2_000, 60  # orientations, and proofs that fail, before an arm is said to have none
QUICK, LONG = 3_000, 25_000  # evaluations of descents before a proof is tried, and after it
EACH = 4  # evaluations of one descent, at least
BOXES = 30_000  # of one proof; a tenth of a second


def proved(chain: Chain, pose: pin.SE3) -> bool:
    """Whether it is proved, by its closed form or by boxes, that no configuration meets a pose."""
    problem = IKProblem.of(chain, pose)
    if problem.refuted is not None:
        return True
    boxes = problem.boxes(0)
    if boxes is None:
        return False
    boxes.look(BOXES)
    return boxes.excluded


def found(chain: Chain, pose: pin.SE3, rng: np.random.Generator, evaluations: int) -> bool:
    """Whether descents from random starts meet a pose."""
    starts = chain.box.sample(rng, evaluations // EACH)
    return DLS().refine(IKProblem.of(chain, pose), starts, evaluations).met


def draw(chain: Chain, rng: np.random.Generator) -> Task:
    """A random orientation at the position of a random configuration, until there is one without a solution.

    Raises:
        NoTask: The arm has none in so many draws, or none that is proved.
    """
    reach, vain = chain.reach(0, oriented=True), 0
    for _ in range(DRAWS):
        position = chain.placements(chain.q(chain.box.sample(rng, 1)[0]))[0].translation
        pose = pin.SE3(pin.Quaternion(*_unit(rng)).matrix(), position)
        if reach.gap(pose) > 0.0 or found(chain, pose, rng, QUICK):
            continue
        if proved(chain, pose) and not found(chain, pose, rng, LONG):
            return Task(chain, (pose,))
        vain += 1
        if vain == VAIN:
            break
    raise NoTask("no random orientation at a reachable position was proved to have no solution")


def _unit(rng: np.random.Generator) -> NDArray[np.float64]:
    """A random quaternion (4,), uniform."""
    v = rng.normal(size=4)
    return np.asarray(v / np.linalg.norm(v))


NO_SOLUTION = Case(
    "no_solution",
    "Random orientations at reachable positions that are within reach by the links' span, and still proved to have no "
    "solution; 25,000 evaluations of descents find none either.",
    draw,
    judge=reported_unreachable,
    success=REPORTED,
)
