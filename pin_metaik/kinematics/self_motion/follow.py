"""The curve through a solution, from end to end: along its tangent, and against it."""

from __future__ import annotations

import math

from pin_metaik.compiled import Floats, Ints, inline, jit, shared
from pin_metaik.kinematics.kernel.forward import copy, sizes_of, unpack
from pin_metaik.kinematics.kernel.layout import Arm, Bounds
from pin_metaik.kinematics.kernel.scratch import Scratch, scratch_for
from pin_metaik.kinematics.self_motion.trace import (
    CLOSED,
    CurveScratch,
    curve_scratch,
    put_on_curve,
    trace,
    write_equations,
)


@inline
def null_direction(M: Floats, solved: Floats, direction: Floats) -> bool:
    """The vector (n,) that n - 1 equations, the first rows of M (n, n + 2), map to zero; False if there are several.

    By elimination with the largest pivots; ``solved`` (n,) is scratch for their columns, and M is written.
    """
    n = direction.shape[0]
    for r in range(n - 1):
        at, column, largest = r, 0, 0.0
        for i in range(r, n - 1):
            for c in range(n):
                if abs(M[i, c]) > largest:
                    at, column, largest = i, c, abs(M[i, c])
        if largest == 0.0:
            return False
        solved[r] = column
        inverse = 1.0 / M[at, column]
        for c in range(n):
            M[r, c], M[at, c] = inverse * M[at, c], M[r, c]
        M[r, column] = 1.0
        for i in range(n - 1):
            factor = M[i, column]
            if i != r:
                for c in range(n):
                    M[i, c] -= factor * M[r, c]
                M[i, column] = 0.0
    direction[:] = 1.0
    for r in range(n - 1):
        direction[int(solved[r])] = 0.0
    free = 0
    for c in range(n):
        free = c if direction[c] == 1.0 else free
    for r in range(n - 1):
        direction[int(solved[r])] = -M[r, free]
    return True


@inline
def put_solution(
    arm: Arm, goals: Floats, rows: Ints | None, x: Floats, bounds: Bounds, curve: CurveScratch, work: Scratch
) -> bool:
    """Put a solution x (n,) onto the curve, inside its bounds; ``ahead`` gets the tangent. False in a singularity."""
    write_equations(arm, goals, rows, x, curve.system, work)
    n, tangent = x.shape[0], curve.tangent
    if not null_direction(curve.system, curve.before, tangent):
        return False
    size = 0.0
    for c in range(n):
        size += tangent[c] * tangent[c]
    for c in range(n):
        tangent[c] /= math.sqrt(size)
    first, _ = put_on_curve(arm, goals, rows, x, tangent, math.nan, curve, work)
    for c in range(n):
        if bounds.multi_turn[c] == 0:
            x[c] = min(max(x[c], bounds.lower[c]), bounds.upper[c])
    return first < math.inf


@inline
def add(x: Floats, tangent: Floats, count: int, points: Floats, tangents: Floats, t: Floats) -> int:
    """Write a point (n,) and its tangent as the next ones of a curve, if it is not the last one again; how many now."""
    length = 0.0
    if count > 0:
        for c in range(x.shape[0]):
            length += (x[c] - points[count - 1, c]) ** 2
        length = t[count - 1] + math.sqrt(length)
        if length == t[count - 1]:
            return count
    copy(x, points[count])
    copy(tangent, tangents[count])
    t[count] = length
    return count + 1


@shared
def follow_in(
    block: Floats,
    goals: Floats,
    rows: Ints | None,
    bounds: Bounds,
    x: Floats,
    longest: float,
    most: int,
    ways: Floats,
    points: Floats,
    tangents: Floats,
    t: Floats,
    curve: CurveScratch,
    work: Scratch,
) -> tuple[int, int, int, int, int, int]:
    """``follow`` in room that was made for it; ``ways`` (4, k, n) is for points and tangents, either way."""
    arm = unpack(block).arm
    if not put_solution(arm, goals, rows, x, bounds, curve, work):
        return 0, 0, 0, 0, 0, 0
    copy(curve.ahead, ways[1, 0])
    copy(curve.ahead, ways[3, 0])
    ahead, end, at, spent = trace(arm, goals, rows, bounds, x, 1.0, longest, most, ways[0], ways[1], curve, work)
    count, begin, at_begin = 0, end, at
    if end != CLOSED:
        behind, begin, at_begin, more = trace(
            arm, goals, rows, bounds, x, -1.0, longest, most - spent, ways[2], ways[3], curve, work
        )
        spent += more
        for i in range(behind - 1, 0, -1):
            for c in range(x.shape[0]):
                ways[3, i, c] = -ways[3, i, c]
            count = add(ways[2, i], ways[3, i], count, points, tangents, t)
    for i in range(ahead):
        count = add(ways[0, i], ways[1, i], count, points, tangents, t)
    return count, begin, at_begin, end, at, spent


@jit(
    "UniTuple(i8, 6)(f8[::1], f8[:,::1], i8[:,::1]?, f8[::1], f8[::1], i8[::1], f8[::1], f8, i8, f8[:,:,::1],"
    "f8[:,::1], f8[:,::1], f8[::1])"
)
def follow(
    block: Floats,
    goals: Floats,
    rows: Ints | None,
    lower: Floats,
    upper: Floats,
    periodic: Ints,
    x: Floats,
    longest: float,
    most: int,
    ways: Floats,
    points: Floats,
    tangents: Floats,
    t: Floats,
) -> tuple[int, int, int, int, int, int]:
    """Follow the curve through a solution to both of its ends.

    Args:
        block: The chain.
        goals: (T, GOAL).
        rows: (n - 1, 2) what counts of them; None for one tip's whole pose.
        lower: (n,) limits.
        upper: (n,)
        periodic: (n,) 1 for a coordinate without limits that a whole turn brings back.
        x: (n,) the solution; it is put onto the curve, in place.
        longest: Length of a step at most.
        most: Evaluations after which no step begins.
        ways: (4, k, n) scratch, for at most k points either way.
        points: (2 k, n) gets different points on the curve, in order.
        tangents: (2 k, n) gets the tangents there.
        t: (2 k,) gets the length of the curve up to each.

    Returns:
        How many points, none in a singularity; how the curve begins, and how it ends, each with the limit met there, as
        ``trace`` says it; evaluations.
    """
    S, n, _ = sizes_of(block)
    curve, work, bounds = curve_scratch(n), scratch_for(n, rows, S), Bounds(lower, upper, periodic)
    return follow_in(block, goals, rows, bounds, x, longest, most, ways, points, tangents, t, curve, work)
