"""Cup upright: the tip at a place, with one axis within a narrow cone, free to turn about it."""

from __future__ import annotations

import math

import numpy as np

from pin_metaik.compare.cases.case import BY_GOALS, Case, Task
from pin_metaik.ik import Target
from pin_metaik.ik.goals import Pointing
from pin_metaik.kinematics import Chain

TILT = math.radians(5)


def draw(chain: Chain, rng: np.random.Generator) -> Task:
    """The place of a random configuration's tip; its x axis is somewhere inside the cone."""
    x, (tip,) = chain.box.sample(rng, 1), chain.frames
    pose = chain.placements(chain.q(x)[0])[0]
    axis, aside = pose.rotation[:, 0], np.cross(pose.rotation[:, 0], rng.normal(size=3))
    angle = float(rng.uniform(0.0, TILT))
    up = math.cos(angle) * axis + math.sin(angle) * aside / np.linalg.norm(aside)
    return Task(chain, ((Target.at(pose.translation), Pointing(tip, "x", up, tolerance=TILT)),), x)


CUP_UPRIGHT = Case(
    "cup_upright",
    "The tip's position at a random configuration, and an axis of the tip within five degrees of a direction.",
    draw,
    success=BY_GOALS,
)
