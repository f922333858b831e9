"""Whether balls exclude a box: points, axes and pairs of axes that cannot come together within it.

With e the tolerance, m and rad:

1. A point or axis k: |o_k - o'_k| > e + sum_j moves_j distances_kj, or the same for z_k, excludes the box. Each joint
   turns a ball about an axis that stands still: its centre moves by the move times the lever, its radius stays.
2. A pair of axes i < j: axis i is carried by the joints before i, axis j of the target by those after j. Distance of
   the points, z_i . z_j, and the height of each point along the other axis depend on the joints between alone: on none
   of them (constants), on one (sinusoids, exact), or on more (balls again).

Of an arm with a wrist the last point is that where its axes meet, which each of the others makes a pair with alone:
``box_wrist`` tells more of the wrist's axes.

What tells distances to elbow and wrist, offsets and parallel axes apart without splitting: of 30,000 boxes a target the
pairs prove 4 of 4 instead of none (ur5), 9 of 9 instead of 2 (pr2), at twice the time a box.
"""

from __future__ import annotations

import math

from pin_metaik.compiled import Floats, inline, shared
from pin_metaik.kinematics.kernel.closed_form import cross, dot, minus, vector
from pin_metaik.kinematics.kernel.layout import COLUMN, ROTATES
from pin_metaik.kinematics.proofs.balls import norm
from pin_metaik.kinematics.proofs.box import BoxArm, Laid, cosine_range, lay_levers


@shared
def excluded_by_balls(
    arm: BoxArm, laid: Laid, near: float, aligned: float, first: int, pairs: bool, weights: Floats
) -> bool:
    """Whether the box holds no configuration within ``near`` (m) and ``aligned`` (rad) of the target.

    ``first``: the point and axis from which on these are looked at; ``pairs``: whether pairs of them are, too.
    ``weights`` (n,) gets how much each coordinate keeps the tests from excluding: what to split.
    """
    lay_levers(arm, laid, 0 if pairs else first)
    if excluded_by_points(arm, laid, near, aligned, first, weights):
        return True
    return pairs and excluded_by_pairs(arm, laid, near, aligned)


@inline
def excluded_by_points(arm: BoxArm, laid: Laid, near: float, aligned: float, first: int, weights: Floats) -> bool:
    """Test 1, which also weighs the coordinates."""
    K, S = laid.distances.shape
    weights[:] = 0.0
    for k in range(first, K):
        apart = norm(minus(vector(laid.points[k]), vector(laid.target_points[k])))
        turned = norm(minus(vector(laid.axes[k]), vector(laid.target_axes[k])))
        room, lean = near, aligned
        for j in range(S):
            room += laid.moves[j] * laid.distances[k, j]
            lean += laid.moves[j] * laid.angles[k, j]
        if apart > room or turned > lean:
            return True
        by_place, by_turn = seventh_power(apart / room) / room, seventh_power(turned / lean) / lean
        for j in range(S):
            weight = laid.distances[k, j] * by_place + laid.angles[k, j] * by_turn
            weights[arm.wiring[j, COLUMN]] += laid.moves[j] * weight
    return False


@inline
def seventh_power(share: float) -> float:
    """Tests that nearly exclude decide which joint is split; powers of 7 and 13 prove most, 1 to 3 fewer."""
    square = share * share
    return square * square * square * share


@inline
def excluded_by_pairs(arm: BoxArm, laid: Laid, near: float, aligned: float) -> bool:
    """Test 2."""
    K, S = laid.distances.shape
    for i in range(K - 1):
        if arm.wiring[i, ROTATES] == 0:
            continue
        place, lean = near, aligned  # what the joints before i, and then those after j, make of the axes
        for m in range(i):
            place += laid.moves[m] * laid.distances[i, m]
            lean += laid.moves[m] * laid.angles[i, m]
        for j in range(i + 1 if K == S else K - 1, K):
            if arm.wiring[j, ROTATES] == 1 and excluded_by_pair(arm, laid, i, j, near, aligned, place, lean):
                return True
    return False


@inline
def excluded_by_pair(
    arm: BoxArm, laid: Laid, i: int, j: int, near: float, aligned: float, place: float, lean: float
) -> bool:
    """Whether axis i as the world has it, off by ``place`` and ``lean``, cannot go with axis j as the target has it."""
    S, moves, distances, angles = laid.half.shape[0], laid.moves, laid.distances, laid.angles
    place_j, lean_j = near, aligned
    for m in range(j + 1, S):
        place_j += moves[m] * distances[j, m]
        lean_j += moves[m] * angles[j, m]
    o_i, z_i, z_j = vector(laid.points[i]), vector(laid.axes[i]), vector(laid.axes[j])
    way, way_there = minus(vector(laid.points[j]), o_i), minus(vector(laid.target_points[j]), o_i)
    z_there = vector(laid.target_axes[j])
    # Between the axes: least and most of distance and cosine, and by how much more joints move these and the heights.
    shortest, least = norm(way), dot(z_i, z_j)
    longest, most = shortest, least
    one = j == i + 2 and arm.wiring[i + 1, ROTATES] == 1
    if one:
        shortest, longest, least, most = over_one_joint(laid, i)
    span = turn = height_j = height_i = carried = tilted = 0.0
    for m in range(j - 1, i, -1):  # how far o_j and z_j have been moved by the joints after m
        if arm.wiring[m, ROTATES] == 1:
            if not one:
                span += moves[m] * min(distances[i, m], distances[j, m] + carried)
                turn += moves[m] * min(angles[i, m], angles[j, m] + tilted)
            height_j += moves[m] * angles[i, m] * (distances[j, m] + carried)
            carried += moves[m] * distances[j, m]
            tilted += moves[m] * angles[j, m]
        else:
            span += moves[m]
            height_j += moves[m]
            carried += moves[m]
    carried = 0.0
    for m in range(i + 1, j):  # how far o_i has been moved, as link j sees it, by the joints before m
        if arm.wiring[m, ROTATES] == 1:
            height_i += moves[m] * angles[j, m] * (distances[i, m] + carried)
            carried += moves[m] * distances[i, m]
        else:
            height_i += moves[m]
            carried += moves[m]
    apart, cosine = norm(way_there), dot(z_i, z_there)
    places, leans = place + place_j, lean + lean_j + lean * lean_j
    if apart > longest + span + places or apart < shortest - span - places:
        return True
    if cosine > most + turn + leans or cosine < least - turn - leans:
        return True
    if abs(dot(z_i, way_there) - dot(z_i, way)) > height_j + places + lean * (apart + place_j):
        return True
    return bool(abs(dot(z_there, way_there) - dot(z_j, way)) > height_i + places + lean_j * (apart + place))


@inline
def over_one_joint(laid: Laid, i: int) -> tuple[float, float, float, float]:
    """Least and most distance of points i and i + 2, and cosine of their axes, while joint i + 1 turns."""
    m, half = vector(laid.axes[i + 1]), laid.half[i + 1]
    o, z_i, z_j = vector(laid.points[i + 1]), vector(laid.axes[i]), vector(laid.axes[i + 2])
    a, b = minus(vector(laid.points[i]), o), minus(vector(laid.points[i + 2]), o)
    along = dot(m, a) * dot(m, b)
    low, high = cosine_range(dot(a, b) - along, dot(a, cross(m, b)), half)
    square = dot(a, a) + dot(b, b) - 2.0 * along
    fixed = dot(m, z_i) * dot(m, z_j)
    least, most = cosine_range(dot(z_i, z_j) - fixed, dot(z_i, cross(m, z_j)), half)
    return (
        math.sqrt(max(square - 2.0 * high, 0.0)),
        math.sqrt(max(square - 2.0 * low, 0.0)),
        least + fixed,
        most + fixed,
    )
