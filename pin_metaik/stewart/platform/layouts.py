"""The standard layouts 3x3 ... 6x6: joints split out of an octahedron.

The octahedron (3x3) has pairs of legs meeting in three vertices a side. Every other type splits some of these vertices
in two, half a joint to either side; which legs part is decided by the numbers of joints alone.
"""

from __future__ import annotations

from math import pi, radians
from re import fullmatch

import numpy as np

from pin_metaik.arguments import checked
from pin_metaik.errors import InvalidGeometry, InvalidSetting, UnknownName
from pin_metaik.stewart.platform.geometry import FEWEST_LEGS, MOST_LEGS, Geometry
from pin_metaik.stewart.platform.servos import Servos

NAMED = ("3x3", "4x3", "4x4", "5x3", "5x4", "5x5", "6x3", "6x4", "6x5", "6x6")
"""The types the paper names; the mirrored ones (3x4 ...) come from the same lines."""

FEWEST_JOINTS = 3


@checked
def standard_geometry(
    type: str, base_radius: float, platform_radius: float, *, legs: int = 6, split: float = radians(15.0)
) -> Geometry:
    """A standard platform of a type, to start a design from.

    Args:
        type: Number of joints of base and platform, each from 3 to the number of legs: ``"6x3"``.
        base_radius: rb in m.
        platform_radius: rm in m.
        legs: 3 to 6. With three, the joints are 120 degrees apart; with five, the sixth is left out.
        split: Angle of the two joints of a split vertex from the vertex, rad.

    Raises:
        UnknownName: Not a type for this number of legs.
        InvalidSetting: Not 3 to 6 legs, or a split so large that joints change their order.
        InvalidGeometry: A radius that is not above zero.
    """
    if legs not in range(FEWEST_LEGS, MOST_LEGS + 1):
        raise InvalidSetting(f"a platform has {FEWEST_LEGS} to {MOST_LEGS} legs, got {legs!r}")
    sides = range(FEWEST_JOINTS, legs + 1)
    match = fullmatch(r"(\d)x(\d)", type)
    if not match or not all(int(count) in sides for count in match.groups()):
        raise UnknownName(f"type of platform with {legs} legs", type, [f"{b}x{m}" for b in sides for m in sides])
    if not 0.0 < split < pi / 6:
        raise InvalidSetting(f"split lies between 0 and {pi / 6:.3g} rad, half-way to the next vertex, got {split!r}")
    base_angles, base_of = _side(legs, int(match[1]), 0, split)
    platform_angles, platform_of = _side(legs, int(match[2]), 1, split)
    try:
        return Geometry(
            base_radius, platform_radius, base_angles, platform_angles, tuple(zip(base_of, platform_of, strict=True))
        )
    except InvalidGeometry as error:
        raise InvalidGeometry(f"{type} with {legs} legs: {error}") from None


def tangential_servos(geometry: Geometry, horn: float, rod: float) -> Servos:
    """Servos for a platform of joints on circles: their axes point to the middle of the base, in its plane.

    Horns point along the circle, away from where their rods lean.

    Args:
        geometry: The platform, with a base joint for each leg.
        horn: Length of the horns, m.
        rod: Length of the rods, m.
    """
    across = np.cross(geometry.b, geometry.m)[:, 2]  # above zero where the leg leans counterclockwise
    outward = np.arctan2(geometry.b[:, 1], geometry.b[:, 0])
    return Servos(horn, rod, directions=tuple((outward - np.where(across > 0.0, 0.5 * pi, -0.5 * pi)).tolist()))


def _side(legs: int, joints: int, first: int, split: float) -> tuple[tuple[float, ...], list[int]]:
    """Ascending angles of the joints of one side, and the joint of each leg; pairs of legs count from leg `first`.

    The first pairs keep one joint for both legs, as many as there are legs too many; the others are split.
    """
    if legs == FEWEST_LEGS:
        return tuple(2 * pi / legs * leg for leg in range(legs)), list(range(legs))
    even = legs + legs % 2
    round_about = [leg for k in range(even) if (leg := (first + k) % even) < legs]  # pairs stand together
    shared = legs - joints
    groups = [round_about[2 * k : 2 * k + 2] for k in range(shared)] + [[leg] for leg in round_about[2 * shared :]]

    def angle(leg: int) -> float:
        pair, second = divmod((leg - first) % even, 2)
        vertex = 2 * pi / even * (first + 2 * pair + 0.5)
        return vertex + (split if second else -split)

    angles = tuple(sum(angle(leg) for leg in group) / len(group) for group in groups)
    joint_of = {leg: joint for joint, group in enumerate(groups) for leg in group}
    return angles, [joint_of[leg] for leg in range(legs)]
