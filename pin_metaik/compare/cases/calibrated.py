"""Calibrated: the arm as it was measured, not as it was drawn; no two axes meet or are parallel any more."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from pin_metaik.compare.cases.case import Case
from pin_metaik.compare.cases.random_poses import draw
from pin_metaik.kinematics import Chain
from pin_metaik.robots import Robot

SPREAD = 1e-3  # m and rad, of each joint's placement


def measured(robot: Robot, rng: np.random.Generator) -> Chain:
    """The arm with every joint's placement on its link off by a normal 1e-3 m and 1e-3 rad on each axis."""
    model = pin.Model(robot.model)
    for joint in range(1, model.njoints):
        model.jointPlacements[joint] = model.jointPlacements[joint] * pin.exp6(rng.normal(0.0, SPREAD, 6))
    return Chain(model, robot.frame)


CALIBRATED = Case(
    "calibrated",
    "Random poses of an arm whose joints are 1e-3 m and 1e-3 rad off their place, so that it has no closed form.",
    draw,
    chain=measured,
)
