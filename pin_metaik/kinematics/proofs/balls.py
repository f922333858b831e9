"""Vectors and angles that are known up to a radius, and the steps of a closed form on them.

A ball is a vector and how far (m, or rad for a unit vector) the true one may be from it. An arc is a turn, as cosine
and sine, and by how much (rad) the true angle may differ; pi or more says nothing about it. Every step returns a ball
or an arc that holds the result for every choice of its arguments within theirs.
"""

from __future__ import annotations

import math
from typing import TypeAlias

from pin_metaik.compiled import inline
from pin_metaik.kinematics.kernel.closed_form import Turn, Vector, cross, dot, minus, plus, turned
from pin_metaik.kinematics.kernel.forward import cos_sin
from pin_metaik.kinematics.kernel.layout import ROUNDING

Ball: TypeAlias = tuple[Vector, float]
Arc: TypeAlias = tuple[Turn, float]


@inline
def norm(a: Vector) -> float:
    """|a|."""
    return math.sqrt(dot(a, a))


@inline
def lever(k: Vector, a: Vector) -> float:
    """Distance of the point a from the line through the origin along the unit vector k."""
    return norm(cross(k, a))


@inline
def chord(angle: float) -> float:
    """How far a point at distance 1 from an axis moves at most when it turns by up to an angle of at least 0, rad."""
    return 2.0 * cos_sin(0.5 * min(angle, math.pi))[1]


@inline
def reverse(arc: Arc) -> Arc:
    """The turn the other way."""
    (cos, sin), radius = arc
    return (cos, -sin), radius


@inline
def turned_ball(k: Vector, arc: Arc, ball: Ball) -> Ball:
    """Rot(k, arc) ball."""
    turn, off = arc
    v, radius = ball
    return turned(k, turn, v), radius + chord(off) * lever(k, v)


@inline
def sum_of(a: Ball, b: Ball) -> Ball:
    """a + b."""
    return plus(a[0], b[0]), a[1] + b[1]


@inline
def difference(a: Ball, b: Ball) -> Ball:
    """a - b."""
    return minus(a[0], b[0]), a[1] + b[1]


@inline
def arc_from_to(k: Vector, a: Ball, b: Ball) -> Arc:
    """The turns with Rot(k, turn) a = b, seen along k (subproblem 1)."""
    cos, sin = dot(a[0], b[0]) - dot(k, a[0]) * dot(k, b[0]), dot(k, cross(a[0], b[0]))
    size, at_a, at_b = math.sqrt(cos * cos + sin * sin), lever(k, a[0]), lever(k, b[0])
    if at_a <= a[1] or at_b <= b[1] or size == 0.0:
        return (1.0, 0.0), math.pi
    return (cos / size, sin / size), math.asin(a[1] / at_a) + math.asin(b[1] / at_b)


@inline
def arcs_onto(h: Vector, k: Vector, p: Ball, level: float, off: float) -> tuple[Arc, Arc, float]:
    """The turns with h . Rot(k, turn) p = level +- off (subproblem 4): around either of two, or how far there is none.

    The third number is by how much the equation misses having a real solution for every choice within the balls; above
    0 there is no turn.
    """
    # h . Rot(k, turn) p = along + size cos(turn - middle), which shall be level: size cos(half) = rest
    along = dot(h, k) * dot(k, p[0])
    cos, sin, rest = dot(h, p[0]) - along, dot(h, cross(k, p[0])), level - along
    size = math.sqrt(cos * cos + sin * sin)
    sway, spread = lever(k, h) * p[1], off + abs(dot(h, k)) * p[1]
    anything: Arc = (1.0, 0.0), math.pi
    lack = abs(rest) - spread - size - sway
    if lack > 0.0 or size <= sway or size == 0.0:
        return anything, anything, max(lack, 0.0)
    least, most = rest - spread, rest + spread
    near = math.acos(min(max(most / (size - sway if most > 0.0 else size + sway), -1.0), 1.0))
    far = math.acos(min(max(least / (size + sway if least > 0.0 else size - sway), -1.0), 1.0))
    cos, sin, radius = cos / size, sin / size, 0.5 * (far - near) + math.asin(sway / size)
    c, s = cos_sin(0.5 * (near + far))
    return ((cos * c - sin * s, sin * c + cos * s), radius), ((cos * c + sin * s, sin * c - cos * s), radius), 0.0


@inline
def beyond(angle: float, radius: float, lower: float, upper: float) -> float:
    """How far (rad) the angles within a radius, and their copies by whole turns, all are from a range; 0: one is in it.

    Rounding counts for the range.
    """
    if radius >= math.pi:
        return 0.0
    turn = 2.0 * math.pi
    above = angle + turn * math.ceil((lower - ROUNDING - radius - angle) / turn)  # the first copy that is not below
    over = above - radius - upper
    return 0.0 if over <= ROUNDING else min(over, lower - (above - turn + radius))
