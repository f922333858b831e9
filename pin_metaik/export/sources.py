"""The functions that exported code is made of: those of the compiled kernels themselves, by their source.

So there is one closed form, not one a language. What is added here is what the kernels have no need of: how far a
branch is from the pose, in the same subset of Python.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from pin_metaik.kinematics.kernel import closed_form, forward
from pin_metaik.kinematics.kernel.closed_form import (
    Numbers,
    Vector,
    cross,
    dot,
    minus,
    plus,
    rotated,
    turned,
    vector,
)
from pin_metaik.kinematics.kernel.forward import cos_sin
from pin_metaik.kinematics.kernel.layout import (
    ACROSS,
    ACROSS_WORLD,
    AHEAD,
    FORE,
    H1,
    H2,
    H3,
    H4,
    H5,
    H6,
    O1,
    O1_O2,
    O4_O5,
    O5_TIP,
    UPPER,
    Floats,
)


def carried(form: Floats, x: Numbers, v: Vector, first: int) -> Vector:
    """A vector behind joints ``first`` to 6 as the world sees it; each joint but the last ones has a way before it."""
    h1, h2, h3 = vector(form[H1]), vector(form[H2]), vector(form[H3])
    h4, h5, h6 = vector(form[H4]), vector(form[H5]), vector(form[H6])
    if first == 6:
        v = turned(h6, cos_sin(x[5]), v)
    if first >= 5:
        v = turned(h5, cos_sin(x[4]), v)
    v = turned(h2, cos_sin(x[1]), turned(h3, cos_sin(x[2]), turned(h4, cos_sin(x[3]), v)))
    return turned(h1, cos_sin(x[0]), v)


def wrist_at(form: Floats, x: Numbers) -> Vector:
    """Where the last two axes meet, at angles x (6,)."""
    h1, h2, h3, h4 = vector(form[H1]), vector(form[H2]), vector(form[H3]), vector(form[H4])
    v = turned(h4, cos_sin(x[3]), vector(form[O4_O5]))
    v = turned(h3, cos_sin(x[2]), plus(vector(form[FORE]), v))
    v = turned(h2, cos_sin(x[1]), plus(vector(form[UPPER]), v))
    return plus(vector(form[O1]), turned(h1, cos_sin(x[0]), plus(vector(form[O1_O2]), v)))


def miss(form: Floats, pose: Numbers, x: Numbers) -> float:
    """The squared distance of the tip's wrist, last axis and a direction across it from those of a pose (12,)."""
    wrist = minus((pose[9], pose[10], pose[11]), rotated(pose, vector(form[O5_TIP])))
    off = minus(wrist_at(form, x), wrist)
    ahead = minus(carried(form, x, vector(form[H6]), 5), rotated(pose, vector(form[AHEAD])))
    across = minus(carried(form, x, vector(form[ACROSS_WORLD]), 6), rotated(pose, vector(form[ACROSS])))
    return dot(off, off) + dot(ahead, ahead) + dot(across, across)


FUNCTIONS: tuple[Callable[..., Any], ...] = (
    dot,
    cross,
    plus,
    minus,
    rotated,
    turned,
    closed_form.back,
    closed_form.angle,
    closed_form.subproblem_1,
    closed_form.subproblem_4,
    closed_form.elbow_turns,
    closed_form.wrist_turns,
    closed_form.branch,
    wrist_at,
    carried,
    miss,
    forward.nearest_turn,
)
CONSTANTS = {"LOST": closed_form.LOST, "SHORT": closed_form.SHORT, "OUTSIDE": closed_form.OUTSIDE}
CONSTANTS |= {"FULL_TURN": forward.FULL_TURN}
