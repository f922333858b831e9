"""Following a self-motion: the curve of configurations that meet a target, where there is one coordinate too many.

Steps along the tangent, with the bend of the last one, are put back by Newton's method on the targets and a plane
across the tangent (Allgower and Georg, "Introduction to numerical continuation methods", 2003, chapter 2). A curve ends
where a coordinate meets a limit, exactly there, or comes back to where it began.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from pin_metaik.compiled import Floats, Ints, allocating, inline, jit, separate, shared
from pin_metaik.kinematics.kernel.forward import FULL_TURN, copy, sizes_of, unpack
from pin_metaik.kinematics.kernel.goals import evaluate, evaluate_pose
from pin_metaik.kinematics.kernel.layout import Arm, Bounds
from pin_metaik.kinematics.kernel.scratch import Scratch, scratch_for

AT_LIMIT, CLOSED, SINGULAR, LONG = 0, 1, 2, 3  # how a curve ends
CLOSE, CORRECTIONS = 1e-10, 6  # rad or m: last correction of a point on the curve; corrections at most
BEND, OFF = 0.95, 0.1  # least cosine between tangents, and greatest first correction, of a step's length
SHORTEST = 1e-3  # of the longest step: a curve that needs shorter ones ends in a singularity
LEAST_PIVOT = 1e-9
INSIDE = 1e-9  # rad or m beyond a limit that rounding may take a point


class CurveScratch(NamedTuple):
    """Where one point of a curve is worked on.

    Attributes:
        system: (n, n + 2) the Jacobian and one more row; right sides of a correction and of the tangent.
        tangent: (n,) of length 1, at the last point ...
        before: (n,) ... and at the one before.
        trial: (n,) the next point ...
        ahead: (n,) ... and the tangent there.
        step: (n,) a correction.
    """

    system: Floats
    tangent: Floats
    before: Floats
    trial: Floats
    ahead: Floats
    step: Floats


@allocating
def curve_scratch(n: int) -> CurveScratch:
    """Room for a curve of n coordinates."""
    return CurveScratch(np.empty((n, n + 2)), np.empty(n), np.empty(n), np.empty(n), np.empty(n), np.empty(n))


@shared
def solve_system(M: Floats) -> bool:
    """Solve M (n, n + 2) for both right sides, in place, with rows pivoted; False where it is nearly singular."""
    n = M.shape[0]
    for k in range(n):
        pivot, largest = k, abs(M[k, k])
        for i in range(k + 1, n):
            if abs(M[i, k]) > largest:
                pivot, largest = i, abs(M[i, k])
        if largest < LEAST_PIVOT:
            return False
        if pivot != k:
            for j in range(k, n + 2):
                M[k, j], M[pivot, j] = M[pivot, j], M[k, j]
        inverse = 1.0 / M[k, k]
        for i in range(k + 1, n):
            factor = M[i, k] * inverse
            for j in range(k + 1, n + 2):
                M[i, j] -= factor * M[k, j]
    for side in range(n, n + 2):
        for k in range(n - 1, -1, -1):
            for j in range(k + 1, n):
                M[k, side] -= M[k, j] * M[j, side]
            M[k, side] /= M[k, k]
    return True


@inline
def write_equations(arm: Arm, goals: Floats, rows: Ints | None, x: Floats, M: Floats, work: Scratch) -> None:
    """Write what the targets ask of a step from x (n,) into the first n - 1 rows of M (n, n + 2)."""
    if rows is None:
        evaluate_pose(arm, goals[0], x, work)
    else:
        evaluate(arm, goals, rows, x, work, False)
    n = x.shape[0]
    for a in range(n - 1):
        for c in range(n):
            M[a, c] = work.J[c, a]
        M[a, n], M[a, n + 1] = -work.r[a], 0.0


@inline
def correction(
    arm: Arm,
    goals: Floats,
    rows: Ints | None,
    x: Floats,
    last: Floats,
    rest: float,
    curve: CurveScratch,
    work: Scratch,
) -> bool:
    """Newton's step (n,) from x onto the targets and ``last . step = rest``, and the tangent; False in a singularity.

    ``step`` and ``ahead`` are written; the tangent points as ``last`` does.
    """
    write_equations(arm, goals, rows, x, curve.system, work)
    M, n = curve.system, x.shape[0]
    for c in range(n):
        M[n - 1, c] = last[c]
    M[n - 1, n], M[n - 1, n + 1] = rest, 1.0
    if not solve_system(M):
        return False
    size = 0.0
    for c in range(n):
        curve.step[c] = M[c, n]
        size += M[c, n + 1] * M[c, n + 1]
    for c in range(n):
        curve.ahead[c] = M[c, n + 1] / math.sqrt(size)
    return True


@separate
def put_on_curve(
    arm: Arm,
    goals: Floats,
    rows: Ints | None,
    x: Floats,
    last: Floats,
    rest: float,
    curve: CurveScratch,
    work: Scratch,
) -> tuple[float, int]:
    """Correct x (n,) in place, across ``last`` or onto ``last . x = rest``; the tangent comes into ``ahead``.

    Returns the length of the first correction, infinite if they do not end, and evaluations. ``rest`` NaN: across.
    """
    first, size = math.inf, math.inf
    for k in range(CORRECTIONS):
        goal = 0.0
        if not math.isnan(rest):
            goal = rest
            for c in range(x.shape[0]):
                goal -= last[c] * x[c]
        if not correction(arm, goals, rows, x, last, goal, curve, work):
            return math.inf, k + 1
        before, size = size, 0.0
        for c in range(x.shape[0]):
            x[c] += curve.step[c]
            size += curve.step[c] * curve.step[c]
        size = math.sqrt(size)
        if k == 0:
            first = size
        if size < CLOSE:
            return first, k + 1
        if k > 0 and size > 0.5 * before:
            return math.inf, k + 1
    return math.inf, CORRECTIONS


@inline
def crossed(x: Floats, bounds: Bounds, before: Floats) -> int:
    """The coordinate that leaves its limits first on the way from ``before`` to x (n,); -1: none does."""
    at, least = -1, math.inf
    for c in range(x.shape[0]):
        limit = bounds.lower[c] if x[c] < bounds.lower[c] else bounds.upper[c]
        if x[c] < bounds.lower[c] - INSIDE or x[c] > bounds.upper[c] + INSIDE:
            way = (limit - before[c]) / (x[c] - before[c])
            if way < least:
                at, least = c, way
    return at


@inline
def bulges(x: Floats, bounds: Bounds, before: Floats, curve: CurveScratch) -> bool:
    """Whether a coordinate is beyond a limit somewhere on the way from ``before`` to x (n,), by the tangents there."""
    found, length = False, 0.0
    for c in range(x.shape[0]):
        length += (x[c] - before[c]) ** 2
    length = math.sqrt(length)
    for c in range(x.shape[0]):
        a, b = curve.tangent[c], curve.ahead[c]
        if a * b < 0.0:  # it turns back: a parabola with these slopes has its vertex there
            vertex = before[c] + 0.5 * a * a / (a - b) * length
            found = found or vertex < bounds.lower[c] - INSIDE or vertex > bounds.upper[c] + INSIDE
    return found


@inline
def comes_back(x: Floats, before: Floats, first: Floats, start: Floats, periodic: Ints, curve: CurveScratch) -> bool:
    """Whether the curve's first point (n,), whole turns aside, lies between two points of it, and it goes on alike."""
    along = off = length = alike = 0.0
    for c in range(x.shape[0]):
        step, way = x[c] - before[c], first[c] - before[c]
        if periodic[c] == 1:
            way -= FULL_TURN * np.round((way - 0.5 * step) / FULL_TURN)
        along += way * step
        off += way * way
        length += step * step
        alike += start[c] * curve.ahead[c]
    off = max(off - along * along / length, 0.0)
    return 0.0 < along <= length and off < 0.01 * length and alike > BEND


@shared
def trace(
    arm: Arm,
    goals: Floats,
    rows: Ints | None,
    bounds: Bounds,
    x0: Floats,
    way: float,
    longest: float,
    most: int,
    points: Floats,
    tangents: Floats,
    curve: CurveScratch,
    work: Scratch,
) -> tuple[int, int, int, int]:
    """Follow the curve from a point on it.

    Args:
        arm: The chain.
        goals: (T, GOAL).
        rows: (n - 1, 2) what counts of them; None for one tip's whole pose.
        bounds: Limits of the coordinates, and 1 for those without, which a whole turn brings back.
        x0: (n,) the point.
        way: 1 or -1: along the tangent, or against it.
        longest: Length of a step at most.
        most: Evaluations after which no step begins; one takes up to 14.
        points: (k, n) gets points on the curve, x0 first.
        tangents: (k, n) gets the tangents there; the first one is given.
        curve: Scratch.
        work: Scratch.

    Returns:
        How many points; how the curve ends; twice the coordinate that is at a limit there, and 1 more if that is its
        upper one; evaluations.
    """
    n, spent, periodic = x0.shape[0], 0, bounds.multi_turn
    tangent, before, trial = curve.tangent, curve.before, curve.trial
    for c in range(n):
        points[0, c], tangent[c] = x0[c], way * tangents[0, c]
    copy(tangent, before)
    copy(tangent, tangents[0])
    h = last_h = longest
    count, gone = 1, 0.0
    while count < points.shape[0] and spent < most:
        here = points[count - 1]
        for c in range(n):
            trial[c] = here[c] + h * tangent[c] + 0.5 * h * h / last_h * (tangent[c] - before[c])
        first, more = put_on_curve(arm, goals, rows, trial, tangent, math.nan, curve, work)
        spent += more
        alike = 0.0
        for c in range(n):
            alike += tangent[c] * curve.ahead[c]
        at = crossed(trial, bounds, here)
        if (
            first > OFF * h
            or alike < BEND
            or (at < 0 and h > SHORTEST * longest and bulges(trial, bounds, here, curve))
        ):
            h *= 0.5
            if h < 0.5 * SHORTEST * longest:
                return count, SINGULAR, -1, spent
            continue
        ends = LONG
        if at >= 0:
            beyond = trial[at] < bounds.lower[at]
            limit = bounds.lower[at] if beyond else bounds.upper[at]
            share = (limit - here[at]) / (trial[at] - here[at])
            for c in range(n):
                trial[c] = here[c] + share * (trial[c] - here[c])
                before[c] = 0.0
            before[at] = -1.0 if beyond else 1.0
            first, more = put_on_curve(arm, goals, rows, trial, before, before[at] * limit, curve, work)
            spent += more
            if first == math.inf or crossed(trial, bounds, here) >= 0:
                h *= 0.5
                copy(tangent, before)
                if h < SHORTEST * longest:
                    return count, SINGULAR, -1, spent
                continue
            trial[at] = limit
            ends = AT_LIMIT
        elif gone > 2.0 * longest and comes_back(trial, here, points[0], tangents[0], periodic, curve):
            for c in range(n):
                turns = np.round((trial[c] - points[0, c]) / FULL_TURN) if periodic[c] == 1 else 0.0
                trial[c] = points[0, c] + FULL_TURN * turns
                curve.ahead[c] = tangents[0, c]
            ends = CLOSED
        gone += h
        copy(trial, points[count])
        copy(curve.ahead, tangents[count])
        copy(tangent, before)
        copy(curve.ahead, tangent)
        count += 1
        if ends != LONG:
            return count, ends, 2 * at + (1 if trial[max(at, 0)] == bounds.upper[max(at, 0)] else 0), spent
        last_h = h
        h = min(1.5 * h, longest) if first < 0.3 * OFF * h else h
    return count, LONG, -1, spent


@shared
def put_all(
    block: Floats, goals: Floats, rows: Ints | None, X: Floats, tangents: Floats, curve: CurveScratch, work: Scratch
) -> int:
    """``put_back`` in room that was made for it."""
    arm, good = unpack(block).arm, 0
    for k in range(X.shape[0]):
        copy(tangents[k], curve.tangent)
        first, _ = put_on_curve(arm, goals, rows, X[k], curve.tangent, math.nan, curve, work)
        if first < math.inf:
            copy(curve.ahead, tangents[k])
            good += 1
    return good


@jit("i8(f8[::1], f8[:,::1], i8[:,::1]?, f8[:,::1], f8[:,::1])")
def put_back(block: Floats, goals: Floats, rows: Ints | None, X: Floats, tangents: Floats) -> int:
    """Put coordinates X (k, n) onto the curve, across directions (k, n) that become tangents; how many arrive."""
    S, n, _ = sizes_of(block)
    return put_all(block, goals, rows, X, tangents, curve_scratch(n), scratch_for(n, rows, S))
