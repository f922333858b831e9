"""Whole body: a legged robot keeps its feet in place and its balance, and reaches."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pinocchio as pin

from pin_metaik.arrays import Array
from pin_metaik.compare.cases.case import BY_GOALS, Case, NoTask, Task
from pin_metaik.compare.cases.two_hands import other_side
from pin_metaik.ik import Target, solve_ik
from pin_metaik.ik.goals import CentreOfMass, Goal, Placed
from pin_metaik.kinematics import Chain
from pin_metaik.robots import Robot

FOOT = re.compile(r"(^|_)(sole|foot)(_|$)", re.IGNORECASE)
SIDEWAYS, DOWN, TILT = 0.1, 0.25, 0.3  # m and rad by which the base may leave its place
HALF = 0.05  # m, half a side of the square of a sole
POINTS = 3  # feet, of which the base is moved, and which are points; two are soles that lie flat, and hands reach
DRAWS = 200


def standing(robot: Robot, rng: np.random.Generator) -> Chain:
    """The robot on a floating base: its feet, then its hands, or the base itself where it stands on three and more.

    Raises:
        NoTask: It has fewer than two feet, or its base cannot be freed.
    """
    if robot.description.is_mjcf:
        raise NoTask(f"{robot.name} is MJCF, whose base joint is part of the file and cannot be replaced")
    model = replace(robot.description, base="free flyer").model()
    links = [frame for frame in model.frames if frame.type == pin.FrameType.BODY]
    feet = [link.name for link in links if FOOT.search(link.name)]
    if len(feet) < 2:
        raise NoTask(f"{robot.name} has no two links that are called feet or soles")
    hands = [link.name for link in links if link.parentJoint == 1][:1] if len(feet) >= POINTS else _hands(robot)
    limits = dict.fromkeys(("root_joint.x", "root_joint.y"), (-SIDEWAYS, SIDEWAYS))
    limits |= {"root_joint.z": (-DOWN, 0.0)}
    limits |= dict.fromkeys(("root_joint.yaw", "root_joint.pitch", "root_joint.roll"), (-TILT, TILT))
    return Chain(model, [*feet, *hands], limits=limits)


def _hands(robot: Robot) -> list[str]:
    other = other_side(robot.frame)
    return [robot.frame] + [other] * robot.model.existFrame(other)


def draw(chain: Chain, rng: np.random.Generator) -> Task:
    """What a configuration reaches that stands where the reference does, and balances.

    A base and an upper body are drawn, the legs put onto their places, and what does not balance is drawn again.

    Raises:
        NoTask: In so many draws, nothing stands.
    """
    feet = [frame for frame in chain.frames if FOOT.search(frame)]
    places = dict(zip(chain.frames, chain.placements(chain.reference), strict=True))
    pointed = len(feet) >= POINTS
    stance: list[Goal] = [
        Target.at(places[foot].translation, frame=foot) if pointed else Target(places[foot], foot) for foot in feet
    ]
    balance = CentreOfMass(_ground([places[foot].translation[:2] for foot in feet], 0.0 if pointed else HALF))
    legs = Chain(chain.model, feet, limits=_limits(chain))
    for _ in range(DRAWS):
        stands = solve_ik(legs, stance, chain.q(chain.box.sample(rng, 1)[0]))
        if stands.success and balance.met(Placed(chain, stands.q)):
            reached = dict(zip(chain.frames, chain.placements(stands.q), strict=True))
            hands = [Target(reached[name], name) for name in chain.frames if name not in feet]
            return Task(chain, ((*stance, *hands, balance),), chain.x(stands.q)[None])
    raise NoTask(f"none of {DRAWS} random postures is balanced on its feet")


def _limits(chain: Chain) -> dict[str, tuple[float, float]]:
    """The limits of the base."""
    spans = zip(chain.names, chain.limits.lower.tolist(), chain.limits.upper.tolist(), strict=True)
    return {name: (lower, upper) for name, lower, upper in spans if name.startswith("root_joint.")}


def _ground(feet: list[Array], half: float) -> Array:
    """(k, 2) corners of what the feet cover, m."""
    corners = half * np.array([(x, y) for x in (-1.0, 1.0) for y in (-1.0, 1.0)])
    return np.concatenate([foot + corners for foot in feet])


WHOLE_BODY = Case(
    "whole_body",
    "Feet fixed, centre of mass over them, hands (with three or more feet the base) at the poses of a random balanced "
    "posture.",
    draw,
    chain=standing,
    success=BY_GOALS,
)
