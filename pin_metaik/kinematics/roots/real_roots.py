"""Configurations inside the limits, out of complex roots for a pose: what is real, or may be, is descended to."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from pin_metaik.compiled import Floats, Ints, allocating, inline, jit
from pin_metaik.kinematics.kernel.closed_form import Vector
from pin_metaik.kinematics.kernel.descent import Descent, descend_from, descent_of
from pin_metaik.kinematics.kernel.forward import FULL_TURN, copy, sizes_of
from pin_metaik.kinematics.kernel.layout import GOAL, Arm, Bounds, chain_in
from pin_metaik.kinematics.kernel.multistart import is_new
from pin_metaik.kinematics.kernel.ordered import repeat, write_nearest_first
from pin_metaik.kinematics.kernel.pose_solver import (
    NOWHERE,
    TARGET,
    Quaternion,
    Room,
    aim,
    parts_of,
    read,
    room_for,
    scratch_in,
)
from pin_metaik.kinematics.kernel.scratch import Scratch, scratch_for
from pin_metaik.kinematics.roots.complex_arm import Complexes
from pin_metaik.kinematics.roots.real import BEYOND, NEARLY, REAL

INSIDE, BESIDE, OUTSIDE, SEVERAL = 0, 1, 2, 3  # several: it has copies that are different configurations
OPEN = -1  # solutions, where these may not be all

unpack = inline(chain_in)


class Starts(NamedTuple):
    """Where descents begin.

    Attributes:
        x: (2 m, n) those inside the limits first, from row m on the others.
        inside: (1,) how many there are of the first ...
        others: (1,) ... and of the others.
    """

    x: Floats
    inside: Ints
    others: Ints


@allocating
def no_starts(m: int, n: int) -> Starts:
    """Room for m of each kind."""
    return Starts(np.empty((2 * m, n)), np.zeros(1, np.int64), np.zeros(1, np.int64))


@inline
def place(root: Complexes, bounds: Bounds, rotates: Ints, guess: Floats, x: Floats) -> int:
    """Write the real parts of a root into x (n,), after whole turns nearest to the guess; where they are."""
    lower, upper, place = bounds.lower, bounds.upper, INSIDE
    for c in range(x.shape[0]):
        value, least, most = root[c].real, lower[c] - BEYOND, upper[c] + BEYOND
        if rotates[c] == 1:
            first, last = np.ceil((least - value) / FULL_TURN), np.floor((most - value) / FULL_TURN)
            if first > last:
                return OUTSIDE
            if bounds.multi_turn[c] == 1:
                first = min(max(np.round((guess[c] - value) / FULL_TURN), first), last)
            elif first < last:
                return SEVERAL
            value += FULL_TURN * first
        elif not least <= value <= most:
            return OUTSIDE
        if not lower[c] <= value <= upper[c]:
            place = BESIDE
        x[c] = value
    return place


@inline
def add_start(
    root: Complexes, known: bool, bounds: Bounds, rotates: Ints, guess: Floats, x: Floats, starts: Starts
) -> bool:
    """Add what a root may be the place of; False, if it has several. ``known``: it is a root, not nearly one."""
    off, m = 0.0, starts.x.shape[0] // 2
    for c in range(x.shape[0]):
        off = max(off, abs(root[c].imag))
    if off >= NEARLY and known:
        return True
    where = place(root, bounds, rotates, guess, x)
    if where == SEVERAL:
        return False
    if where == INSIDE and known and off < REAL:
        copy(x, starts.x[starts.inside[0]])
        starts.inside[0] += 1
    elif where != OUTSIDE:
        copy(x, starts.x[m + starts.others[0]])
        starts.others[0] += 1
    return True


@inline
def descended(
    arm: Arm,
    goals: Floats,
    bounds: Bounds,
    starts: Starts,
    descent: Descent,
    apart: float,
    solutions: Floats,
    best: Floats,
    work: Scratch,
) -> tuple[int, int]:
    """How many distinct solutions descents from the starts lead to, and evaluations."""
    count, spent, m = 0, 0, starts.x.shape[0] // 2
    for k in range(m + starts.others[0]):
        if starts.inside[0] <= k < m or count == solutions.shape[0]:
            continue
        steps, met, _ = descend_from(arm, goals, None, bounds, starts.x[k], descent, descent.steps, np.inf, best, work)
        spent += steps
        if met and is_new(best, solutions, count, bounds.multi_turn, apart):
            copy(best, solutions[count])
            count += 1
    return count, spent


@inline
def settle_in(
    block: Floats,
    rotates: Ints,
    settings: Floats,
    near: float,
    aligned: float,
    target: Floats,
    points: Complexes,
    nearly: Complexes,
    apart: float,
    q: Floats,
    out: Floats,
    room: Room,
    starts: Starts,
    solutions: Floats,
    away: Floats,
    work: Scratch,
) -> tuple[int, bool, int]:
    """``settle_roots`` in room that was made for it."""
    arm, bounds, entries, _, _ = unpack(block)
    scratch = scratch_in(room, bounds.lower.shape[0])
    if not read(target, q, entries, scratch.goal, scratch.guess):
        return OPEN, False, 0
    aim(scratch.goal, None, 0.999 * near, 0.999 * aligned)
    for known, roots in ((True, points), (False, nearly)):
        for k in range(roots.shape[0]):
            if not add_start(roots[k], known, bounds, rotates, scratch.guess, scratch.start, starts):
                return OPEN, False, 0
    goals, best = scratch.goal.reshape(1, GOAL), scratch.best
    count, spent = descended(arm, goals, bounds, starts, descent_of(settings)[0], apart, solutions, best, work)
    met = starts.inside[0] > 0
    for k in range(starts.inside[0]):
        met = met and not is_new(starts.x[k], solutions, count, bounds.multi_turn, apart)
    repeat(q, out)
    write_nearest_first(solutions, count, scratch.guess, bounds, entries, away, scratch.start, out)
    return count, met, spent


@jit(
    "Tuple((i8, b1, i8, UniTuple(f8, 3), UniTuple(f8, 4)))"
    f"(f8[::1], i8[::1], f8[::1], f8, f8, {TARGET}, c16[:,::1], c16[:,::1], f8, f8[::1], f8[:,::1])"
)
def settle_roots(
    block: Floats,
    rotates: Ints,
    settings: Floats,
    near: float,
    aligned: float,
    target: Floats,
    points: Complexes,
    nearly: Complexes,
    apart: float,
    q: Floats,
    out: Floats,
) -> tuple[int, bool, int, Vector, Quaternion]:
    """Descend to a target from its roots that are real, or may be, and inside the limits, or hardly outside.

    Args:
        block: The packed chain.
        rotates: (6,) 1 for a coordinate that a whole turn brings back.
        settings: (4,) of a descent.
        near: How far (m) from the target a solution may be.
        aligned: By how much (rad) it may be turned.
        target: (4, 4) world pose.
        points: (k, 6) roots.
        nearly: (l, 6) what may be two of them.
        apart: rad or m by which some joint of two solutions must differ.
        q: (nq,) where to begin, and what other joints keep; it is brought inside the limits.
        out: (m, nq) gets the solutions, the nearest to q first.

    Returns:
        How many solutions, or OPEN; whether there is a root inside the limits and each of those has its solution;
        evaluations; the target's position and quaternion.
    """
    S, n, _ = sizes_of(block)
    starts = no_starts(points.shape[0] + nearly.shape[0] + 1, n)
    solutions, away = np.empty((out.shape[0], n)), np.empty(out.shape[0])
    work = scratch_for(n, None, S)
    count, met, spent = settle_in(
        block, rotates, settings, near, aligned, target, points, nearly, apart, q, out, room_for(n, S), starts,
        solutions, away, work,
    )  # fmt: skip
    position, turn = NOWHERE if count == OPEN else parts_of(target)
    return count, met, spent, position, turn
