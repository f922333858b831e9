"""The closed form of a leg moved by a servo, as the compiled loops need it: no angle, only its cosine and sine.

``servos`` (n, 15): of each leg u, w and a (the horn at angle 0 and at a right angle, and the axis it turns about), the
lengths of horn and rod, the branch, then cosine and sine of the middle of its angles and the cosine of half their
range. See ``platform/servos.py`` for the equations.
"""

from __future__ import annotations

import math

from pin_metaik.compiled import Floats, inline

CLOSED = 1  # PoseState.POSITIVE: what follows is looked at
TOO_SHORT, TOO_LONG, SERVO_ANGLE = 4, 5, 9

HORN, ROD, BRANCH, MIDDLE_COS, MIDDLE_SIN, LEAST_COS = 9, 10, 11, 12, 13, 14


@inline
def dot(servos: Floats, i: int, first: int, legs: Floats) -> float:
    """A direction of servo i times leg i."""
    return float(servos[i, first] * legs[i, 0] + servos[i, first + 1] * legs[i, 1] + servos[i, first + 2] * legs[i, 2])


@inline
def close(
    i: int,
    base: Floats,
    servos: Floats,
    joint_axes: Floats,
    legs: Floats,
    starts: Floats,
    axes: Floats,
    lengths: Floats,
    divisors: Floats,
) -> int:
    """The rod of leg i, from the tip of its horn, in place of the leg from its base joint.

    Args:
        i: The leg.
        base: b_i (n, 3).
        servos: As above.
        joint_axes: Axes (n, 3) of the joints at the horns: along the horn, the way it moves, and along its axis.
        legs: v_i (n, 3); afterwards the rod.
        starts: Afterwards the tip of the horn (n, 3).
        axes: Afterwards the axis of the joint there, in the base frame (n, 3).
        lengths: Afterwards the length of the rod (n,).
        divisors: Afterwards what the rod is divided by in the Jacobian of the servo's rate (n,): horn times rod times
            the transmission.

    Returns:
        A ``PoseState``: CLOSED, or why not.
    """
    x, y, along = dot(servos, i, 0, legs), dot(servos, i, 3, legs), dot(servos, i, 6, legs)
    horn, rod = servos[i, HORN], servos[i, ROD]
    r2 = x * x + y * y
    r = math.sqrt(r2)
    c = (r2 + along * along + horn * horn - rod * rod) / (2.0 * horn)
    if c < -r:
        return TOO_SHORT
    if c > r:
        return TOO_LONG
    sine = math.sqrt((r - c) * (r + c))
    turn = servos[i, BRANCH] * sine
    if r2 > 0.0:
        cos, sin = (c * x + turn * y) / r2, (c * y - turn * x) / r2
    else:  # the joint is on the axis: every angle is as good
        cos, sin = servos[i, MIDDLE_COS], servos[i, MIDDLE_SIN]
    if cos * servos[i, MIDDLE_COS] + sin * servos[i, MIDDLE_SIN] < servos[i, LEAST_COS]:
        return SERVO_ANGLE
    for e in range(3):
        u, w = servos[i, e], servos[i, e + 3]
        tip = horn * (cos * u + sin * w)
        starts[i, e] = base[i, e] + tip
        legs[i, e] -= tip
        axes[i, e] = (
            joint_axes[i, 0] * (cos * u + sin * w)
            + joint_axes[i, 1] * (cos * w - sin * u)
            + joint_axes[i, 2] * servos[i, e + 6]
        )
    lengths[i], divisors[i] = rod, horn * sine
    return CLOSED


@inline
def arc_misses(servos: Floats, i: int, legs: Floats, radius: float) -> bool:
    """Whether the rod of leg i is too short or too long by more than a radius (m), wherever in its range the horn is.

    The distance between a point and the tip of the horn lies between those to the nearest and the farthest point of
    the arc of the tip; either changes by at most as much as the point moves.
    """
    x, y, along = dot(servos, i, 0, legs), dot(servos, i, 3, legs), dot(servos, i, 6, legs)
    horn, rod = servos[i, HORN], servos[i, ROD]
    middle_cos, middle_sin, least = servos[i, MIDDLE_COS], servos[i, MIDDLE_SIN], servos[i, LEAST_COS]
    r = math.sqrt(x * x + y * y)
    ahead = x * middle_cos + y * middle_sin  # r times the cosine of the angle from the middle of the arc
    near, far = r - horn, r + horn
    near, far = near * near, far * far
    if least > -1.0:
        aside = abs(y * middle_cos - x * middle_sin)
        half = math.sqrt(1.0 - least * least)
        if ahead < r * least:  # nearest at the end on its side
            near = r * r + horn * horn - 2.0 * horn * (ahead * least + aside * half)
        if -ahead < r * least:  # farthest at the other end
            far = r * r + horn * horn - 2.0 * horn * (ahead * least - aside * half)
    if near + along * along > (rod + radius) * (rod + radius):
        return True
    return bool(rod > radius and far + along * along < (rod - radius) * (rod - radius))
