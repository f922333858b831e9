"""Goals for one frame or one joint that obviously contradict each other."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import combinations
from typing import TypeAlias

import numpy as np
import pinocchio as pin

from pin_metaik.errors import InvalidTarget
from pin_metaik.ik.goals.frame_pose import FramePose
from pin_metaik.ik.goals.goal import Goal, named
from pin_metaik.ik.goals.pose import Target
from pin_metaik.ik.goals.posture import Posture, joints_of
from pin_metaik.kinematics import Chain

Seen: TypeAlias = tuple[str, str | None]
"""A frame, and the one in whose coordinates it is seen; None: the world."""

ROUNDING = 1e-9  # m and rad


def check_contradictions(chain: Chain, targets: Sequence[Target], goals: Sequence[Goal]) -> None:
    """See that no two goals want one frame at two poses, or one joint at two values, beyond their tolerances.

    Args:
        chain: The chain.
        targets: One for each of its frames, in its order.
        goals: All others.

    Raises:
        InvalidTarget: Two do; the message says by how much.
    """
    poses: list[tuple[Seen, Target, Goal]]
    poses = [((frame, None), target, target) for frame, target in zip(chain.frames, targets, strict=True)]
    poses += [(*posed, goal) for goal in goals if (posed := _posed(chain, goal)) is not None]
    for (where, a, first), (there, b, second) in combinations(poses, 2):
        if where == there:
            _compare(first, second, _apart(a, b))
    postures = [goal for goal in goals if isinstance(goal, Posture)]
    for one, other in combinations(postures, 2):
        _compare(one, other, _disjoint(chain, one, other))


def _compare(first: Goal, second: Goal, why: str) -> None:
    if why:
        raise InvalidTarget(f"{named(first)} and {named(second)} contradict each other: {why}")


def _posed(chain: Chain, goal: Goal) -> tuple[Seen, Target] | None:
    """The frame, the one that sees it, and the pose that it shall have; None for other goals."""
    if isinstance(goal, Target):
        return (chain.frames[0] if goal.frame is None else goal.frame, None), goal
    return ((goal.frame, goal.reference), goal._target) if isinstance(goal, FramePose) else None


def _apart(a: Target, b: Target) -> str:
    """By how much two poses of one frame are farther apart than both tolerances; empty if they are not."""
    error = a.pose.actInv(b.pose)
    distances = float(np.linalg.norm(error.translation)), float(np.linalg.norm(pin.log3(error.rotation)))
    for distance, one, other, unit in zip(distances, a.allowance, b.allowance, ("m", "rad"), strict=True):
        if distance > one + other + ROUNDING:
            return f"they are {distance:.3g} {unit} apart, and their tolerances add up to {one + other:.3g} {unit}"
    return ""


def _disjoint(chain: Chain, one: Posture, other: Posture) -> str:
    """The first joint that two postures want in two places; empty if there is none."""
    spans = dict[int, tuple[float, float]]()
    for posture in (one, other):
        for column, least, most in zip(*joints_of(posture, chain), strict=True):
            low, high = spans.get(column, (-math.inf, math.inf))
            spans[column] = max(low, least - posture.tolerance), min(high, most + posture.tolerance)
    for column, (low, high) in spans.items():
        if low > high + ROUNDING and not chain.limits.periodic[column]:
            return f"no value of joint {chain.names[column]!r} is in both ranges, they are {low - high:.3g} apart"
    return ""
