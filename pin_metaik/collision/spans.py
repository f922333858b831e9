"""How far bodies can move about a configuration in the middle of a part of a straight joint move.

A joint that turns by an angle moves a point by at most the angle times the point's distance from its axis, its lever. A
lever is measured in the middle; it grows by at most what the joints beyond it move the body, and never beyond what the
body's own joint allows. So a bound is added up from a body's own joint to the base. (Schwarzer, Saha and Latombe 2005
bound moves by the longest levers that there are anywhere; these are the levers that there are here.)

* ``frames`` (J, 12): where each joint is: rotation column by column, then translation.
* ``screws`` (J, 8): what the whole move makes each joint do: point and direction of its axis, turn (rad), slide (m).
* ``supports`` (m, D): the joints that carry each body, from the base on; ``depths`` (m,) how many.
* ``balls`` (m, 5): a ball around each body in its joint's frame, and how far it reaches from that joint's axis.
"""

from __future__ import annotations

import math

from pin_metaik.compiled import Floats, Ints, jit

ROUNDING = 1.0 + 1e-9  # what a bound is more than its sum


@jit(
    "void(f8, f8[:,::1], f8[:,::1], i8[:,::1], i8[::1], f8[:,::1], i8[:,::1], i8[::1], f8[::1], f8[::1],"
    "f8[:,::1], f8[::1], f8[::1], f8[:,::1])"
)
def span(
    half: float,
    frames: Floats,
    screws: Floats,
    supports: Ints,
    depths: Ints,
    balls: Floats,
    own: Ints,
    common: Ints,
    margins: Floats,
    paddings: Floats,
    moved: Floats,
    reaches: Floats,
    wide: Floats,
    boxes: Floats,
) -> None:
    """How far each body, and each pair of bodies, can move against what it is checked against.

    Args:
        half: Half of the part, as a fraction of the whole move.
        frames: As above, in the middle of the part.
        screws: As above.
        supports: As above.
        depths: As above.
        balls: As above.
        own: (p, 2) pairs of bodies that move ...
        common: (p,) ... how many joints carry both ...
        margins: (p,) ... and their margins, m.
        paddings: (m,) what is added to the margin of each body against what stands, m.
        moved: (m, D + 1) receives how far (m) each body moves at most by the joints from a number on; row [i, 0] is
            its way in the world.
        reaches: (p,) receives by how much (m) the distance of each pair changes at most.
        wide: (p,) receives margins and reaches together.
        boxes: (m, 8) its last column receives paddings and ways in the world together.
    """
    for b in range(depths.shape[0]):
        depth = depths[b]
        moved[b, depth] = 0.0
        if depth == 0:
            boxes[b, 7] = paddings[b]
            continue
        frame = frames[supports[b, depth - 1]]
        x = frame[0] * balls[b, 0] + frame[3] * balls[b, 1] + frame[6] * balls[b, 2] + frame[9]
        y = frame[1] * balls[b, 0] + frame[4] * balls[b, 1] + frame[7] * balls[b, 2] + frame[10]
        z = frame[2] * balls[b, 0] + frame[5] * balls[b, 1] + frame[8] * balls[b, 2] + frame[11]
        total = 0.0
        for k in range(depth - 1, -1, -1):
            j = supports[b, k]
            here, row = frames[j], screws[j]
            u = here[0] * row[3] + here[3] * row[4] + here[6] * row[5]
            v = here[1] * row[3] + here[4] * row[4] + here[7] * row[5]
            w = here[2] * row[3] + here[5] * row[4] + here[8] * row[5]
            dx = x - here[9] - here[0] * row[0] - here[3] * row[1] - here[6] * row[2]
            dy = y - here[10] - here[1] * row[0] - here[4] * row[1] - here[7] * row[2]
            dz = z - here[11] - here[2] * row[0] - here[5] * row[1] - here[8] * row[2]
            if u != 0.0 or v != 0.0 or w != 0.0:
                dx, dy, dz = v * dz - w * dy, w * dx - u * dz, u * dy - v * dx
            lever = math.sqrt(dx * dx + dy * dy + dz * dz) + balls[b, 3] + total
            if k == depth - 1:
                lever = min(lever, balls[b, 4])
            total += half * (row[6] * lever + row[7]) * ROUNDING
            moved[b, k] = total
        boxes[b, 7] = paddings[b] + total
    for p in range(own.shape[0]):
        reaches[p] = moved[own[p, 0], common[p]] + moved[own[p, 1], common[p]]
        wide[p] = margins[p] + reaches[p]
