"""All configurations of a chain of six coordinates for a pose of its frame, and whether they are proved to be all."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arrays import Array
from pin_metaik.kinematics.kernel.layout import COLUMN, ROTATES, SCALE, SHIFT
from pin_metaik.kinematics.limits import Limits
from pin_metaik.kinematics.paths import ChainArrays
from pin_metaik.kinematics.proofs.closed_forms import Place
from pin_metaik.kinematics.roots.real import BEYOND, NEARLY, REAL, UNBOUNDED

Complexes: TypeAlias = NDArray[np.complex128]
Ints: TypeAlias = NDArray[np.int64]
ComplexArrays: TypeAlias = tuple[Array, Ints, Array, Ints]

SIX = 6
BOUNDS = {0: 16, 1: 16, 2: 8, 3: 2}  # separate configurations of six joints, by how many of them slide
MOST = 64  # configurations, where joints move together
SEED = 20260101  # of the poses at which all configurations are known
IMAGINARY = 0.5  # rad or lengths, greatest imaginary part of configurations drawn there
BARREN, ROUNDS = 8, 100  # rounds that must bring nothing new before all are known there, and rounds at most
POSES, GOOD = 8, 0.5  # that loops are tried on; share of the roots that one must find to be used
LOOPS = 12
SAME = 1e-6  # rad or lengths: two nearer than this are one
TURN = 2.0 * np.pi


@dataclass(frozen=True, eq=False)
class Configurations:
    """What was found for one pose.

    Attributes:
        x: (k, 6) coordinates, real and complex.
        nearly: (l, 6) of what may be two of them that are nearly one, and nearly real.
        all: Whether as many were found as there are at other poses.
        proved: Whether it is proved that there are no others, not even a curve of them.
        evaluations: Forward kinematics computed.
    """

    x: Complexes
    nearly: Complexes
    all: bool
    proved: bool
    evaluations: int

    def inside(self, limits: Limits, x0: Array) -> tuple[Array, Array]:
        """(r, 6) those that are real and inside the limits; (s, 6) from where descents may end inside, too.

        Of copies by whole turns that count as one it is the one nearest to x0 (6,).
        """
        off = np.abs(self.x.imag).max(axis=1, initial=0.0)
        real = copies_inside(self.x[off < REAL].real, limits, x0)
        kept = ((limits.lower <= real) & (limits.upper >= real)).all(axis=1)
        nearly = np.concatenate([self.x[(off >= REAL) & (off < NEARLY)].real, self.nearly.real])
        return real[kept], np.concatenate([real[~kept], copies_inside(nearly, limits, x0)])

    def settle(
        self,
        block: Array,
        limits: Limits,
        settings: Array,
        near: float,
        aligned: float,
        pose: Array,
        *,
        apart: float,
        q: Array,
        out: Array,
    ) -> tuple[int, bool, int, *Place]:
        """Descend from all that is ``inside``, in one compiled call; see ``settle_roots``, which has the arguments."""
        from pin_metaik.kinematics.roots.real_roots import settle_roots

        rotates = limits.rotates.astype(np.int64)
        return settle_roots(block, rotates, settings, near, aligned, pose, self.x, self.nearly, apart, q, out)


@dataclass(frozen=True, eq=False)
class SixJoints:
    """What finds all configurations of six coordinates for a pose.

    In complex numbers nearly every pose has the same number of them, ``degree``. For two poses drawn at random all are
    known: those that elimination finds at others are led there, and all are followed round until nothing new appears.
    As what they are solutions of cannot be taken apart, each of them is led to every other one by some way round
    (monodromy; Sommese and Wampler 2005, 15.4).

    Attributes:
        arm: The arrays of ``ComplexArm``.
        length: m, the unit of lengths in them.
        degree: How many configurations a pose has: the most that were found for any.
        bound: How many it can have, by proof; 0: none is known.
        poses: (w, 12) poses at which they are known ...
        known: (w, k, 6) ... and they; k is the degree, but for arms whose configurations are nearly at infinity.
        loops: (l,) numbers of the loops of ``elimination`` that find most of them, best first.
    """

    arm: ComplexArrays
    length: float
    degree: int
    bound: int
    poses: Complexes
    known: Complexes
    loops: Ints

    def at(self, pose: Array, most: int = UNBOUNDED) -> Configurations:
        """All configurations for a world pose (4, 4) of the tip; those that ``most`` evaluations find."""
        from pin_metaik.kinematics.proofs.targets import exact_pose
        from pin_metaik.kinematics.roots.counting import simple_roots
        from pin_metaik.kinematics.roots.search import find_roots

        target = np.empty(12)
        exact_pose(pose, target)
        target[9:] /= self.length
        points, nearly = np.empty((2, MOST, SIX), np.complex128)
        found, near, spent = find_roots(
            *self.arm, target, self.loops, self.poses, self.known, self.degree, most, points, nearly
        )
        proved = found == self.bound and simple_roots(*self.arm, target, points[:found]) == self.bound
        return Configurations(points[:found], nearly[:near], found >= self.degree, proved, spent)


def six_joints(paths: ChainArrays) -> SixJoints | None:
    """What finds all configurations of a chain's coordinates for a pose; None, if it is no chain of six of one tip.

    Joints that follow another one turn at a whole multiple of it where it turns, and slide where it slides: otherwise a
    pose may have infinitely many complex configurations.
    """
    described = _described(paths)
    if described is None:
        return None
    arm, length = described
    joints, wiring, _, periodic = arm
    rng = np.random.default_rng(SEED)
    slides = int((wiring[:, ROTATES] == 0).sum())
    bound = BOUNDS.get(slides, 0) if len(joints) == SIX else 0
    size = np.where(periodic == 1, 1.0, length / np.pi)

    def drawn() -> Complexes:
        x: Complexes = size * (rng.uniform(-np.pi, np.pi, SIX) + 1j * rng.uniform(-IMAGINARY, IMAGINARY, SIX))
        return x

    x = drawn()
    start, known, degree, found = _pose(arm, x), x[None], 1, np.zeros(LOOPS)
    if len(joints) == SIX:
        real = [_pose(arm, drawn().real.astype(np.complex128)) for _ in range(POSES)]
        known, degree, found = _by_elimination(arm, start, known, real)
    known = _all_known(arm, start, known, lambda: _pose(arm, drawn()), bound or MOST)
    degree = max(degree, len(known))
    if degree > MOST // 2:
        return None
    poses, every = [start], [known]
    for _ in range(ROUNDS):
        pose = _pose(arm, drawn())
        ends = _distinct(arm, _followed(arm, start, known, pose))
        if len(ends) == len(known):
            poses, every = [*poses, pose], [*every, ends]
            break
    best = np.argsort(-found, kind="stable")[:2]
    loops = best[found[best] > GOOD * degree]
    return SixJoints(arm, length, degree, bound, np.array(poses), np.array(every), loops)


def copies_inside(X: Array, limits: Limits, x0: Array) -> Array:
    """Coordinates X (k, 6) as they are inside the limits, or not far outside, after whole turns.

    Those of a winding coordinate count as one, and come as the copy nearest to x0 (6,).
    """
    rotates, multi_turn = limits.rotates, limits.multi_turn
    least, most = limits.lower - BEYOND, limits.upper + BEYOND
    within = np.where((X - least >= 0.0) & (most - X >= 0.0), 0.0, -1.0)
    first = np.where(rotates, np.ceil((least - X) / TURN), 0.0)
    last = np.where(rotates, np.floor((most - X) / TURN), within)
    inside = (first <= last).all(axis=1)
    X, first, last = X[inside], first[inside], last[inside]
    nearest = np.minimum(np.maximum(np.round((x0 - X) / TURN), first), last)
    first, last = np.where(multi_turn, nearest, first), np.where(multi_turn, nearest, last)
    if (first == last).all():
        return X + TURN * first
    copies = []
    for x, a, b in zip(X, first, last, strict=True):
        turns = product(*(np.arange(low, high + 1.0) for low, high in zip(a, b, strict=True)))
        copies += [x + TURN * np.array(some) for some in turns]
    return np.array(copies)


def _described(paths: ChainArrays) -> tuple[ComplexArrays, float] | None:
    """The arrays of ``ComplexArm`` and the unit of length (m) in them; None for what is no chain of six of one tip."""
    joints, wiring, tip = paths.joints.copy(), np.ascontiguousarray(paths.wiring), paths.tips[0].copy()
    if len(paths.tips) != 1 or sorted(set(wiring[:, COLUMN].tolist())) != list(range(SIX)):
        return None
    periodic = np.empty(SIX, np.int64)
    for column in range(SIX):
        follows = wiring[:, COLUMN] == column
        turning, scales = wiring[follows, ROTATES], joints[follows, SCALE]
        if turning.min() != turning.max() or (turning.all() and (np.round(scales) != scales).any()):
            return None
        periodic[column] = turning.max()
    length = float(np.linalg.norm(joints[:, 9:12], axis=1).sum() + np.linalg.norm(tip[9:])) / 3.0
    length = length if length > 0.0 else 1.0
    joints[:, 9:12] /= length
    tip[9:] /= length
    joints[wiring[:, ROTATES] == 0, SCALE : SHIFT + 1] /= length
    return (joints, wiring, tip, periodic), length


def _pose(arm: ComplexArrays, x: Complexes) -> Complexes:
    """Pose (12,) at complex coordinates x (6,)."""
    from pin_metaik.kinematics.roots.complex_arm import complex_pose

    out = np.empty(12, np.complex128)
    complex_pose(*arm, x, out)
    return out


def _followed(arm: ComplexArrays, start: Complexes, points: Complexes, end: Complexes) -> Complexes:
    """Where points (k, 6) of the pose ``start`` are led at the pose ``end``; fewer, if some paths are lost."""
    from pin_metaik.kinematics.roots.continuation import follow_all

    points, arrived = points.copy(), np.zeros(len(points), np.int64)
    follow_all(*arm, start, end, points, arrived)
    found: Complexes = points[arrived == 1]
    return found


def _distinct(arm: ComplexArrays, points: Complexes) -> Complexes:
    """Points (k, 6), each once, whole turns aside."""
    kept: list[Complexes] = []
    for x in points:
        ways = [x - other for other in kept]
        turns = [np.where(arm[3] == 1, TURN * np.round(way.real / TURN), 0.0) for way in ways]
        if all(np.abs(way - turn).max() > SAME for way, turn in zip(ways, turns, strict=True)):
            kept.append(x)
    return np.array(kept).reshape(-1, SIX)


def _all_known(
    arm: ComplexArrays, start: Complexes, known: Complexes, draw: Callable[[], Complexes], most: int
) -> Complexes:
    """All configurations (k, 6) of the pose ``start``, of which some are known, by ways round through poses drawn."""
    barren = 0
    for _ in range(ROUNDS):
        at, points = start, known
        for pose in (draw(), draw(), start):
            at, points = pose, _followed(arm, at, points, pose)
        more = _distinct(arm, np.concatenate([known, points]))
        barren = 0 if len(more) > len(known) else barren + 1
        known = more
        if barren == BARREN or len(known) >= most:
            break
    return known


def _by_elimination(
    arm: ComplexArrays, start: Complexes, known: Complexes, poses: list[Complexes]
) -> tuple[Complexes, int, Array]:
    """Configurations (k, 6) of the pose ``start``, led there from those that elimination finds at some real poses.

    With those that are known there; the greatest number found at a pose, as paths from poses with many of them may be
    lost; and how many each of the twelve loops (12,) finds, on average.
    """
    from pin_metaik.kinematics.roots.search import find_roots

    degree, found, room = 1, np.zeros(LOOPS), np.empty((2, MOST, SIX), np.complex128)
    none = np.empty((0, 12), np.complex128), np.empty((0, MOST, SIX), np.complex128)
    for pose in poses:
        there = []
        for number in range(LOOPS):
            count, *_ = find_roots(*arm, pose.real.copy(), np.array([number]), *none, MOST, UNBOUNDED, *room)
            found[number] += count / len(poses)
            there.append(room[0, :count].copy())
        points = _distinct(arm, np.concatenate(there))
        degree = max(degree, len(points))
        if len(points):
            known = _distinct(arm, np.concatenate([known, _followed(arm, pose, points, start)]))
    return known, degree, found
