"""The closed form of an arm whose axes meet and are parallel in the right places: eight configurations for a pose.

Elias and Wen, "IK-Geo: unified robot inverse kinematics using subproblem decomposition", Mechanism and Machine Theory
209, 2025. Two subproblems do for both kinds of arms (see ``kinematics.closed_form``): the turn about an axis that takes
one vector to another (Paden and Kahan's first), and the two that take a vector to where it has a given component along
another (their fourth; their third, a distance, is the same).

A branch need not be exact, as a descent starts from it: where an arm is built almost like that, where a target is a
little out of reach, or where a joint's angle is lost in rounding. Mostly nothing is left to descend: on ur5, kinova,
ur10 and z1 a target takes 1.0 evaluations, where the samples take 7 to 12, and 0.3 us for the branches; turns kept as
cosine and sine take three quarters of the time of angles.
"""

from __future__ import annotations

import math
from typing import TypeAlias

from pin_metaik.compiled import Floats, Ints, inline, jit
from pin_metaik.kinematics.kernel.forward import cos_sin, nearest_turn
from pin_metaik.kinematics.kernel.layout import (
    ACROSS,
    ACROSS_WORLD,
    AHEAD,
    COLUMN,
    FORE,
    H1,
    H2,
    H3,
    H4,
    H5,
    H6,
    LEVEL,
    O1,
    O1_O2,
    O4_O5,
    O5_TIP,
    SIDE_2,
    SIDE_3,
    UPPER,
    Bounds,
)

Vector: TypeAlias = tuple[float, float, float]
Turn: TypeAlias = tuple[float, float]  # cosine and sine
Numbers: TypeAlias = tuple[float, ...]
ORIGIN = 0.0, 0.0, 0.0
LOST = 1e-9  # m or m^2: lever below which an angle is rounding, and may be anything
SHORT = 1e-5  # of the squared lever that may be missing: an arm is built to nine digits, and stretched
OUTSIDE = 1e-9  # rad that rounding may take a solution beyond a limit


@inline
def vector(row: Floats) -> Vector:
    """A row (3,) of a closed form as a vector."""
    return row[0], row[1], row[2]


@inline
def dot(a: Vector, b: Vector) -> float:
    """a . b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inline
def cross(a: Vector, b: Vector) -> Vector:
    """a x b."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@inline
def plus(a: Vector, b: Vector) -> Vector:
    """a + b."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@inline
def minus(a: Vector, b: Vector) -> Vector:
    """a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@inline
def rotated(pose: Numbers, v: Vector) -> Vector:
    """R v, with the rotation of a pose (12,)."""
    return (
        pose[0] * v[0] + pose[1] * v[1] + pose[2] * v[2],
        pose[3] * v[0] + pose[4] * v[1] + pose[5] * v[2],
        pose[6] * v[0] + pose[7] * v[1] + pose[8] * v[2],
    )


@inline
def turned(k: Vector, turn: Turn, v: Vector) -> Vector:
    """Rot(k, turn) v (Rodrigues)."""
    cos, sin = turn
    along, across = (1.0 - cos) * dot(k, v), cross(k, v)
    return (
        cos * v[0] + sin * across[0] + along * k[0],
        cos * v[1] + sin * across[1] + along * k[1],
        cos * v[2] + sin * across[2] + along * k[2],
    )


@inline
def back(turn: Turn) -> Turn:
    """The turn the other way."""
    return turn[0], -turn[1]


@inline
def angle(turn: Turn) -> float:
    """The angle of a turn, in [-pi, pi]."""
    return math.atan2(turn[1], turn[0])


@inline
def subproblem_1(k: Vector, a: Vector, b: Vector, guess: Turn) -> Turn:
    """Subproblem 1: the turn about k that takes a to b, both projected along k; ``guess`` where a is parallel to k."""
    cos, sin = dot(a, b) - dot(k, a) * dot(k, b), dot(k, cross(a, b))
    size = math.sqrt(cos * cos + sin * sin)
    return (cos / size, sin / size) if size > LOST else guess


@inline
def subproblem_4(h: Vector, k: Vector, p: Vector, d: float, guess: Turn, other: bool) -> tuple[Turn, bool]:
    """Subproblem 4: the turn about k with h . Rot(k, turn) p = d, and whether there is one.

    Of the two it is the one nearer to the guess, or the other; where there is none, the one that comes nearest to d.
    """
    # h . Rot(k, turn) p - along = size cos(turn - middle), which shall be rest = size cos(half)
    along = dot(h, k) * dot(k, p)
    cos, sin, rest = dot(h, p) - along, dot(h, cross(k, p)), d - along
    square = cos * cos + sin * sin
    size = math.sqrt(square)
    if size < LOST:
        return guess, True
    left = square - rest * rest
    rest, root = (rest, math.sqrt(left)) if left > 0.0 else (math.copysign(size, rest), 0.0)
    if (guess[1] * cos >= guess[0] * sin) == other:
        root = -root
    return ((cos * rest - sin * root) / square, (sin * rest + cos * root) / square), left >= -SHORT * square


@inline
def elbow_turns(form: Floats, reach: Vector, guess: Numbers, other: bool) -> tuple[Turn, Turn, bool]:
    """Turns 2 and 3 that take O4 from O2 to where it shall be, and whether they can."""
    h2, h3, upper, fore = vector(form[H2]), vector(form[H3]), vector(form[UPPER]), vector(form[FORE])
    d = 0.5 * (dot(reach, reach) - dot(upper, upper) - dot(fore, fore))
    t3, spans = subproblem_4(upper, h3, fore, d, cos_sin(guess[2]), other)
    return subproblem_1(h2, plus(upper, turned(h3, t3, fore)), reach, cos_sin(guess[1])), t3, spans


@inline
def wrist_turns(
    form: Floats, ahead: Vector, across: Vector, first: float, guess: Numbers, other: bool
) -> tuple[Turn, Turn, Turn, bool]:
    """Turns 4, 5 and 6 that take axis 6 and a direction across it to where they shall be, and whether they can."""
    h4, h5, h6 = vector(form[H4]), vector(form[H5]), vector(form[H6])
    t5, bends = subproblem_4(h4, h5, h6, dot(h4, ahead), cos_sin(guess[4]), other)
    t4 = subproblem_1(h4, turned(h5, t5, h6), ahead, cos_sin(first))
    t6 = subproblem_1(
        h6, vector(form[ACROSS_WORLD]), turned(h5, back(t5), turned(h4, back(t4), across)), cos_sin(guess[5])
    )
    return t4, t5, t6, bends


@inline
def branch(form: Floats, pose: Numbers, guess: Numbers, number: int) -> tuple[Numbers, bool]:
    """The six angles of one of the eight branches, and whether there is one.

    Branch 0 is the one that the guess is on; the bits say which of shoulder, wrist and elbow is on the other side.
    """
    h1, h2, h3, h4 = vector(form[H1]), vector(form[H2]), vector(form[H3]), vector(form[H4])
    shoulder, flip, elbow = number & 1 != 0, number & 2 != 0, number & 4 != 0
    # From O1 to O5, axis 6 and a direction across it: first as the world sees them, then as link 1 does.
    reach = minus(minus((pose[9], pose[10], pose[11]), vector(form[O1])), rotated(pose, vector(form[O5_TIP])))
    t1, turns = subproblem_4(h2, minus(ORIGIN, h1), reach, form[LEVEL], cos_sin(guess[0]), shoulder)
    reach = minus(turned(h1, back(t1), reach), vector(form[O1_O2]))
    ahead = turned(h1, back(t1), rotated(pose, vector(form[AHEAD])))
    across = turned(h1, back(t1), rotated(pose, vector(form[ACROSS])))
    s2, s3 = form[SIDE_2], form[SIDE_3]
    if s2 != 0.0:  # axes 2, 3 and 4 are parallel, and turn the wrist together
        t4, t5, t6, bends = wrist_turns(form, ahead, across, guess[3] + s3 * guess[2] + s2 * guess[1], guess, flip)
        t2, t3, spans = elbow_turns(form, minus(reach, turned(h4, t4, vector(form[O4_O5]))), guess, elbow)
        a2, a3 = angle(t2), angle(t3)
        a4 = angle(t4) - s3 * a3 - s2 * a2
    else:
        t2, t3, spans = elbow_turns(form, reach, guess, elbow)
        ahead = turned(h3, back(t3), turned(h2, back(t2), ahead))
        across = turned(h3, back(t3), turned(h2, back(t2), across))
        t4, t5, t6, bends = wrist_turns(form, ahead, across, guess[3], guess, flip)
        a2, a3, a4 = angle(t2), angle(t3), angle(t4)
    return (angle(t1), a2, a3, a4, angle(t5), angle(t6)), turns and spans and bends


@inline
def on_branch(form: Floats, wiring: Ints, bounds: Bounds, pose: Numbers, guess: Floats, number: int, x: Floats) -> bool:
    """Coordinates x (6,) of one branch, whole turns nearest to the guess; whether it is there and inside the limits."""
    lower, upper = bounds.lower, bounds.upper
    for s in range(6):
        x[s] = guess[wiring[s, COLUMN]]
    angles, inside = branch(form, pose, (x[0], x[1], x[2], x[3], x[4], x[5]), number)
    for s in range(6):
        c = wiring[s, COLUMN]
        least, most = lower[c] - OUTSIDE, upper[c] + OUTSIDE
        x[c] = nearest_turn(angles[s], guess[c], least, most)
        inside = inside and least <= x[c] <= most
    return inside


@inline
def first_branch(form: Floats, wiring: Ints, bounds: Bounds, pose: Numbers, guess: Floats, x: Floats) -> bool:
    """Coordinates x (6,) of the first branch that there is inside the limits; whether one is."""
    for number in range(8):  # noqa: SIM110  any(...) takes a generator, which numba does not
        if on_branch(form, wiring, bounds, pose, guess, number, x):
            return True
    return False


@inline
def numbers_of(M: Floats) -> Numbers:
    """A pose (4, 4) as twelve numbers: rotation row by row, then translation."""
    return (
        M[0, 0], M[0, 1], M[0, 2], M[1, 0], M[1, 1], M[1, 2], M[2, 0], M[2, 1], M[2, 2], M[0, 3], M[1, 3], M[2, 3],
    )  # fmt: skip


@jit("i8(f8[:,::1], i8[:,::1], f8[::1], f8[::1], i8[::1], f8[:,:], f8[::1], f8[:,::1])")
def all_branches(
    form: Floats,
    wiring: Ints,
    lower: Floats,
    upper: Floats,
    multi_turn: Ints,
    target: Floats,
    guess: Floats,
    out: Floats,
) -> int:
    """All branches inside the limits for a target (4, 4), the guess's first: how many rows of out (8, 6) they are."""
    count = 0
    for number in range(8):
        if on_branch(form, wiring, Bounds(lower, upper, multi_turn), numbers_of(target), guess, number, out[count]):
            count += 1
    return count
