"""Comparison of the types of platforms: a design of each type for the same task."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from decimal import Decimal
from math import degrees, radians
from typing import Any

import numpy as np

from pin_metaik.arguments import checked
from pin_metaik.errors import InvalidSetting, UnknownName
from pin_metaik.interrupts import kept
from pin_metaik.optimize.settings import few
from pin_metaik.plain import fields_of
from pin_metaik.stewart.mechanism.mechanism import Mechanism
from pin_metaik.stewart.mechanism.ranges import SIDES, Ranges
from pin_metaik.stewart.mechanism.task import DesignTask
from pin_metaik.stewart.platform.geometry import FEWEST_LEGS, MOST_LEGS, Geometry
from pin_metaik.stewart.platform.layouts import NAMED, standard_geometry, tangential_servos
from pin_metaik.stewart.platform.limits import LegLimits, Limits, ServoLimits
from pin_metaik.stewart.platform.servos import each
from pin_metaik.stewart.synthesis.design import Designed, design
from pin_metaik.stewart.synthesis.fitness import task_of
from pin_metaik.units import ANGLES
from pin_metaik.watching import Watch

ASIDE = radians(25.0)  # how far a joint may stand from where its type has it
NARROW, WIDE = 0.5, 1.5  # of the radii of a new mechanism: between these a design may change them
TURN = radians(60.0)  # how far the servos of a new mechanism turn, to either side
GAP = 0.05  # of the smaller radius: how far apart joints stay in a new mechanism's design


@dataclass(frozen=True, eq=False)
class TypeDesign:
    """The best design of one type.

    Attributes:
        type: Number of joints of base and platform, e.g. ``"6x3"``.
        designed: The best of the runs.
        runs: The fitness of each run; NaN where no design was feasible.
    """

    type: str
    designed: Designed
    runs: tuple[float, ...]

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON: lengths in m."""
        score, geometry = self.designed.score, self.designed.mechanism.geometry
        names = ("fitness", "dexterity", "workspace")
        return {
            **fields_of(self, "type", "runs"),
            **(dict.fromkeys(names) if score is None else fields_of(score, *names)),
            **fields_of(geometry, "base_radius", "platform_radius"),
        }


@checked
def new_mechanism(
    type: str,
    base_radius: float,
    platform_radius: float,
    shortest: float,
    longest: float,
    *,
    name: str | None = None,
    legs: int = MOST_LEGS,
    unit: str = "mm",
) -> Mechanism:
    """A new mechanism of a type, with a design task in which radii and angles may vary around their values.

    Args:
        type: Joints a side, base first: ``"6x3"``.
        base_radius: rb in m.
        platform_radius: rm in m.
        shortest: Length of a retracted leg, m.
        longest: Length of an extended leg, m.
        name: Its name; default: the type.
        legs: 3 to 6.
        unit: The unit of length of its file.

    Raises:
        UnknownName: Not a type that so many legs can have.
        InvalidGeometry: A radius or a length that cannot be one.
        InvalidSetting: No unit of that name, or not 3 to 6 legs.
    """
    geometry = standard_geometry(type, base_radius, platform_radius, legs=legs)
    return _begun(geometry, LegLimits(shortest, longest), name, unit)


@checked
def new_servo_mechanism(
    type: str,
    base_radius: float,
    platform_radius: float,
    horn: float,
    rod: float,
    *,
    name: str | None = None,
    legs: int = MOST_LEGS,
    unit: str = "mm",
) -> Mechanism:
    """A new mechanism moved by servos, with a design task in which radii, angles, horn and rod may vary.

    The axes of the servos point to the middle of the base; they turn by 60 degrees to either side.

    Args:
        type: Joints a side, base first, a base joint for each leg: ``"6x3"``.
        base_radius: rb in m.
        platform_radius: rm in m.
        horn: Length of the horns, m.
        rod: Length of the rods, m.
        name: Its name; default: the type.
        legs: 3 to 6.
        unit: The unit of length of its file.

    Raises:
        UnknownName: Not a type that so many legs can have, with a base joint for each.
        InvalidGeometry: A radius or a length that cannot be one.
        InvalidSetting: No unit of that name, or not 3 to 6 legs.
    """
    geometry = standard_geometry(type, base_radius, platform_radius, legs=legs)
    _need_a_joint_each([type], legs)
    geometry = replace(geometry, servos=tangential_servos(geometry, horn, rod))
    return _begun(geometry, ServoLimits(_short(-TURN), _short(TURN)), name, unit)


def _begun(geometry: Geometry, limits: Limits, name: str | None, unit: str) -> Mechanism:
    """A mechanism with a design that is free about it; its angles are such that a file has them in few digits."""
    sides: dict[str, Any] = {
        f"{side}_angles": tuple(map(_short, getattr(geometry, f"{side}_angles"))) for side in SIDES
    }
    servos = geometry.servos and replace(geometry.servos, directions=tuple(map(_short, geometry.servos.directions)))
    geometry = replace(geometry, servos=servos, **sides)
    gap = GAP * min(geometry.base_radius, geometry.platform_radius)
    task = DesignTask(_round_about(geometry), joint_gap=gap)
    return Mechanism(name or geometry.type, geometry, limits, task=task, unit=unit)


def _short(angle: float) -> float:
    """An angle in rad, as it is read from a file that has it in degrees to nine decimals."""
    return ANGLES["deg"].read(Decimal(f"{degrees(angle):.9f}"))


def _about(angle: float) -> tuple[float, float]:
    """The range of an angle that may stand a little aside."""
    return _short(angle - ASIDE), _short(angle + ASIDE)


def _need_a_joint_each(types: Iterable[str], legs: int) -> None:
    """Raise UnknownName for a type of platform that has not a base joint for each leg, where its servo could stand."""
    with_one_each = [f"{legs}x{joints}" for joints in range(FEWEST_LEGS, legs + 1)]
    for type in types:
        if type not in with_one_each:
            raise UnknownName(f"type of platform with {legs} servos", type, with_one_each)


@checked
def compare_types(
    mechanism: Mechanism,
    types: Sequence[str] | None = None,
    runs: int = 1,
    *,
    rng: int | None = None,
    watch: Watch | None = None,
) -> list[TypeDesign]:
    """Design a platform of every type for the same task; the best comes first.

    Each search begins with the standard platform of its type and the mechanism's radii (with servos, also with its
    horns and rods, and axes that point to the centre). The ranges of radii and legs are those of the task; the joint
    angles, except the first, may move by 25 degrees to either side of the standard ones; everything else is as in the
    mechanism. Ctrl-C ends the present run and skips the following ones.

    Args:
        mechanism: A mechanism with a task.
        types: Types of platforms with as many legs as the mechanism (with servos, also as many base joints); default:
            those of six legs.
        runs: Number of searches for each type, with consecutive seeds from the task's on.
        rng: The first seed instead of the task's.
        watch: Called after every generation with the designs evaluated and their total; returning True ends it as
            Ctrl-C does.

    Raises:
        InvalidSetting: The mechanism has no task or has joints given as points, or ``runs`` is below 1.
        UnknownName: There is no such type.
    """
    task = task_of(mechanism)
    if mechanism.geometry.base is not None or mechanism.geometry.platform is not None:
        raise InvalidSetting("types are compared for platforms with their joints on circles, not given as points")
    few("runs", runs, 1)
    radii, legs = (mechanism.geometry.base_radius, mechanism.geometry.platform_radius), mechanism.geometry.n
    servos = mechanism.geometry.servos
    if types is None:
        types = NAMED if servos is None else [type for type in NAMED if type.startswith(f"{MOST_LEGS}x")]
    starts = [standard_geometry(type, *radii, legs=legs) for type in types]
    if servos is not None:
        _need_a_joint_each(types, legs)
        horn, rod = (float(each(servos, name).mean()) for name in ("horn", "rod"))
        starts = [replace(start, servos=tangential_servos(start, horn, rod)) for start in starts]
    first = task.seed if rng is None else rng
    found: list[TypeDesign] = []
    total = len(starts) * runs * task.evaluations
    for k, start in enumerate(starts):
        ranges = replace(_round_about(start), **_kept(task.ranges))
        here = replace(mechanism, name=f"{mechanism.name} {start.type}", geometry=start)
        designs: list[Designed] = []
        for run in range(runs):
            before = (k * runs + run) * task.evaluations
            one = replace(here, task=replace(task, ranges=ranges, seed=first + run, from_current=True))
            tell = None if watch is None else _offset(watch, before, total)
            designs.append(kept(lambda one=one, tell=tell: design(one, watch=tell)))  # type: ignore[misc]
            if designs[-1].interrupted:
                break
        scores = tuple(d.score.fitness if d.score else np.nan for d in designs)
        best = designs[int(np.argmax(np.nan_to_num(scores, nan=-1.0)))]
        found.append(TypeDesign(start.type, best, scores))
        if designs[-1].interrupted:
            break
    return sorted(found, key=lambda one: -one.designed.score.fitness if one.designed.score else 1.0)


def _offset(watch: Watch, before: int, total: int) -> Watch:
    return lambda at: watch(replace(at, done=before + at.done, total=total))


def _kept(ranges: Ranges) -> dict[str, Any]:
    """What ranges say about dimensions that all types have."""
    names = ("base_radius", "platform_radius", "shortest", "longest", "horn", "rod")
    return {name: span for name in names if (span := getattr(ranges, name)) is not None}


def _round_about(geometry: Geometry) -> Ranges:
    """Radii, angles, horns and rods free about where a platform of circles has them, but for the first angle."""
    first, *others = geometry.base_angles
    servos = geometry.servos
    moved = {name: (NARROW * (size := getattr(servos, name)), WIDE * size) for name in ("horn", "rod") if servos}
    return Ranges(
        (NARROW * geometry.base_radius, WIDE * geometry.base_radius),
        (NARROW * geometry.platform_radius, WIDE * geometry.platform_radius),
        (first, *map(_about, others)),
        tuple(map(_about, geometry.platform_angles)),
        **moved,
    )
