"""All roots for one pose: by elimination, and what that misses by continuation.

That elimination misses some is seen by counting: there are as many roots as at any other pose. Two of one loop that
share a joint value, and those whose values lie in singularities of the loop, are missed by that loop alone. Points of
curves, which some singular poses have beside separate roots, are none of them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from pin_metaik.compiled import Floats, Ints, allocating, inline, jit, shared
from pin_metaik.kinematics.kernel.forward import copy
from pin_metaik.kinematics.roots.complex_arm import (
    ARRIVED,
    SAME,
    ComplexArm,
    Complexes,
    ComplexScratch,
    added,
    complex_scratch,
    is_regular,
    newton,
)
from pin_metaik.kinematics.roots.continuation import PathScratch, follow_each, path_scratch
from pin_metaik.kinematics.roots.elimination import (
    ON_CIRCLE,
    ROOTS,
    EliminationScratch,
    coordinates_of,
    elimination_scratch,
    find_zeros,
)

STEPS, EXACT = 12, 1e-11  # of Newton's method from a zero; rad or lengths, its last one at a root
NEARLY, APART = 0.05, 1e-3  # imaginary part of what may be a real double root, rad or lengths; how far such are apart


class Roots(NamedTuple):
    """Where the roots for one pose are gathered.

    Attributes:
        target: (12,) the pose.
        points: (m, 6) roots.
        nearly: (l, 6) where Newton's method came to no end, or to a singularity, and which are nearly real.
        x: (6,) one at work ...
        values: (6,) ... and by joint.
    """

    target: Complexes
    points: Complexes
    nearly: Complexes
    x: Complexes
    values: Complexes


@allocating
def roots_of(target: Floats, points: Complexes, nearly: Complexes) -> Roots:
    """For a pose (12,), in arrays that are given."""
    pose = np.empty(12, np.complex128)
    copy(target, pose)
    return Roots(pose, points, nearly, np.empty(6, np.complex128), np.empty(6, np.complex128))


@inline
def nearly_real(x: Complexes) -> bool:
    """Whether no imaginary part is large."""
    most = 0.0
    for c in range(6):
        most = max(most, abs(x[c].imag))
    return most < NEARLY


@inline
def added_with_conjugate(arm: ComplexArm, x: Complexes, roots: Roots, found: int) -> int:
    """How many roots there are with x (6,) and its conjugate, which takes its place."""
    found = added(arm, x, roots.points, found, SAME)
    for c in range(6):
        x[c] = x[c].conjugate()
    return added(arm, x, roots.points, found, SAME)


@shared
def by_loop(
    arm: ComplexArm,
    target: Floats,
    number: int,
    roots: Roots,
    found: int,
    near: int,
    loop: EliminationScratch,
    work: ComplexScratch,
) -> tuple[int, int, int]:
    """Add the roots that one loop leads to: how many there are then, how many are nearly real, and evaluations.

    Those of zeros beyond the unit circle are the conjugates of others.
    """
    spent = 0
    if not find_zeros(arm, target, number, loop):
        return found, near, spent
    x = roots.x
    for k in range(ROOTS):
        z = complex(loop.zeros[k])
        inside = z.real * z.real + z.imag * z.imag < 1.0 + ON_CIRCLE and z != 0.0
        if not inside or not coordinates_of(arm, z, loop, roots.values, x):
            continue
        _, last, more = newton(arm, roots.target, x, STEPS, EXACT, work)
        spent += more
        if last < ARRIVED and is_regular(work):
            found = added_with_conjugate(arm, x, roots, found)
        elif nearly_real(x):
            near = added(arm, x, roots.nearly, near, APART)
    return found, near, spent


@shared
def by_paths(
    arm: ComplexArm,
    start: Complexes,
    ends: Complexes,
    arrived: Ints,
    roots: Roots,
    found: int,
    near: int,
    path: PathScratch,
    most: int,
    work: ComplexScratch,
) -> tuple[int, int, int]:
    """The same for the ends of paths from the pose ``start``, where ``ends`` (k, 6) are; they are moved.

    Paths end early where they take more than ``most`` evaluations together.
    """
    spent = follow_each(arm, start, roots.target, ends, arrived, path, most, work)
    x = roots.x
    for k in range(ends.shape[0]):
        for c in range(6):
            x[c] = ends[k, c]
        if arrived[k] == 1:
            found = added_with_conjugate(arm, x, roots, found)
        elif nearly_real(x):
            near = added(arm, x, roots.nearly, near, APART)
    return found, near, spent


@jit(
    "UniTuple(i8, 3)(f8[:,::1], i8[:,::1], f8[::1], i8[::1], f8[::1], i8[::1], c16[:,::1], c16[:,:,::1], i8,"
    " i8, c16[:,::1], c16[:,::1])"
)
def find_roots(
    joints: Floats,
    wiring: Ints,
    tip: Floats,
    periodic: Ints,
    target: Floats,
    loops: Ints,
    starts: Complexes,
    known: Complexes,
    degree: int,
    most: int,
    points: Complexes,
    nearly: Complexes,
) -> tuple[int, int, int]:
    """Find as many roots as there can be.

    Args:
        joints: The arm's arrays, down to ``periodic``; see ``ComplexArm``.
        wiring: ...
        tip: ...
        periodic: ...
        target: (12,) the pose.
        loops: (l,) numbers of the loops to try, until all are found.
        starts: (w, 12) poses to follow paths from after that, until all are found.
        known: (w, k, 6) their roots, as far as known.
        degree: How many there can be; the search ends with so many.
        most: Evaluations that it may take.
        points: (m, 6) gets the roots.
        nearly: (m, 6) gets what may be a double root, or one of a curve, and is nearly real.

    Returns:
        How many roots there are, how many that may be double, and evaluations.
    """
    arm, roots = ComplexArm(joints, wiring, tip, periodic), roots_of(target, points, nearly)
    work, loop, path = complex_scratch(), elimination_scratch(), path_scratch()
    ends, arrived = np.empty(known.shape[1:], np.complex128), np.empty(known.shape[1], np.int64)
    found = near = spent = 0
    for number in loops:
        if spent + ROOTS * STEPS > most:
            return found, near, spent
        found, near, more = by_loop(arm, target, number, roots, found, near, loop, work)
        spent += more
        if found >= degree:
            return found, near, spent
    for w in range(starts.shape[0]):
        for k in range(arrived.shape[0]):
            copy(known[w, k], ends[k])
        found, near, more = by_paths(arm, starts[w], ends, arrived, roots, found, near, path, most - spent, work)
        spent += more
        if found >= degree:
            break
    return found, near, spent
