"""Two hands: one hand at a position, the other at a pose relative to it, as for an object that both hold."""

from __future__ import annotations

import re

import numpy as np

from pin_metaik.compare.cases.case import BY_GOALS, Case, NoTask, Task
from pin_metaik.ik import Target
from pin_metaik.ik.goals import FramePose
from pin_metaik.kinematics import Chain
from pin_metaik.robots import Robot

SIDES = {"left": "right", "Left": "Right", "LEFT": "RIGHT", "l": "r", "L": "R"}


def other_side(name: str) -> str:
    """The name of a frame's counterpart on the other side, ``gripper_right`` of ``gripper_left``; empty without one."""
    both = SIDES | {right: left for left, right in SIDES.items()}
    words = re.split(r"([_\W]+)", name)
    turned = "".join(both.get(word, word) for word in words)
    return "" if turned == name else turned


def both_hands(robot: Robot, rng: np.random.Generator) -> Chain:
    """The chain of the robot's default frame and of its counterpart.

    Raises:
        NoTask: The robot has no second hand.
    """
    other = other_side(robot.frame)
    if not other or not robot.model.existFrame(other):
        raise NoTask(f"{robot.name} has no counterpart of {robot.frame!r} on another side")
    return Chain(robot.model, [robot.frame, other])


def draw(chain: Chain, rng: np.random.Generator) -> Task:
    """The place of one hand and the grasp of both, of a random configuration."""
    x, (hand, other) = chain.box.sample(rng, 1), chain.frames
    here, there = chain.placements(chain.q(x)[0])
    grasp = FramePose(other, here.actInv(there), reference=hand)
    return Task(chain, ((Target.at(here.translation, frame=hand), grasp),), x)


TWO_HANDS = Case(
    "two_hands",
    "One hand at a position, the other at a pose relative to it, as in a random configuration of both arms.",
    draw,
    chain=both_hands,
    success=BY_GOALS,
)
