"""Look at a point: an axis of the tip points at a point from a distance; everything else is free."""

from __future__ import annotations

import numpy as np

from pin_metaik.compare.cases.case import BY_GOALS, Case, Task
from pin_metaik.ik.goals import Distance, LookAt
from pin_metaik.kinematics import Chain

NEAR, FAR = 0.2, 1.0  # m, to the point
ROOM = 0.05  # m by which the distance may be off


def draw(chain: Chain, rng: np.random.Generator) -> Task:
    """A point on the z axis of the tip of a random configuration."""
    x, (tip,) = chain.box.sample(rng, 1), chain.frames
    pose, away = chain.placements(chain.q(x)[0])[0], float(rng.uniform(NEAR, FAR))
    point = pose.act(np.array([0.0, 0.0, away]))
    return Task(chain, ((LookAt(tip, point), Distance(tip, point, least=away - ROOM, most=away + ROOM)),), x)


LOOK_AT = Case(
    "look_at",
    "The z axis of the tip points at a point, at a distance that is met to within 5 cm, as at a random configuration.",
    draw,
    success=BY_GOALS,
)
