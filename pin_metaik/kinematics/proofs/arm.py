"""A path of a chain as boxes take it: joint by joint, from the base or from the tip, with a wrist where there is one.

What a target leaves free becomes joints of its own at the tip: a position alone a wrist that turns without limits.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from pin_metaik.kinematics.kernel.layout import COLUMN, POSE, ROTATES, ROUNDING, SCALE, SHIFT
from pin_metaik.kinematics.limits import Limits
from pin_metaik.kinematics.paths import ChainArrays, matrix_of
from pin_metaik.kinematics.reach import links_of, tightened

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Arrays: TypeAlias = tuple[Floats, Ints, Floats, Floats, Floats, Floats, Floats, Ints]
Free: TypeAlias = tuple[bool, bool, bool]  # which turns about the tip's axes x, y and z a target leaves free

WHOLE: Free = (False, False, False)
MEET = 1e-5  # m: axes that miss a point by less meet, and what they miss it by is added to the tolerance
APART = 1e-6  # least singular value at which three axes count as pointing different ways


@dataclass(frozen=True, eq=False)
class Path:
    """The joints from the world to one tip, whichever end is the world.

    Attributes:
        joints: (S, 14) placement, scale and shift of each; see ``kernel.layout``.
        wiring: (S, 2) coordinate, and whether it turns.
        tip: (12,) placement of the tip in the last joint frame.
    """

    joints: Floats
    wiring: NDArray[np.int64]
    tip: Floats

    def reversed(self) -> Path:
        """The same joints seen from the tip, with the world as the tip."""
        links = [np.linalg.inv(matrix_of(row)) for row in [*self.joints, self.tip]][::-1]
        rows = [np.append(_flat(link), -row[POSE:]) for link, row in zip(links[:-1], self.joints[::-1], strict=True)]
        return Path(np.array(rows), np.ascontiguousarray(self.wiring[::-1]), _flat(links[-1]))

    def with_turn(self, first: int, axis: int) -> Path:
        """The path with one more joint at the tip, about its axis x, y or z (0, 1, 2), with coordinate ``first``."""
        turned = np.roll(np.eye(3), axis - 2, axis=0)  # a frame whose z is that axis
        at_tip, back = np.eye(4), np.eye(4)
        at_tip[:3, :3], back[:3, :3] = turned, turned.T
        joint = np.append(_flat(matrix_of(self.tip) @ at_tip), [1.0, 0.0])
        return Path(np.vstack([self.joints, joint]), np.vstack([self.wiring, [[first, 1]]]), _flat(back))

    def with_wrist(self, first: int) -> Path:
        """The path with three more joints at the tip, about its axes z, y and z, with coordinates from ``first`` on."""
        at_tip = np.append(self.tip, [1.0, 0.0])
        about_y = np.array([1.0, 0, 0, 0, 0, 1, 0, -1, 0, 0, 0, 0, 1, 0])  # a frame whose z is the last one's y
        back = np.array([1.0, 0, 0, 0, 0, -1, 0, 1, 0, 0, 0, 0, 1, 0])
        joints = np.vstack([self.joints, at_tip, about_y, back])
        wiring = np.vstack([self.wiring, [[first + i, 1] for i in range(3)]])
        return Path(joints, wiring, _flat(np.eye(4)))

    def frames(self, x: Floats) -> Floats:
        """World placements (S + 1, 4, 4) of the joints, before they move, and of the tip at coordinates x (n,)."""
        frames, placement = [], np.eye(4)
        for row, (column, turns) in zip(self.joints, self.wiring, strict=True):
            placement = placement @ matrix_of(row)
            frames.append(placement)
            value, motion = row[SCALE] * x[column] + row[SHIFT], np.eye(4)
            if turns:
                c, s = np.cos(value), np.sin(value)
                motion[:2, :2] = [[c, -s], [s, c]]
            else:
                motion[2, 3] = value
            placement = placement @ motion
        return np.array([*frames, placement @ matrix_of(self.tip)])


@dataclass(frozen=True, eq=False)
class ProofArm:
    """What ``cover`` takes of a path, and how a target is put to it.

    Attributes:
        arrays: The arrays of ``BoxArm``.
        backwards: Whether the path leads from the tip to the world.
        n: Number of the chain's coordinates; those after them are free joints at the tip.
    """

    arrays: Arrays
    backwards: bool
    n: int

    @property
    def whole(self) -> Floats:
        """(1, 2 m) the box of all configurations inside the limits, as ``cover`` begins with it."""
        lower, upper = self.arrays[4], self.arrays[5]
        return np.concatenate([0.5 * (lower + upper), 0.5 * (upper - lower)])[None]

    @property
    def shrinking(self) -> ProofArm:
        """The same arm, but boxes are shrunk around solutions, and tell of the joints of a wrist; see ``BoxArm``."""
        from pin_metaik.kinematics.proofs.box import BENT, FREE, SPLIT

        has_wrist, _, has_shoulder = self.arrays[7]
        own = int((self.arrays[1][-3:, COLUMN] < self.n).sum())
        how = FREE if not has_wrist or own == 0 else BENT if own == 3 else SPLIT
        return replace(self, arrays=(*self.arrays[:7], np.array([has_wrist, how, has_shoulder])))

    @property
    def cover(self) -> Callable[..., tuple[int, int, int]]:
        """The loop that looks at its boxes; it takes ``arrays`` first."""
        from pin_metaik.kinematics.proofs.box import BENT
        from pin_metaik.kinematics.proofs.box_search import cover
        from pin_metaik.kinematics.proofs.box_wrist_search import cover_with_wrist

        return cover_with_wrist if self.arrays[7][1] == BENT else cover

    @property
    def movers(self) -> int:
        """How many of the chain's coordinates move the tip."""
        return int((np.unique(self.arrays[1][:, 0]) < self.n).sum())

    @property
    def reach(self) -> float:
        """Greatest distance of two points of the path, m."""
        return float(self.arrays[6][0])

    def target(self, pose: Floats, near: float, aligned: float) -> tuple[Floats, float, float]:
        """A pose (4, 4) and tolerances (m, rad) as ``cover`` takes them, with the rounding of its bounds."""
        from pin_metaik.kinematics.proofs.targets import exact_pose

        exact = np.empty(12)
        skew = exact_pose(pose, exact)
        rotation, place = exact[:9].reshape(3, 3), exact[9:]
        near, aligned = (1.0 + skew) * near, aligned + 2.0 * skew
        if self.backwards:
            near += aligned * float(np.linalg.norm(place))
            rotation, place = rotation.T, -rotation.T @ place
        rounding = ROUNDING * (1.0 + self.reach)
        return np.append(rotation.ravel(), place), near + aligned * self.reach + rounding, aligned + ROUNDING


def proof_arm(paths: ChainArrays, limits: Limits, tip: int, free: Free) -> ProofArm | None:
    """The arm of tip number ``tip`` for targets that leave some turns about the tip's axes free; None: no bounds.

    Two free axes count as three, which is more than the target allows, so that what is proved holds. There are no
    bounds for slides without limits, and for angles without limits that other joints follow at a scale.
    """
    first, last = paths.ends[tip], paths.ends[tip + 1]
    path = Path(paths.joints[first:last], paths.wiring[first:last], paths.tips[tip])
    box = _bounded(path, limits)
    if box is None:
        return None
    lower, upper = box
    n = len(lower)
    if any(free):
        path = path.with_turn(n, free.index(True)) if sum(free) == 1 else path.with_wrist(n)
        turns = len(path.joints) - (last - first)
        lower, upper = np.append(lower, [-np.pi] * turns), np.append(upper, [np.pi] * turns)
    ways = path, path.reversed()
    ends = [_Meeting.of(way, lower, upper) for way in ways]
    backwards = ends[1].points > ends[0].points
    path, meeting = ways[backwards], ends[backwards]
    knots = _knots(path, lower, upper)
    if meeting.wrist is not None:
        knots[-3:] = meeting.wrist
    if meeting.shoulder is not None:
        knots[1:3] = meeting.shoulder
    arrays = (
        np.ascontiguousarray(path.joints),
        np.ascontiguousarray(path.wiring),
        knots,
        path.tip,
        lower,
        upper,
        np.array([_reach(path, knots, lower, upper), *meeting.misses(path, knots)]),
        np.array([int(meeting.wrist is not None), 0, int(meeting.shoulder is not None)]),
    )
    return ProofArm(arrays, backwards, n)


def _bounded(path: Path, limits: Limits) -> tuple[Floats, Floats] | None:
    """Limits (n,) of the coordinates, at most a turn of those that a turn does not change; None if there are none."""
    one = limits.one_turn()
    lower, upper = one.lower.copy(), one.upper.copy()
    for column in range(len(lower)):
        on_path = path.wiring[:, COLUMN] == column
        if not on_path.any():
            lower[column] = upper[column] = 0.0
        elif not np.isfinite([lower[column], upper[column]]).all():
            scales = path.joints[on_path, SCALE]
            if not path.wiring[on_path, ROTATES].all() or (np.round(scales) != scales).any():
                return None
            lower[column] = -np.pi if np.isinf(upper[column]) else upper[column] - 2.0 * np.pi
            lower[column] = one.lower[column] if np.isfinite(one.lower[column]) else lower[column]
            upper[column] = lower[column] + 2.0 * np.pi if np.isinf(upper[column]) else upper[column]
    return lower, upper


def _knots(path: Path, lower: Floats, upper: Floats) -> Floats:
    """Where on each axis its point is (S,), so that the links between them are short in sum; 0 for slides."""
    S = len(path.joints)
    paths = ChainArrays(path.joints, path.wiring, np.array([0, S]), path.tip[None])
    links, _, _ = links_of(paths, lower, upper, 0)
    knots = np.zeros(S)
    if links:
        knots[path.wiring[:, ROTATES] == 1] = tightened(links[1:], len(links))[0]
    return knots


@dataclass(frozen=True)
class _Meeting:
    """Where axes of a path meet.

    Attributes:
        wrist: Where on the last three axes (3,), if they do and nothing else follows their coordinates.
        shoulder: Where on axes 2 and 3 (2,), if there are four joints before a wrist and each turns by itself.
    """

    wrist: Floats | None
    shoulder: Floats | None

    @classmethod
    def of(cls, path: Path, lower: Floats, upper: Floats) -> _Meeting:
        """Look at them in a configuration that is nothing special."""
        columns = path.wiring[:, COLUMN]
        own = np.array([turns and (columns == c).sum() == 1 for c, turns in path.wiring])
        frames, wrist, shoulder = path.frames(lower + 0.37 * (upper - lower)), None, None
        if len(own) > 3 and own[-3:].all():
            wrist = _meeting_of(frames[-4:-1])
        if wrist is not None and len(own) == 7 and own.all():
            shoulder = _meeting_of(frames[1:3])
        return cls(wrist, shoulder)

    @property
    def points(self) -> int:
        """How many there are."""
        return int(self.wrist is not None) + int(self.shoulder is not None)

    def misses(self, path: Path, knots: Floats) -> tuple[float, float]:
        """How far (m) turns move the points of wrist and shoulder, as the axes do not quite meet."""
        frames = path.frames(np.zeros(int(path.wiring[:, COLUMN].max()) + 1))[:-1]
        points, of_wrist, of_shoulder = frames[:, :3, 3] + knots[:, None] * frames[:, :3, 2], 0.0, 0.0
        if self.wrist is not None:
            first, second = np.linalg.norm(np.diff(points[-3:], axis=0), axis=1)
            of_wrist = float(4.0 * first + 2.0 * second)  # about axis 2, by twice the distance; about 3, by twice both
        if self.shoulder is not None:
            of_shoulder = float(2.0 * np.linalg.norm(points[2] - points[1]))
        return of_wrist, of_shoulder


def _meeting_of(frames: Floats) -> Floats | None:
    """Where on the z axes of frames (k, 4, 4) they meet (k,), if they do and each points another way than the next."""
    axes, points = frames[:, :3, 2], frames[:, :3, 3]
    across = np.eye(3) - axes[:, :, None] * axes[:, None]
    where, _, _, singular = np.linalg.lstsq(across.sum(axis=0), np.einsum("kij,kj->i", across, points), rcond=None)
    off = np.linalg.norm(np.einsum("kij,kj->ki", across, where - points), axis=1)
    turning = np.linalg.norm(np.cross(axes[:-1], axes[1:]), axis=1) > APART  # two that are parallel would be one
    if singular[-1] < APART or off.max() > MEET or not turning.all():
        return None
    met: Floats = np.einsum("ki,ki->k", where - points, axes)
    return met


def _reach(path: Path, knots: Floats, lower: Floats, upper: Floats) -> float:
    """Greatest distance (m) that points on the axes, and the tip, can have from each other."""
    frames = path.frames(0.5 * (lower + upper))
    points = frames[:, :3, 3].copy()
    points[:-1] += knots[:, None] * frames[:-1, :3, 2]
    slides = path.wiring[:, ROTATES] == 0
    travel = np.abs(path.joints[slides, SCALE]) * (upper - lower)[path.wiring[slides, COLUMN]]
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum() + travel.sum())


def _flat(matrix: NDArray[Any]) -> Floats:
    """A placement (4, 4) as (12,): rotation row by row, then translation."""
    return np.append(matrix[:3, :3].ravel(), matrix[:3, 3])
