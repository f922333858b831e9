"""The compiled loops of a control tick: the speeds that joints may have, and the best of them for a target.

Time goes by in ticks of dt s. In each a joint moves on by dt v, then its speed v may change by ``dv`` at most. A joint
that brakes has v, v - dv, v - 2 dv, ... and moves on, from the tick with v to the last one, by

    S(v) = dt (v + (v - dv) + ... + (v - k dv)) = dt ((k + 1) v - dv k (k + 1) / 2),   k = floor(v / dv).

S grows with v, in straight pieces, so that its inverse has a closed form as well: the greatest speed that a joint may
have if it must be able to stop within a distance.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from pin_metaik.compiled import Floats, Ints, allocating, inline, jit, shared
from pin_metaik.kinematics.kernel.descent import step_in
from pin_metaik.kinematics.kernel.forward import IDENTITY, copy, forward, sizes_of, unpack
from pin_metaik.kinematics.kernel.goals import evaluate_apart, have_balls, pose_error
from pin_metaik.kinematics.kernel.layout import (
    AXIS,
    COLUMN,
    POSE,
    ROTATES,
    SCALE,
    TIP,
    TURN,
    TURN_WEIGHT,
    WEIGHT,
    Bounds,
)
from pin_metaik.kinematics.kernel.scratch import Scratch, scratch_for

step = shared(step_in)  # a tick has four of them

# What was measured on ur5, a circle through its wrist's singularity in 4 s, and on panda at the edge of its reach: with
# ten times this floor the circle is missed by three times as much, with a tenth accelerations are a third higher. With
# damping that does not grow with the error the arm swings at the edge for good; with 0.5 |e| it loses in a singularity
# the directions it needs to come out of it.
FLOOR = 1e-5  # m^2 or rad^2; singular values below its root, 0.003, are hardly used
LEVER, SMALL = 0.3, 0.05  # m or rad; damping grows with an error, slower with one that is small
YIELDING = 1e-4  # damping of what other joints do for those that may not move as they should
GENTLY = 0.5  # of the acceleration, to brake for a target: the rest is for ways that turn out to bend
STIFFER = 8  # times that damping is made four times as large, until the speeds of the targets ask too much of no joint
PUSH = 100.0  # what 1 m/s too fast towards an obstacle counts, in m/s of the tip
PASSES = 10  # of least squares, at most; each adds obstacles that are approached too fast, and frees or holds joints
SETTLED = 1e-6  # rad/s or m/s; speeds that change by less in a pass have been found

SLOW = 1e-9  # m/s
AT = 1e-6  # rad or m from its limit, where a joint stands at it
# Rows of what a tick comes to: speeds, those of braking, and 1 where a limit is in the way.
SPEED, BRAKED, STOPPED = 0, 1, 2

# A row of what comes near: a unit vector from the first body to the second, a point on either, m, and the greatest
# speed at which they may approach, m/s; numbers of the joints that carry them.
NORMAL, FIRST, SECOND, APPROACH, NEARBY = 0, 3, 6, 9, 10


@inline
def speed_within(distance: float, dv: float, dt: float) -> float:
    """The greatest speed of a joint that can stop within a distance: S(v) = distance.

    Of a distance below zero, which is to be made up, the speed that does so in one tick.
    """
    if distance <= 0.0:
        return distance / dt
    if distance > 1e9:
        return np.inf
    k = math.floor(0.5 * (math.sqrt(1.0 + 8.0 * distance / (dt * dv)) - 1.0))
    return float((distance / dt + 0.5 * dv * k * (k + 1.0)) / (k + 1.0))


@inline
def braked(v: float, dv: float) -> float:
    """The speed after one tick of braking."""
    return max(abs(v) - dv, 0.0) * (1.0 if v > 0.0 else -1.0)


@inline
def allowed(
    bounds: Bounds, x: Floats, v: Floats, most: Floats, dv: Floats, dt: float, low: Floats, high: Floats
) -> None:
    """The speeds (n,) from ``low`` to ``high`` that a tick may have; see ``Follower`` for what they keep.

    What v has been and how far the limits are decides; a joint that comes from elsewhere too fast brakes.
    """
    for j in range(x.shape[0]):
        top = min(speed_within(bounds.upper[j] - x[j], dv[j], dt), most[j])
        bottom = max(-speed_within(x[j] - bounds.lower[j], dv[j], dt), -most[j])
        high[j] = max(min(v[j] + dv[j], top), v[j] - dv[j])
        low[j] = min(max(v[j] - dv[j], bottom), v[j] + dv[j])
        if low[j] > high[j]:
            low[j] = high[j] = braked(v[j], dv[j])


class Near(NamedTuple):
    """What comes near a joint's body: the rows named above, the joints that carry them, and which rows move which.

    Attributes:
        rows: (p, NEARBY).
        carriers: (p, 2) joint numbers.
        moves: (joints, S) 1 where a row of the chain's joints moves what a joint carries.
    """

    rows: Floats
    carriers: Ints
    moves: Ints


class TickScratch(NamedTuple):
    """Of one tick.

    Attributes:
        descent: Of the least squares, with room for rows of obstacles.
        error: (m,) of the tips.
        lead: (m,) by how much the targets moved since the last tick.
        best: (n,) speeds that would be best.
        start: (n,) speeds on the way there.
        last: (n,) speeds before a pass.
        low: (n,) slowest speeds.
        high: (n,) fastest speeds.
        gaps: (p, n + 1) growth of the distances by coordinate; and, from 1 on, where among the rows it has come to be.
    """

    descent: Scratch
    error: Floats
    lead: Floats
    best: Floats
    start: Floats
    last: Floats
    low: Floats
    high: Floats
    gaps: Floats


@allocating
def tick_scratch(n: int, m: int, S: int, p: int) -> TickScratch:
    """For m rows of targets and p of obstacles."""
    descent = scratch_for(n, np.empty((m + p, 2), np.int64), S)
    return TickScratch(
        descent, np.empty(m), np.empty(m), np.empty(n), np.empty(n), np.empty(n), np.empty(n), np.empty(n),
        np.empty((p, n + 1)),
    )  # fmt: skip


@inline
def led(before: Floats, goals: Floats, rows: Ints, work: TickScratch) -> None:
    """How far the targets moved, into ``lead`` (m,), as weighted rows: minus the error of where they were."""
    pose, error = work.descent.pose, work.descent.error
    for m in range(rows.shape[0]):
        a, b, j = before[rows[m, TIP]], goals[rows[m, TIP]], rows[m, AXIS]
        for i in range(3):
            pose[9 + i] = b[9 + i]
            for k in range(3):
                turn = b[3 * i] * a[3 * k] + b[3 * i + 1] * a[3 * k + 1] + b[3 * i + 2] * a[3 * k + 2]
                pose[3 * i + k] = turn
                pose[9 + i] -= turn * a[9 + k]
        pose_error(pose, error)
        work.lead[m] = -error[j] * b[(WEIGHT if j < TURN else TURN_WEIGHT - TURN) + j]


@inline
def spread(block: Floats, x: Floats, near: Near, work: TickScratch) -> None:
    """Growth (p, n) of the distance of every two bodies by coordinate, into ``gaps``."""
    joints, wiring, ends, tips = unpack(block).arm
    axes, origins, gaps = work.descent.axes, work.descent.origins, work.gaps
    for t in range(tips.shape[0]):
        forward(joints, wiring, ends[t], ends[t + 1], tips[t], IDENTITY, x, axes, origins, work.descent.pose)
    gaps[:, :] = 0.0
    for i in range(gaps.shape[0]):
        row = near.rows[i]
        for s in range(joints.shape[0]):
            ax, ay, az = axes[s, 0], axes[s, 1], axes[s, 2]
            for side in range(2):
                if near.moves[near.carriers[i, side], s] == 1:
                    at = FIRST if side == 0 else SECOND
                    dx, dy, dz = row[at] - origins[s, 0], row[at + 1] - origins[s, 1], row[at + 2] - origins[s, 2]
                    if wiring[s, ROTATES] == 1:
                        dx, dy, dz = ay * dz - az * dy, az * dx - ax * dz, ax * dy - ay * dx
                    else:
                        dx, dy, dz = ax, ay, az
                    growth = joints[s, SCALE] * (row[NORMAL] * dx + row[NORMAL + 1] * dy + row[NORMAL + 2] * dz)
                    gaps[i, wiring[s, COLUMN]] += growth if side == 1 else -growth


@inline
def approach(way: Floats, most: Floats, dv: Floats, dt: float) -> float:
    """The share of a way (n,) to go per second, so that every joint can stop at its end, gently."""
    share = 1.0 / dt
    for j in range(way.shape[0]):
        distance = abs(way[j])
        if distance > 0.0:
            share = min(share, min(speed_within(distance, GENTLY * dv[j], dt), most[j]) / distance)
    return share


@inline
def forget_jumps(J: Floats, most: Floats, dt: float, lead: Floats) -> None:
    """Targets that moved faster than the joints could carry the tips have jumped: that says nothing of their speed."""
    jumped = False
    for a in range(lead.shape[0]):
        fastest = 0.0
        for j in range(most.shape[0]):
            fastest += abs(J[j, a]) * most[j]
        jumped = jumped or abs(lead[a]) > dt * fastest
    if jumped:
        lead[:] = 0.0


@inline
def beyond(speeds: Floats, most: Floats) -> bool:
    """Whether a speed is beyond its limit."""
    found = False
    for j in range(most.shape[0]):
        found = found or abs(speeds[j]) > most[j]
    return found


@inline
def together(v: Floats, best: Floats, dv: Floats, out: Floats) -> None:
    """From speeds v towards the best, by one share for all joints that keeps their accelerations, into ``out``."""
    share = 1.0
    for j in range(v.shape[0]):
        change = abs(best[j] - v[j])
        if change > dv[j]:
            share = min(share, dv[j] / change)
    for j in range(v.shape[0]):
        out[j] = v[j] + share * (best[j] - v[j])


@inline
def lost(bounds: Bounds, x: Floats, m: int, stopped: Floats, work: TickScratch) -> float:
    """The square of the part of the error that is in no direction in which the joints can go: at limits only inward.

    ``stopped`` (n,) gets 1 where such a limit is in the way.
    """
    descent, low, high = work.descent, work.low, work.high
    for j in range(x.shape[0]):
        low[j] = x[j] if x[j] <= bounds.lower[j] + AT else -np.inf
        high[j] = x[j] if x[j] >= bounds.upper[j] - AT else np.inf
    for a in range(m):
        descent.r[a] = work.error[a]
    copy(x, descent.x)
    step(Bounds(low, high, bounds.multi_turn), m, FLOOR, descent)
    left = 0.0
    for a in range(m):
        rest = work.error[a]
        for j in range(x.shape[0]):
            rest += descent.J[j, a] * (descent.x[j] - x[j])
        left += rest * rest
    for j in range(x.shape[0]):
        stopped[j] = descent.held[j]
    return left


@inline
def aim_behind(bounds: Bounds, x: Floats, m: int, most: Floats, dv: Floats, dt: float, work: TickScratch) -> None:
    """Speeds that lead to where the targets were a tick ago, inside the limits, and stop there, into ``best`` (n,)."""
    descent = work.descent
    behind = 0.0
    for a in range(m):
        descent.r[a] = work.error[a] + work.lead[a]
        behind += descent.r[a] * descent.r[a]
    copy(x, descent.x)
    step(bounds, m, FLOOR + LEVER * behind / (math.sqrt(behind) + SMALL), descent)
    for j in range(x.shape[0]):
        work.best[j] = descent.x[j] - x[j]
    share = approach(work.best, most, dv, dt)
    for j in range(x.shape[0]):
        work.best[j] *= share


@inline
def add_lead(multi_turn: Ints, m: int, most: Floats, wish: Floats, dt: float, work: TickScratch) -> None:
    """Add the speeds that move the tips as the targets move, and else are those wished for, to ``best`` (n,)."""
    descent, low, high = work.descent, work.low, work.high
    for j in range(most.shape[0]):
        low[j], high[j] = -np.inf, np.inf
    damping = FLOOR
    for _ in range(STIFFER):
        for a in range(m):
            descent.r[a] = -work.lead[a] / dt
            for j in range(most.shape[0]):
                descent.r[a] += descent.J[j, a] * wish[j]
        copy(wish, descent.x)
        step(Bounds(low, high, multi_turn), m, damping, descent)
        damping *= 4.0
        if not beyond(descent.x, most):
            break
    for j in range(most.shape[0]):
        work.best[j] += descent.x[j]


@inline
def settle(multi_turn: Ints, m: int, near: Near, work: TickScratch) -> int:
    """Of the speeds from ``low`` to ``high`` those that move the tips most like the best, into the descent's x (n,).

    Begun at ``start``; bodies that would approach each other too fast get a row of their own. Returns how many do.
    """
    descent, best, low, high, gaps, last = work.descent, work.best, work.low, work.high, work.gaps, work.last
    J, r, x = descent.J, descent.r, descent.x
    n, p, active = x.shape[0], near.rows.shape[0], 0
    for j in range(n):
        x[j] = min(max(work.start[j], low[j]), high[j])
    for i in range(p):
        gaps[i, n] = 0.0
    for _ in range(PASSES):
        copy(x, last)
        for a in range(m + active):
            r[a] = 0.0
            for j in range(n):
                r[a] += J[j, a] * (x[j] - best[j] if a < m else x[j])
        for i in range(p):
            if gaps[i, n] > 0.0:
                r[m + int(gaps[i, n]) - 1] += PUSH * near.rows[i, APPROACH]
        step(Bounds(low, high, multi_turn), m + active, YIELDING, descent)
        known, change = active, 0.0
        for j in range(n):
            change = max(change, abs(x[j] - last[j]))
        for i in range(p):
            growth = near.rows[i, APPROACH]
            for j in range(n):
                growth += gaps[i, j] * x[j]
            if gaps[i, n] == 0.0 and growth < -SLOW:
                for j in range(n):
                    J[j, m + active] = PUSH * gaps[i, j]
                active += 1
                gaps[i, n] = active
        if active == known and change < SETTLED:
            break
    return active


@inline
def aim_in(
    block: Floats,
    before: Floats,
    goals: Floats,
    rows: Ints,
    x: Floats,
    v: Floats,
    motion: Floats,
    dt: float,
    near: Near,
    out: Floats,
    work: TickScratch,
) -> tuple[float, int]:
    """``aim`` in room that was made for it."""
    chain = unpack(block)
    bounds, most, dv, wish = chain.bounds, motion[0], motion[1], motion[2]
    descent, m = work.descent, rows.shape[0]
    if near.rows.shape[0] > 0:
        spread(block, x, near, work)
    led(before, goals, rows, work)
    square, _ = evaluate_apart(chain.arm, goals, rows, x, descent, have_balls(goals))
    for a in range(m):
        work.error[a] = descent.r[a]
    left = lost(bounds, x, m, out[STOPPED], work)
    forget_jumps(descent.J, most, dt, work.lead)
    aim_behind(bounds, x, m, most, dv, dt, work)
    add_lead(bounds.multi_turn, m, most, wish, dt, work)
    together(v, work.best, dv, work.start)
    allowed(bounds, x, v, most, dv, dt, work.low, work.high)
    active = settle(bounds.multi_turn, m, near, work)
    for j in range(x.shape[0]):
        out[SPEED, j] = descent.x[j]
        out[BRAKED, j] = min(max(braked(v[j], dv[j]), work.low[j]), work.high[j])
    return left / square if square > 0.0 else 0.0, active


@jit(
    "Tuple((f8, i8))(f8[::1], f8[:,::1], f8[:,::1], i8[:,::1], f8[::1], f8[::1], f8[:,::1], f8, f8[:,::1], i8[:,::1], "
    "i8[:,::1], f8[:,::1])"
)
def aim(
    block: Floats,
    before: Floats,
    goals: Floats,
    rows: Ints,
    x: Floats,
    v: Floats,
    motion: Floats,
    dt: float,
    near: Floats,
    carriers: Ints,
    moves: Ints,
    out: Floats,
) -> tuple[float, int]:
    """The speeds of one tick towards targets.

    Args:
        block: The chain.
        before: (T, 26) the targets of the last tick.
        goals: (T, 26) the targets.
        rows: (m, 2) what of them counts.
        x: (n,) coordinates.
        v: (n,) speeds of the last tick, rad/s or m/s.
        motion: (3, n) greatest speeds, greatest change of speed in a tick, and speeds where targets leave them free.
        dt: Length of a tick, s.
        near: (p, NEARBY) what comes near.
        carriers: (p, 2) what carries it.
        moves: (joints, S) what moves that.
        out: (3, n) filled in, rows SPEED, BRAKED and STOPPED.

    Returns:
        Which part of the square of the error no direction makes up that the joints can go; and how many of the rows of
        ``near`` change the speeds.
    """
    S, n, _ = sizes_of(block)
    return aim_in(
        block, before, goals, rows, x, v, motion, dt, Near(near, carriers, moves), out,
        tick_scratch(n, rows.shape[0], S, near.shape[0]),
    )  # fmt: skip


@inline
def head_in(
    block: Floats, way: Floats, x: Floats, v: Floats, motion: Floats, dt: float, out: Floats, work: Floats
) -> None:
    """``head`` in room that was made for it."""
    most, dv, low, high = motion[0], motion[1], work[0], work[1]
    allowed(unpack(block).bounds, x, v, most, dv, dt, low, high)
    share = approach(way, most, dv, dt)
    for j in range(x.shape[0]):
        out[SPEED, j] = min(max(share * way[j], low[j]), high[j])
        out[BRAKED, j] = min(max(braked(v[j], dv[j]), low[j]), high[j])
        out[STOPPED, j] = 0.0


@jit("void(f8[::1], f8[::1], f8[::1], f8[::1], f8[:,::1], f8, f8[:,::1])")
def head(block: Floats, way: Floats, x: Floats, v: Floats, motion: Floats, dt: float, out: Floats) -> None:
    """The speeds of one tick along a way (n,) of the joints themselves; the other arguments are those of ``aim``."""
    head_in(block, way, x, v, motion, dt, out, np.empty((2, x.shape[0])))


@inline
def missed(block: Floats, goals: Floats, rows: Ints, x: Floats, sizes: Floats, work: TickScratch) -> bool:
    """Errors at x (n,), of the worst tip over the axes that count, into ``sizes``: m, rad; and whether all are met."""
    chain, descent = unpack(block), work.descent
    _, met = evaluate_apart(chain.arm, goals, rows, x, descent, have_balls(goals))
    sizes[0] = sizes[1] = 0.0
    for t in range(goals.shape[0]):
        ends, goal = chain.arm.ends, goals[t]
        forward(
            chain.arm.joints, chain.arm.wiring, ends[t], ends[t + 1], chain.arm.tips[t], goal[:POSE], x, descent.axes,
            descent.origins, descent.pose,
        )  # fmt: skip
        pose_error(descent.pose, descent.error)
        position = orientation = 0.0
        for a in range(rows.shape[0]):
            if rows[a, TIP] == t and rows[a, AXIS] < TURN:
                position += descent.error[rows[a, AXIS]] ** 2
            elif rows[a, TIP] == t:
                orientation += descent.error[rows[a, AXIS]] ** 2
        sizes[0], sizes[1] = max(sizes[0], math.sqrt(position)), max(sizes[1], math.sqrt(orientation))
    return met


@jit("b1(f8[::1], f8[:,::1], i8[:,::1], f8[::1], f8[::1])")
def judge(block: Floats, goals: Floats, rows: Ints, x: Floats, sizes: Floats) -> bool:
    """Position and orientation error (2,) at x (n,), m and rad, of the worst tip; and whether all targets are met."""
    S, n, _ = sizes_of(block)
    return missed(block, goals, rows, x, sizes, tick_scratch(n, rows.shape[0], S, 0))


@inline
def stop_at(x: Floats, v: Floats, dv: Floats, dt: float, ticks: float, out: Floats) -> None:
    """``stopping`` in room that was made for it."""
    for j in range(x.shape[0]):
        k = min(math.floor(abs(v[j]) / dv[j]), ticks - 1.0)
        way = dt * ((k + 1.0) * abs(v[j]) - 0.5 * dv[j] * k * (k + 1.0)) if ticks > 0.0 else 0.0
        out[j] = x[j] + (way if v[j] > 0.0 else -way)


@jit("void(f8[::1], f8[::1], f8[::1], f8, f8, f8[::1])")
def stopping(x: Floats, v: Floats, dv: Floats, dt: float, ticks: float, out: Floats) -> None:
    """Where (n,) joints at x are that go at v for one tick and brake from then on, so many ticks after; inf: stand."""
    stop_at(x, v, dv, dt, ticks, out)
