"""Which solutions are on a curve: each is put onto the curve itself, as another one may be very near."""

from __future__ import annotations

import math

import numpy as np

from pin_metaik.compiled import Floats, Ints, jit, shared
from pin_metaik.kinematics.kernel.forward import copy, sizes_of, unpack
from pin_metaik.kinematics.kernel.layout import Arm
from pin_metaik.kinematics.kernel.scratch import Scratch, scratch_for
from pin_metaik.kinematics.self_motion.near import is_near_line, point_between
from pin_metaik.kinematics.self_motion.trace import CurveScratch, curve_scratch, put_on_curve

NEAR = 5e-3  # rad or m: what is farther from the line between two points of a curve is not on it there
SAME = 1e-5  # rad or m: a solution this near to the curve itself is on it
PASSES = 3  # of moving along the curve to the point that is nearest to a solution


@shared
def is_on_piece(
    arm: Arm,
    goals: Floats,
    rows: Ints | None,
    x: Floats,
    a: Floats,
    b: Floats,
    tangents: Floats,
    share: float,
    curve: CurveScratch,
    work: Scratch,
) -> bool:
    """Whether a solution x (n,) is on the curve between its points a and b (n,), with the ``tangents`` (2, n) there.

    Between them the curve is Hermite's cubic, put back onto the targets; so is x, as it solves them to a tolerance
    only. Where the curve is singular nothing can be told apart.
    """
    n, point, tangent, size = x.shape[0], curve.trial, curve.tangent, 0.0
    for _ in range(PASSES):
        size, along, off = point_between(a, b, tangents, share, point, tangent), 0.0, 0.0
        for c in range(n):
            along += (x[c] - point[c]) * tangent[c]
            off = max(off, abs(x[c] - point[c]))
        if off < SAME:
            return True
        share = min(max(share + along / size, 0.0), 1.0)
    for c in range(n):
        tangent[c] /= math.sqrt(size)
    exact = curve.before
    copy(x, exact)
    moved, _ = put_on_curve(arm, goals, rows, exact, tangent, math.nan, curve, work)
    also, _ = put_on_curve(arm, goals, rows, point, tangent, math.nan, curve, work)
    if moved == math.inf or also == math.inf:
        return True
    along = 0.0
    for c in range(n):
        along += (exact[c] - point[c]) * curve.ahead[c]
    off = 0.0
    for c in range(n):
        off = max(off, abs(exact[c] - point[c] - along * curve.ahead[c]))
    return off < SAME


@shared
def mark_all_on(
    block: Floats,
    goals: Floats,
    rows: Ints | None,
    multi_turn: Ints,
    X: Floats,
    points: Floats,
    tangents: Floats,
    on: Ints,
    copied: Floats,
    curve: CurveScratch,
    work: Scratch,
) -> None:
    """``mark_on`` in room that was made for it; ``copied`` (n,) is the copy of a solution by whole turns."""
    arm = unpack(block).arm
    for k in range(X.shape[0]):
        if on[k] == 1:
            continue
        for i in range(points.shape[0] - 1):
            a, b = points[i], points[i + 1]
            near, share = is_near_line(X[k], a, b, multi_turn, NEAR, copied)
            if near and is_on_piece(arm, goals, rows, copied, a, b, tangents[i : i + 2], share, curve, work):
                on[k] = 1
                break


@jit("void(f8[::1], f8[:,::1], i8[:,::1]?, i8[::1], f8[:,::1], f8[:,::1], f8[:,::1], i8[::1])")
def mark_on(
    block: Floats,
    goals: Floats,
    rows: Ints | None,
    multi_turn: Ints,
    X: Floats,
    points: Floats,
    tangents: Floats,
    on: Ints,
) -> None:
    """Mark with 1 the solutions that are on a curve.

    Args:
        block: The chain.
        goals: (T, GOAL).
        rows: (n - 1, 2) what counts of them; None for one tip's whole pose.
        multi_turn: (n,) 1 for angles on a circle.
        X: (k, n) solutions.
        points: (p, n) on the curve, in order.
        tangents: (p, n) there.
        on: (k,) the marks; what is marked is not looked at.
    """
    S, n, _ = sizes_of(block)
    curve, work = curve_scratch(n), scratch_for(n, rows, S)
    mark_all_on(block, goals, rows, multi_turn, X, points, tangents, on, np.empty(n), curve, work)
