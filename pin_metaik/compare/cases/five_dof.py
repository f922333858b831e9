"""Five degrees of freedom: poses with one constraint more than the arm has joints, which can nevertheless be met."""

from __future__ import annotations

import numpy as np

from pin_metaik.compare.cases.case import Case
from pin_metaik.compare.cases.random_poses import draw
from pin_metaik.kinematics import Chain
from pin_metaik.robots import Robot

JOINTS = 5


def first_five(robot: Robot, rng: np.random.Generator) -> Chain:
    """The first five joints on the way to the robot's frame, the others held in the middle of their range."""
    arm = Chain(robot.model, robot.frame)
    middle = arm.q(0.5 * (arm.box.lower + arm.box.upper))
    return Chain(robot.model, robot.frame, locked=arm.names[JOINTS:], reference=middle)


FIVE_DOF = Case(
    "five_dof",
    "Poses of random configurations of an arm with five joints: of longer ones, those from the sixth on are held.",
    draw,
    chain=first_five,
)
