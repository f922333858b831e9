"""All configurations of an arm with a closed form for a pose, with what proves that they are all, in one call.

The branches of the closed form are the configurations, and the same branches on balls are the proof: all of each that
may hold a configuration is near to one of them. Two branches may be near to the same one, beside a singularity.
"""

from __future__ import annotations

import math

import numpy as np

from pin_metaik.compiled import Floats, Ints, inline, jit
from pin_metaik.kinematics.kernel.closed_form import Vector, numbers_of, on_branch
from pin_metaik.kinematics.kernel.forward import FULL_TURN, sizes_of
from pin_metaik.kinematics.kernel.layout import COLUMN, ROUNDING, Arm, Bounds, PoseScratch, chain_in
from pin_metaik.kinematics.kernel.multistart import is_new
from pin_metaik.kinematics.kernel.ordered import repeat, write_nearest_first
from pin_metaik.kinematics.kernel.pose_solver import (
    NOWHERE,
    TARGET,
    Quaternion,
    Room,
    parts_of,
    read,
    room_for,
    scratch_in,
    stands_exactly,
)
from pin_metaik.kinematics.proofs.branch_balls import POSSIBLE, possible_branches
from pin_metaik.kinematics.proofs.targets import exactly

BRANCHES = 8
OPEN = -1  # solutions, where this is not all that can be said

unpack = inline(chain_in)


@inline
def exact_branches(
    arm: Arm, bounds: Bounds, form: Floats, target: Floats, apart: float, scratch: PoseScratch, out: Floats
) -> tuple[int, int]:
    """Distinct coordinates (8, 6) of the branches that meet a target, or OPEN if one only nearly does; and branches."""
    start, best = scratch.start, scratch.best
    count = spent = 0
    for number in range(BRANCHES):
        if on_branch(form, arm.wiring, bounds, numbers_of(target), scratch.guess, number, start):
            spent += 1
            for c in range(6):
                best[c] = min(max(start[c], bounds.lower[c]), bounds.upper[c])
            if not stands_exactly(arm, best, scratch):
                return OPEN, spent
            if is_new(best, out, count, bounds.multi_turn, apart):
                for c in range(6):
                    out[count, c] = best[c]
                count += 1
    return count, spent


@inline
def is_around(wiring: Ints, bounds: Bounds, angles: Floats, radii: Floats, x: Floats, apart: float) -> bool:
    """Whether all of a branch, each angle within its radius and inside the limits, is so near to x (6,)."""
    for s in range(6):
        c = wiring[s, COLUMN]
        angle, radius, lower = angles[s], radii[s], bounds.lower[c]
        if lower > -np.inf and radius < math.pi:
            angle += FULL_TURN * math.ceil((lower - ROUNDING - radius - angle) / FULL_TURN)
        way = x[c] - angle
        if bounds.multi_turn[c] == 1:
            way -= FULL_TURN * np.round(way / FULL_TURN)
        if abs(way) + radius > apart:
            return False
    return True


@inline
def are_all(
    wiring: Ints, bounds: Bounds, x: Floats, count: int, apart: float, angles: Floats, radii: Floats, faults: Floats
) -> bool:
    """Whether nothing in any branch that may hold a configuration is distinct from all of x (8, 6)."""
    for number in range(BRANCHES):
        if faults[number, 0] == POSSIBLE:
            found = False
            for k in range(count):
                found = found or is_around(wiring, bounds, angles[number], radii[number], x[k], apart)
            if not found:
                return False
    return True


@inline
def solve_in(
    block: Floats,
    ideal: Floats,
    deviation: Floats,
    target: Floats,
    apart: float,
    q: Floats,
    out: Floats,
    room: Room,
    x: Floats,
    away: Floats,
    angles: Floats,
    radii: Floats,
    faults: Floats,
) -> tuple[int, int]:
    """``every_branch`` in room that was made for it."""
    arm, bounds, entries, _, form = unpack(block)
    scratch = scratch_in(room, bounds.lower.shape[0])
    if not read(target, q, entries, scratch.goal, scratch.guess):
        return OPEN, 0
    count, spent = exact_branches(arm, bounds, form, target, apart, scratch, x)
    if count > 0:
        pose, skew = exactly(numbers_of(target))
        off = deviation[0], 2.0 * skew + deviation[1]
        possible_branches(ideal, arm.wiring, bounds, pose, off[0], off[1], angles, radii, faults)
        if not are_all(arm.wiring, bounds, x, count, apart, angles, radii, faults):
            count = OPEN
    if count <= 0:
        return OPEN, spent
    repeat(q, out)
    write_nearest_first(x, count, scratch.guess, bounds, entries, away, scratch.start, out)
    return count, spent


@jit(
    f"Tuple((i8, i8, UniTuple(f8, 3), UniTuple(f8, 4)))(f8[::1], f8[:,::1], f8[::1], {TARGET}, f8, f8[::1], f8[:,::1])"
)
def every_branch(
    block: Floats, ideal: Floats, deviation: Floats, target: Floats, apart: float, q: Floats, out: Floats
) -> tuple[int, int, Vector, Quaternion]:
    """All configurations for a target, if they are proved to be all and each stands on it exactly.

    Args:
        block: The packed chain.
        ideal: (16, 3) its closed form, and ``deviation`` (2,): see ``ClosedFormProof``.
        deviation: How far (m) and by how much turned (rad) the arm may be from its closed form.
        target: (4, 4) world pose.
        apart: rad by which some joint of two configurations must differ.
        q: (nq,) where to begin, and what other joints keep; it is brought inside the limits.
        out: (8, nq) gets the configurations, the nearest to q first.

    Returns:
        How many configurations, or OPEN; evaluations; the target's position and quaternion.
    """
    S, n, _ = sizes_of(block)
    x, away, faults = np.empty((BRANCHES, 6)), np.empty(BRANCHES), np.empty((BRANCHES, 3))
    angles, radii = np.empty((BRANCHES, 6)), np.empty((BRANCHES, 6))
    room = room_for(n, S)
    count, spent = solve_in(block, ideal, deviation, target, apart, q, out, room, x, away, angles, radii, faults)
    position, turn = NOWHERE if count == OPEN else parts_of(target)
    return count, spent, position, turn
