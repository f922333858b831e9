"""Whether an arm with a closed form reaches a pose within its tolerances: its eight branches on balls.

The steps are those of ``kernel.closed_form``. A branch is left out where a step has no real solution, or a joint no
angle inside its limits, for any pose within the tolerances; when all eight are, no configuration reaches the pose: that
is proved. A branch that stays is a small box, all of whose angles are known up to a radius: a place to descend from.
"""

from __future__ import annotations

from pin_metaik.compiled import Floats, Ints, inline, jit
from pin_metaik.kinematics.kernel.closed_form import Numbers, angle, dot, minus, numbers_of, rotated, vector
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
    ROUNDING,
    SIDE_2,
    SIDE_3,
    UPPER,
    Bounds,
)
from pin_metaik.kinematics.proofs.balls import (
    Arc,
    Ball,
    arc_from_to,
    arcs_onto,
    beyond,
    difference,
    norm,
    reverse,
    sum_of,
    turned_ball,
)
from pin_metaik.kinematics.proofs.targets import exactly

POSSIBLE, SHOULDER, WRIST, ELBOW, LIMIT = 0, 1, 2, 3, 4  # what is wrong with a branch


@inline
def wrist_arcs(form: Floats, ahead: Ball, across: Ball, flip: bool) -> tuple[Arc, Arc, Arc, float]:
    """Turns 4, 5 and 6 that take axis 6 and a direction across it to where they shall be; how far they are not real."""
    h4, h5, h6 = vector(form[H4]), vector(form[H5]), vector(form[H6])
    one, two, lack = arcs_onto(h4, h5, (h6, 0.0), dot(h4, ahead[0]), ahead[1])
    t5 = two if flip else one
    t4 = arc_from_to(h4, turned_ball(h5, t5, (h6, 0.0)), ahead)
    back = turned_ball(h5, reverse(t5), turned_ball(h4, reverse(t4), across))
    return t4, t5, arc_from_to(h6, (vector(form[ACROSS_WORLD]), 0.0), back), lack


@inline
def elbow_arcs(form: Floats, reach: Ball, other: bool) -> tuple[Arc, Arc, float]:
    """Turns 2 and 3 that take O4 from O2 to ``reach``; how far (m) they are not real."""
    h2, h3, upper, fore = vector(form[H2]), vector(form[H3]), vector(form[UPPER]), vector(form[FORE])
    size = norm(reach[0])
    d = 0.5 * (size * size - dot(upper, upper) - dot(fore, fore))
    one, two, lack = arcs_onto(upper, h3, (fore, 0.0), d, size * reach[1] + 0.5 * reach[1] * reach[1])
    t3 = two if other else one
    spanned = sum_of((upper, 0.0), turned_ball(h3, t3, (fore, 0.0)))
    return arc_from_to(h2, spanned, reach), t3, lack / max(size, ROUNDING)


@inline
def judge_branch(
    form: Floats, pose: Numbers, near: float, aligned: float, number: int, angles: Floats, radii: Floats
) -> tuple[int, float]:
    """Angles and radii (6,) of one of the eight branches; else which step is not real, and by how much (m or a sine).

    The bits of ``number`` are the sides of shoulder, wrist and elbow. ``near`` and ``aligned`` (m, rad) are how far the
    true pose of the tip may be.
    """
    h1, h2, h3, h4 = vector(form[H1]), vector(form[H2]), vector(form[H3]), vector(form[H4])
    shoulder, flip, elbow = number & 1 != 0, number & 2 != 0, number & 4 != 0
    to_tip = vector(form[O5_TIP])
    wrist = minus(minus((pose[9], pose[10], pose[11]), vector(form[O1])), rotated(pose, to_tip))
    reach: Ball = wrist, near + aligned * norm(to_tip)
    ahead: Ball = rotated(pose, vector(form[AHEAD])), aligned
    across: Ball = rotated(pose, vector(form[ACROSS])), aligned
    one, two, lack = arcs_onto(h2, minus((0.0, 0.0, 0.0), h1), reach, form[LEVEL], 0.0)
    if lack > 0.0:
        return SHOULDER, lack
    t1 = two if shoulder else one
    reach = difference(turned_ball(h1, reverse(t1), reach), (vector(form[O1_O2]), 0.0))
    ahead, across = turned_ball(h1, reverse(t1), ahead), turned_ball(h1, reverse(t1), across)
    if form[SIDE_2] != 0.0:  # axes 2, 3 and 4 are parallel, and turn the wrist together
        t4, t5, t6, lack = wrist_arcs(form, ahead, across, flip)
        if lack > 0.0:
            return WRIST, lack
        t2, t3, lack = elbow_arcs(form, difference(reach, turned_ball(h4, t4, (vector(form[O4_O5]), 0.0))), elbow)
        if lack > 0.0:
            return ELBOW, lack
        angles[3] = angle(t4[0]) - form[SIDE_3] * angle(t3[0]) - form[SIDE_2] * angle(t2[0])
        radii[3] = t4[1] + t3[1] + t2[1]
    else:
        t2, t3, lack = elbow_arcs(form, reach, elbow)
        if lack > 0.0:
            return ELBOW, lack
        ahead = turned_ball(h3, reverse(t3), turned_ball(h2, reverse(t2), ahead))
        across = turned_ball(h3, reverse(t3), turned_ball(h2, reverse(t2), across))
        t4, t5, t6, lack = wrist_arcs(form, ahead, across, flip)
        if lack > 0.0:
            return WRIST, lack
        angles[3], radii[3] = angle(t4[0]), t4[1]
    angles[0], radii[0] = angle(t1[0]), t1[1]
    angles[1], radii[1] = angle(t2[0]), t2[1]
    angles[2], radii[2] = angle(t3[0]), t3[1]
    angles[4], radii[4] = angle(t5[0]), t5[1]
    angles[5], radii[5] = angle(t6[0]), t6[1]
    return POSSIBLE, 0.0


@inline
def possible_branches(
    form: Floats,
    wiring: Ints,
    bounds: Bounds,
    pose: Numbers,
    near: float,
    aligned: float,
    angles: Floats,
    radii: Floats,
    faults: Floats,
) -> int:
    """How many of the eight branches may hold a configuration; see ``judge_pose``."""
    lower, upper = bounds.lower, bounds.upper
    count = 0
    for number in range(8):
        fault, lack = judge_branch(form, pose, near, aligned, number, angles[number], radii[number])
        joint = -1
        if fault == POSSIBLE:
            for s in range(6):
                c = wiring[s, COLUMN]
                over = beyond(angles[number, s], radii[number, s], lower[c], upper[c])
                if over > lack:
                    fault, joint, lack = LIMIT, c, over
        faults[number, 0], faults[number, 1], faults[number, 2] = fault, joint, lack
        if fault == POSSIBLE:
            count += 1
    return count


@jit(
    "i8(f8[:,::1], f8[::1], i8[:,::1], f8[::1], f8[::1], i8[::1], Array(f8, 2, 'A', readonly=True), f8, f8,"
    " f8[:,::1], f8[:,::1], f8[:,::1])"
)
def judge_pose(
    form: Floats,
    deviation: Floats,
    wiring: Ints,
    lower: Floats,
    upper: Floats,
    multi_turn: Ints,
    target: Floats,
    near: float,
    aligned: float,
    angles: Floats,
    radii: Floats,
    faults: Floats,
) -> int:
    """How many of the eight branches may hold a configuration that is within the tolerances; 0: proved that none is.

    Args:
        form: (16, 3) of ``closed_form``.
        deviation: (2,) how far (m) and by how much turned (rad) the arm may be from its closed form.
        wiring: (6, 2) the coordinate of each joint, and that it turns.
        lower: (6,) rad, limits of the coordinates.
        upper: (6,) rad.
        multi_turn: (6,) whether a coordinate has whole turns to choose from; not looked at.
        target: (4, 4) world pose.
        near: How far (m) the tip may be from it.
        aligned: By how much (rad) it may be turned.
        angles: (8, 6) gets the angle of each joint on each branch that is real, rad.
        radii: (8, 6) gets how far the true angles may be from them, rad.
        faults: (8, 3) gets what is wrong with a branch, the coordinate beyond its limit or -1, and by how much (m, rad,
            or for the wrist a sine).
    """
    pose, skew = exactly(numbers_of(target))
    near, aligned = (1.0 + skew) * near + deviation[0], aligned + 2.0 * skew + deviation[1]
    return possible_branches(form, wiring, Bounds(lower, upper, multi_turn), pose, near, aligned, angles, radii, faults)
