"""Solutions beside a curve that may be another one's: two are near to each other only where both are nearly singular.

At x + s v beside a solution x, the target is missed by s sigma u + s^2 / 2 h, with sigma the least singular value of
the Jacobian, u and v its vectors, and h the second derivative along v. What u sees of that is zero at s = 0, and again
at s = -2 sigma / (u . h): on the other side of a fold, from where Newton's method goes on (Golubitsky and Schaeffer,
"Singularities and Groups in Bifurcation Theory", 1985, chapter I).
"""

from __future__ import annotations

import math

from pin_metaik.compiled import Floats, Ints, inline, jit, shared
from pin_metaik.kinematics.kernel.forward import sizes_of, unpack
from pin_metaik.kinematics.kernel.layout import Arm
from pin_metaik.kinematics.kernel.scratch import Scratch, scratch_for
from pin_metaik.kinematics.self_motion.trace import (
    CurveScratch,
    curve_scratch,
    put_on_curve,
    solve_system,
    write_equations,
)

WEAK = 0.3  # a first guess at the least singular value, never too small, from which on there is nothing beside
ROUNDS = 3  # of inverse iteration
DIFFERENCE = 1e-4  # rad or m, for second derivatives
FARTHEST = 0.1  # rad or m from a curve: what is farther has boxes of its own
EVERY = 4  # of the points of a curve is looked at


@inline
def solve_beside(J: Floats, tangent: Floats, transposed: bool, right: Floats, M: Floats, out: Floats) -> float:
    """Solve A y = right (n,), or A' y = right: the length of y, infinite in a singularity; ``out`` gets y of length 1.

    A has the rows of the Jacobian, whose transposed is J (n, n - 1), and the tangent. M (n, n + 2) is scratch.
    """
    n, square = tangent.shape[0], 0.0
    for c in range(n):
        for a in range(n):
            entry = J[c, a] if a < n - 1 else tangent[c]
            if transposed:
                M[c, a] = entry
            else:
                M[a, c] = entry
        M[c, n], M[c, n + 1] = right[c], 0.0
    if not solve_system(M):
        return math.inf
    for c in range(n):
        square += M[c, n] * M[c, n]
    for c in range(n):
        out[c] = M[c, n] / math.sqrt(square)
    return math.sqrt(square)


@shared
def twin_of(
    arm: Arm,
    goals: Floats,
    rows: Ints | None,
    x: Floats,
    tangent: Floats,
    twin: Floats,
    curve: CurveScratch,
    work: Scratch,
) -> bool:
    """Whether there is a solution beside a point x (n,) of a curve, with its tangent there; ``twin`` (n,) gets it."""
    n, M, u, v = x.shape[0], curve.system, curve.before, curve.trial
    for c in range(n):
        u[c] = 1.0 / math.sqrt(n)
    write_equations(arm, goals, rows, x, M, work)
    length = solve_beside(work.J, tangent, False, u, M, v)
    if length * WEAK < 1.0 or length == math.inf:
        return False
    for _ in range(ROUNDS):
        solve_beside(work.J, tangent, True, v, M, u)
        length = solve_beside(work.J, tangent, False, u, M, v)
    bend = 0.0
    for side in range(-1, 2, 2):
        for c in range(n):
            twin[c] = x[c] + side * DIFFERENCE * v[c]
        write_equations(arm, goals, rows, twin, M, work)
        for a in range(n - 1):
            bend -= u[a] * M[a, n] / DIFFERENCE**2
    if FARTHEST * abs(bend) * length < 2.0:
        return False
    for c in range(n):
        twin[c] = x[c] - 2.0 / (bend * length) * v[c]
    first, _ = put_on_curve(arm, goals, rows, twin, tangent, math.nan, curve, work)
    return first < math.inf


@shared
def write_twins(
    block: Floats,
    goals: Floats,
    rows: Ints | None,
    points: Floats,
    tangents: Floats,
    twins: Floats,
    curve: CurveScratch,
    work: Scratch,
) -> int:
    """``find_twins`` in room that was made for it."""
    arm, found = unpack(block).arm, 0
    for i in range(0, points.shape[0], EVERY):
        if twin_of(arm, goals, rows, points[i], tangents[i], twins[found], curve, work):
            found += 1
    return found


@jit("i8(f8[::1], f8[:,::1], i8[:,::1]?, f8[:,::1], f8[:,::1], f8[:,::1])")
def find_twins(block: Floats, goals: Floats, rows: Ints | None, points: Floats, tangents: Floats, twins: Floats) -> int:
    """Find solutions beside a curve, which may be outside the limits.

    Args:
        block: The chain.
        goals: (T, GOAL).
        rows: (n - 1, 2) what counts of them; None for one tip's whole pose.
        points: (p, n) on the curve, in order.
        tangents: (p, n) there.
        twins: (at least p / EVERY, n) gets them.

    Returns:
        How many there are.
    """
    S, n, _ = sizes_of(block)
    return write_twins(block, goals, rows, points, tangents, twins, curve_scratch(n), scratch_for(n, rows, S))
