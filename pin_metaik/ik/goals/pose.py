"""The goal of a frame's pose, position or orientation, and how closely it shall be met."""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import ClassVar, NamedTuple, TypeAlias

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import array, instance, shown
from pin_metaik.errors import InvalidTarget
from pin_metaik.ik.goals.placed import Placed
from pin_metaik.ik.goals.sets import Grown
from pin_metaik.kinematics.kernel.layout import ALIGNED, NEAR, SLACK, TURN_SLACK, WEIGHT
from pin_metaik.kinematics.pose import as_pose, as_position

Tolerance: TypeAlias = float | tuple[float, float, float]

Read: TypeAlias = tuple[Tolerance, tuple[float, float, float], float, bool]

DEFAULT_TOLERANCE = 1e-5
KEPT = 1024  # tolerances that have been read and are remembered
WHOLE, EDGE = 0.99, 0.009  # of a tolerance: what is aimed at as a whole, and how near to that is near enough
FREE = math.inf


@dataclass(frozen=True, eq=False)
class Target:
    """A pose for one frame, with tolerances and weights.

    A tolerance is one number, the radius within which the error must lie, or three (a tuple, list or array; kept as a
    tuple), one for each axis of the target frame; ``inf`` frees an axis. So ``Target.at(xyz)`` frees all three
    rotations, and ``Target(pose, orientation_tolerance=(1e-5, 1e-5, inf))`` only the one about the target's z axis. The
    orientation error is the rotation vector log(R_target' R).

    Attributes:
        pose: World pose that the frame shall reach: ``pin.SE3`` or (4, 4); kept as ``pin.SE3``.
        frame: Which frame of the chain; ``None`` for a chain's only one.
        position_tolerance: m.
        orientation_tolerance: rad.
        position_weight: Weight of a metre of error in the cost of the search.
        orientation_weight: Weight of a radian of error in the cost of the search.

    Raises:
        InvalidTarget: If the pose is not a finite rigid transform, a tolerance is not above zero, a weight is not
            finite and above zero, or all six axes are free.
    """

    _asks: ClassVar[bool] = True

    pose: pin.SE3
    frame: str | None = None
    position_tolerance: Tolerance = DEFAULT_TOLERANCE
    orientation_tolerance: Tolerance = DEFAULT_TOLERANCE
    position_weight: float = 1.0
    orientation_weight: float = 1.0
    record: NDArray[np.float64] = field(init=False, repr=False)  # (26,) as the kernels take it
    counts: tuple[bool, ...] = field(init=False, repr=False)  # which of the six axes are not free
    loose: bool = field(init=False, repr=False)  # whether one of those may be off by more than the default tolerance

    def __post_init__(self) -> None:
        """Check everything once, where it enters."""
        if self.frame is not None and not isinstance(self.frame, str):
            raise InvalidTarget(f"frame is the name of one of the chain's frames, or None, got {shown(self.frame)}")
        placement, (a, b, c, x, d, e, f, y, g, h, i, z) = as_pose(self.pose)
        object.__setattr__(self, "pose", placement)
        metres, slack, near, wide = _read("position_tolerance", self.position_tolerance)
        radians, lean, aligned, broad = _read("orientation_tolerance", self.orientation_tolerance)
        if metres is not self.position_tolerance:
            object.__setattr__(self, "position_tolerance", metres)
        if radians is not self.orientation_tolerance:
            object.__setattr__(self, "orientation_tolerance", radians)
        if self._asks and FREE == max(slack) == min(slack) == min(lean):
            raise InvalidTarget("this target frees every axis: nothing is left to reach")
        weight = _weight("position_weight", self.position_weight)
        turn = _weight("orientation_weight", self.orientation_weight)
        # A goal of ``kernel.layout``: the world in the target frame, slack and weight of each axis, radii.
        world = (a, d, g, b, e, h, c, f, i, -a * x - d * y - g * z, -b * x - e * y - h * z, -c * x - f * y - i * z)
        weights = (weight, weight, weight, turn, turn, turn)
        object.__setattr__(self, "record", np.array(world + slack + lean + weights + (near, aligned)))
        object.__setattr__(self, "counts", _finite(slack + lean))
        object.__setattr__(self, "loose", wide or broad)

    @staticmethod
    def at(xyz: ArrayLike, *, frame: str | None = None, tolerance: Tolerance = DEFAULT_TOLERANCE) -> Target:
        """A position (3,) in m, at any orientation."""
        pose = pin.SE3(np.eye(3), as_position(xyz))
        return Target(pose, frame, position_tolerance=tolerance, orientation_tolerance=FREE)

    @staticmethod
    def facing(rotation: ArrayLike, *, frame: str | None = None, tolerance: Tolerance = DEFAULT_TOLERANCE) -> Target:
        """An orientation (3, 3) in the world, at any position."""
        matrix = array("an orientation", rotation, 3, 3, error=InvalidTarget)
        pose = pin.SE3(matrix, np.zeros(3))
        return Target(pose, frame, position_tolerance=FREE, orientation_tolerance=tolerance)

    @staticmethod
    def of(target: Target | pin.SE3 | ArrayLike) -> Target:
        """Whatever ``solve_ik`` takes as a target: a Target, a ``pin.SE3``, a 4x4 matrix, or a position (3,)."""
        if isinstance(target, Target):
            return target
        if isinstance(target, pin.SE3):
            return Target(target)
        try:
            numbers = np.asarray(target, dtype=float)
        except (TypeError, ValueError, OverflowError):
            numbers = np.empty(0)
        if numbers.shape == (4, 4):
            return Target(numbers)
        if numbers.shape == (3,):
            return Target.at(numbers)
        raise InvalidTarget(f"a target is a pin.SE3, a 4x4 matrix, a position (3,) or a Target, got {shown(target)}")

    @property
    def plain(self) -> bool:
        """Whether it is a whole pose or a position alone, with tolerances that are single numbers and equal weights."""
        return (
            self.frame is None
            and isinstance(self.position_tolerance, float)
            and self.position_tolerance < FREE
            and isinstance(self.orientation_tolerance, float)
            and self.position_weight == self.orientation_weight == 1.0
        )

    @cached_property
    def whole_record(self) -> NDArray[np.float64]:
        """(26,) as the kernels take it, aimed at all that is accepted: up to its tolerances an error counts nothing."""
        record = self.record.copy()
        parts = (SLACK, NEAR, self.position_tolerance), (TURN_SLACK, ALIGNED, self.orientation_tolerance)
        for slacks, allowed, tolerance in parts:
            slack, radius = _whole(tolerance)
            record[slacks : slacks + 3], record[allowed] = slack, radius
        return record

    @property
    def allowance(self) -> tuple[float, float]:
        """The largest distance (m) and angle (rad) within the tolerances; ``inf`` when an axis is free."""
        return _radius(self.position_tolerance), _radius(self.orientation_tolerance)

    @property
    def tilt(self) -> float:
        """The largest angle (rad) within the tolerances about the axes that are not free; 0 if all are free."""
        each = self.orientation_tolerance
        return _radius(tuple(t for t in each if t < FREE) if isinstance(each, tuple) else 0.0 if each == FREE else each)

    def residual(self, at: Placed) -> NDArray[np.float64]:
        """(6,) weighted errors of position (m) and orientation (rad) beyond the tolerances; see ``Goal.residual``."""
        return self._beyond(self._placement(at))

    def jacobian(self, at: Placed) -> NDArray[np.float64]:
        """(6, n) derivative of the residual by the coordinates of the chain."""
        return self._slopes(self._placement(at), at.jacobian(self._frame(at)))

    def _beyond(self, placement: pin.SE3) -> NDArray[np.float64]:
        """The residual (6,) for a placement of the frame."""
        error, (near, aligned) = self.pose.actInv(placement), self._sets
        parts = near.residual(error.translation), aligned.residual(pin.log3(error.rotation))
        return self.record[WEIGHT:NEAR] * np.concatenate(parts)

    def _slopes(self, placement: pin.SE3, J: NDArray[np.float64]) -> NDArray[np.float64]:
        """The derivative (6, n) of the residual, from the velocity (6, n) of the frame along the world's axes."""
        error, (near, aligned) = self.pose.actInv(placement), self._sets
        turn = pin.Jlog3(error.rotation) @ placement.rotation.T
        parts = (
            near.slopes(error.translation, self.pose.rotation.T @ J[:3]),
            aligned.slopes(pin.log3(error.rotation), turn @ J[3:]),
        )
        weighted: NDArray[np.float64] = self.record[WEIGHT:NEAR, None] * np.concatenate(parts)
        return weighted

    @cached_property
    def _sets(self) -> tuple[Grown, Grown]:
        """The sets of positions (m) and rotation vectors (rad) that are accepted, in the target frame."""
        return _as_set(self.position_tolerance), _as_set(self.orientation_tolerance)

    def met(self, at: Placed) -> bool:
        """Whether its frame is within the tolerances, by Pinocchio."""
        return self.judge(self._placement(at)).met

    def _placement(self, at: Placed) -> pin.SE3:
        """World pose of its frame, or of the chain's first one if it names none."""
        frame = self._frame(at)
        return at.pose(frame)

    def _frame(self, at: Placed) -> str:
        instance(Placed, at=at)
        return at.chain.frames[0] if self.frame is None else self.frame

    def off(self, at: Placed) -> dict[str, float]:
        """Distance (m) and angle (rad) from the pose, over the axes that are not free."""
        return self._off(self._placement(at))

    def _off(self, placement: pin.SE3) -> dict[str, float]:
        judged = self.judge(placement)
        sizes = {"m": judged.position_error, "rad": judged.orientation_error}
        counted = {"m": any(self.counts[:3]), "rad": any(self.counts[3:])}
        return {unit: size for unit, size in sizes.items() if counted[unit]}

    def judge(self, placement: pin.SE3) -> Judgement:
        """How far a world placement is from this target, and whether that is within the tolerances; by Pinocchio."""
        instance(pin.SE3, placement=placement)
        error = self.pose.actInv(placement)
        position, near = _measure(error.translation.tolist(), self.position_tolerance)
        orientation, aligned = _measure(pin.log3(error.rotation).tolist(), self.orientation_tolerance)
        return Judgement(position, orientation, near and aligned)


class Anywhere(Target):
    """What every pose meets: the target of a frame that only other goals are about."""

    _asks: ClassVar[bool] = False


TargetLike: TypeAlias = Target | pin.SE3 | ArrayLike


class Judgement(NamedTuple):
    """Distance (m) and angle (rad) over the axes that count, and whether they are within the tolerances."""

    position_error: float
    orientation_error: float
    met: bool


def _measure(error: list[float], tolerance: Tolerance) -> tuple[float, bool]:
    """Size of an error (3,) over the axes that are not free, and whether it is within the tolerance."""
    if isinstance(tolerance, tuple):
        within = all(abs(e) <= t for e, t in zip(error, tolerance, strict=True))
        return math.hypot(*(e for e, t in zip(error, tolerance, strict=True) if t < FREE)), within
    if tolerance == FREE:
        return 0.0, True
    size = math.hypot(*error)
    return size, size <= tolerance


def _read(name: str, tolerance: object) -> Read:
    """A tolerance that somebody gave: a number, or three in a tuple, list or array."""
    if type(tolerance) is float or type(tolerance) is tuple:
        try:
            return _slack(name, tolerance)
        except TypeError:  # a tuple of what has no hash
            pass
    return _slack(name, _as_tolerance(name, tolerance))


def _as_tolerance(name: str, tolerance: object) -> Tolerance:
    """The same as a float or a tuple of three."""
    try:
        given = np.asarray(tolerance, dtype=float)
    except (TypeError, ValueError, OverflowError):
        given = np.empty(0)
    if given.shape not in ((), (3,)) or not (given > 0.0).all():
        raise InvalidTarget(f"{name} is a number above 0, or three of them (inf frees an axis), got {tolerance!r}")
    return float(given) if given.ndim == 0 else (float(given[0]), float(given[1]), float(given[2]))


def _radius(tolerance: float | tuple[float, ...]) -> float:
    return math.hypot(*tolerance) if isinstance(tolerance, tuple) else tolerance


@lru_cache(KEPT)
def _finite(slack: tuple[float, ...]) -> tuple[bool, ...]:
    return tuple(s < FREE for s in slack)


@lru_cache(KEPT)
def _slack(name: str, given: Tolerance) -> Read:
    """A tolerance; as the kernels take it, a little tighter, slack per axis and radius beyond it; and if it is loose.

    One number is aimed at in the middle, where an answer is best; see ``_whole`` for when there is none.
    """
    tolerance = _as_tolerance(name, given)
    each = tolerance if isinstance(tolerance, tuple) else (tolerance,)
    loose = any(DEFAULT_TOLERANCE < t < FREE for t in each)
    if isinstance(tolerance, tuple):
        return tolerance, (0.9 * tolerance[0], 0.9 * tolerance[1], 0.9 * tolerance[2]), 0.099 * min(tolerance), loose
    if tolerance == FREE:
        return tolerance, (FREE, FREE, FREE), FREE, loose
    return tolerance, (0.0, 0.0, 0.0), 0.999 * tolerance, loose


@lru_cache(KEPT)
def _whole(tolerance: Tolerance) -> tuple[tuple[float, float, float], float]:
    """The same of all that is accepted: a box for three numbers, a ball (minus its radius, thrice) for one."""
    if isinstance(tolerance, tuple):
        return (WHOLE * tolerance[0], WHOLE * tolerance[1], WHOLE * tolerance[2]), EDGE * min(tolerance)
    return ((FREE,) * 3, FREE) if tolerance == FREE else ((-WHOLE * tolerance,) * 3, EDGE * tolerance)


def _as_set(tolerance: Tolerance) -> Grown:
    """The vectors (3,) within a tolerance, or a little less: see ``_whole``; of a tight radius, its middle."""
    (x, y, z), _ = _whole(tolerance)
    if tolerance == FREE or isinstance(tolerance, tuple):
        most = np.array([x, y, z])
        return Grown(-most, most)
    return Grown(0.0, 0.0, -x if tolerance > DEFAULT_TOLERANCE else 0.0)


def _weight(name: str, weight: float) -> float:
    if not (isinstance(weight, (int, float, np.integer, np.floating)) and 0.0 < weight <= sys.float_info.max):
        raise InvalidTarget(f"{name} is a finite number above 0, got {shown(weight)}")
    return float(weight)


ANYWHERE = Anywhere(pin.SE3.Identity(), position_tolerance=FREE, orientation_tolerance=FREE)
