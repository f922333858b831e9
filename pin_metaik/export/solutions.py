"""What exported code does around the kernels: of branches or roots, it gives the solutions inside the limits.

These functions are translated and never run here, like ``sources.miss``; they are in the kernels' subset of Python.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from pin_metaik.compiled import Floats, Ints
from pin_metaik.export.c_types import NUMBER, WHOLE, Array, Kind
from pin_metaik.export.sources import miss
from pin_metaik.kinematics.kernel.closed_form import OUTSIDE, branch
from pin_metaik.kinematics.kernel.forward import nearest_turn
from pin_metaik.kinematics.kernel.multistart import is_new
from pin_metaik.kinematics.roots.complex_arm import (
    ARRIVED,
    ComplexArm,
    Complexes,
    ComplexScratch,
    aim,
    complex_scratch,
    newton,
    place,
)
from pin_metaik.kinematics.roots.real import BEYOND, FOR_ROOTS, NEARLY, REAL
from pin_metaik.kinematics.roots.search import EXACT, STEPS, find_roots
from pin_metaik.kinematics.roots.six_joints import MOST

TOLERANCE = 1e-5  # m and rad from the pose
APART = 1e-2  # rad or m by which some joint of two solutions differs


class FormArm(NamedTuple):
    """An arm with a closed form.

    Attributes:
        form: (16, 3) its closed form; see ``kernel.layout``.
        columns: (6,) the coordinate of each joint, from the base on.
    """

    form: Floats
    columns: Ints


class RootsArm(NamedTuple):
    """Six coordinates whose roots are found; see ``SixJoints``.

    Attributes:
        joints: (S, 14) its arrays as ``ComplexArm`` has them, down to ``periodic`` ...
        wiring: (S, 2) ...
        tip: (12,) ...
        periodic: (6,) ...
        length: m, the unit of lengths in them.
        loops: (l,) numbers of the loops that find most of them.
        starts: (w, 12) poses at which they are known ...
        known: (w, k, 6) ... and they.
        degree: How many a pose has.
    """

    joints: Floats
    wiring: Ints
    tip: Floats
    periodic: Ints
    length: float
    loops: Ints
    starts: Complexes
    known: Complexes
    degree: int


class Wanted(NamedTuple):
    """Where solutions may be.

    Attributes:
        lower: (6,) limits, rad or m ...
        upper: (6,) ...
        rotates: (6,) 1 for an angle.
        multi_turn: (6,) 1 for an angle that has several copies inside the limits, which count as one solution.
        near: (6,) to what whole turns shall bring them near.
    """

    lower: Floats
    upper: Floats
    rotates: Ints
    multi_turn: Ints
    near: Floats


CONSTANT = ComplexArm, FormArm, RootsArm, Wanted  # arrays in these are never written
CALLED_WITH: tuple[Kind, ...] = (
    Array(NUMBER, (12,)),
    Array(NUMBER, (None, 6)),
    WHOLE,
)  # after the arm and what is wanted


def is_inside(wanted: Wanted, beyond: float, x: Floats) -> bool:
    """Bring x (6,) near by whole turns, and back from up to ``beyond`` a limit; False if it is further outside."""
    for c in range(6):
        least, most = wanted.lower[c] - beyond, wanted.upper[c] + beyond
        value = nearest_turn(x[c], wanted.near[c], least, most) if wanted.rotates[c] == 1 else x[c]
        if not least <= value <= most:
            return False
        x[c] = min(max(value, wanted.lower[c]), wanted.upper[c])
    return True


def far_from(near: Floats, x: Floats) -> float:
    """The squared distance of two configurations (6,)."""
    far = 0.0
    for c in range(6):
        far += (x[c] - near[c]) * (x[c] - near[c])
    return far


def with_solution(wanted: Wanted, x: Floats, solutions: Floats, count: int, most: int) -> int:
    """How many solutions there are with x (6,), which is added if it is new: the nearest ``most``, nearest first."""
    if most <= 0 or not is_new(x, solutions, count, wanted.multi_turn, APART):
        return count
    far = far_from(wanted.near, x)
    if count == most:
        if far_from(wanted.near, solutions[count - 1]) <= far:
            return count
        count -= 1
    at = count
    while at > 0 and far_from(wanted.near, solutions[at - 1]) > far:
        for c in range(6):
            solutions[at, c] = solutions[at - 1, c]
        at -= 1
    for c in range(6):
        solutions[at, c] = x[c]
    return count + 1


def by_branches(arm: FormArm, wanted: Wanted, target: Floats, solutions: Floats, most: int) -> int:
    """How many solutions (most, 6) a closed form gives for a pose (12,)."""
    form, columns, near = arm.form, arm.columns, wanted.near
    T, x, count = target, np.empty(6), 0
    pose = T[0], T[1], T[2], T[3], T[4], T[5], T[6], T[7], T[8], T[9], T[10], T[11]
    guess = (
        near[columns[0]], near[columns[1]], near[columns[2]], near[columns[3]], near[columns[4]], near[columns[5]],
    )  # fmt: skip
    for number in range(8):
        angles, there = branch(form, pose, guess, number)
        for s in range(6):
            x[columns[s]] = angles[s]
        if there and miss(form, pose, angles) <= TOLERANCE * TOLERANCE and is_inside(wanted, OUTSIDE, x):
            count = with_solution(wanted, x, solutions, count, most)
    return count


def reaches(arm: ComplexArm, length: float, target: Complexes, z: Complexes, work: ComplexScratch) -> bool:
    """Whether coordinates z (6,) are within the tolerances of a pose (12,); ``length`` is the unit of lengths in m."""
    place(arm, z, work)
    aim(target, work)
    J = work.twists
    away = math.sqrt(
        (work.pose[9] - target[9]).real ** 2 + (work.pose[10] - target[10]).real ** 2
        + (work.pose[11] - target[11]).real ** 2
    )  # fmt: skip
    turned = math.sqrt(J[3, 6].real ** 2 + J[4, 6].real ** 2 + J[5, 6].real ** 2)
    return length * away <= TOLERANCE and turned <= TOLERANCE


def is_real_solution(
    arm: ComplexArm,
    length: float,
    target: Complexes,
    root: Complexes,
    wanted: Wanted,
    z: Complexes,
    x: Floats,
    work: ComplexScratch,
) -> bool:
    """Whether a root (6,), or what is nearly one, leads to a real solution inside the limits, which x (6,) gets.

    What is not real to rounding is where Newton's method begins once more, in reals. ``z`` (6,) is room.
    """
    off = 0.0
    for c in range(6):
        off = max(off, abs(root[c].imag))
        x[c] = root[c].real
        z[c] = x[c]
    if off >= NEARLY:
        return False
    if off >= REAL:
        _, last, _ = newton(arm, target, z, STEPS, EXACT, work)
        if last < ARRIVED:
            for c in range(6):
                x[c] = z[c].real
    if not is_inside(wanted, BEYOND, x):
        return False
    for c in range(6):
        z[c] = x[c]
    return reaches(arm, length, target, z, work)


def by_roots(six: RootsArm, wanted: Wanted, target: Floats, solutions: Floats, most: int) -> int:
    """How many solutions (most, 6) the roots of six joints give for a pose (12,)."""
    joints, wiring, tip, periodic, length = six.joints, six.wiring, six.tip, six.periodic, six.length
    scaled, pose = np.empty(12), np.empty(12, np.complex128)
    for k in range(12):
        scaled[k] = target[k] / length if k > 8 else target[k]
        pose[k] = scaled[k]
    points, nearly = np.empty((MOST, 6), np.complex128), np.empty((MOST, 6), np.complex128)
    found, close, _ = find_roots(
        joints, wiring, tip, periodic, scaled, six.loops, six.starts, six.known, six.degree, FOR_ROOTS, points, nearly
    )
    arm = ComplexArm(joints, wiring, tip, periodic)
    z, x, work, count = np.empty(6, np.complex128), np.empty(6), complex_scratch(), 0
    for k in range(found):
        if is_real_solution(arm, length, pose, points[k], wanted, z, x, work):
            count = with_solution(wanted, x, solutions, count, most)
    for k in range(close):
        if is_real_solution(arm, length, pose, nearly[k], wanted, z, x, work):
            count = with_solution(wanted, x, solutions, count, most)
    return count
