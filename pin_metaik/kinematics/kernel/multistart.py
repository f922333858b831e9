"""The compiled searches: from one start after the other, for one target, for many, or for all solutions of one."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from pin_metaik.compiled import Floats, Ints, Singles, inline, jit, shared
from pin_metaik.kinematics.atlas import LEAF
from pin_metaik.kinematics.kernel.descent import (
    Arm,
    Bounds,
    Settings,
    Work,
    descend_from,
    evaluate,
    have_balls,
    workspace,
)
from pin_metaik.kinematics.kernel.forward import PATHS, TURN, copy, nearest_turn
from pin_metaik.kinematics.kernel.warm_starts import (
    ATLAS,
    TRIED,
    Atlas,
    Looks,
    feature_distance,
    lookup_space,
    merge_nearest,
    suggest,
    target_feature,
)

# Evaluations in all, and after which a search ends whose nearest is farther than that: |r|^2.
Patience: TypeAlias = tuple[int, int, float]


@jit(f"Tuple((f8, b1))({PATHS}, f8[:,::1], i8[:,::1], f8[::1], f8[::1], f8[:,::1])")
def linearize(
    joints: Floats,
    wiring: Ints,
    ends: Ints,
    tips: Floats,
    tasks: Floats,
    rows: Ints,
    x: Floats,
    r: Floats,
    J: Floats,
) -> tuple[float, bool]:
    """Weighted residual r (m,) and Jacobian by coordinate J (n, m) at x; also |r|^2 and whether all is in tolerance."""
    work = workspace(x.shape[0], rows, joints.shape[0])
    square, met = evaluate((joints, wiring, ends, tips), tasks, rows, x, work, have_balls(tasks))
    copy(work[6], r)
    for c in range(x.shape[0]):
        copy(work[7][c], J[c])
    return square, met


@inline
def unwind(x: Floats, x0: Floats, bounds: Bounds) -> None:
    """Move each winding angle by the whole turns that bring it nearest to x0 inside its limits."""
    lower, upper, winds = bounds
    for c in range(x.shape[0]):
        if winds[c] == 1:
            x[c] = min(max(nearest_turn(x[c], x0[c], lower[c], upper[c]), lower[c]), upper[c])


@shared
def search(
    arm: Arm,
    tasks: Floats,
    rows: Ints | None,
    bounds: Bounds,
    atlas: Atlas,
    guess: Floats,
    starts: Floats,
    settings: Settings,
    patience: Patience,
    best: Floats,
    work: Work,
    looks: Looks,
) -> tuple[int, int]:
    """Descend from one start after the other until one meets the tolerances or patience is at its end.

    The starts are somebody's guess (n,), those that the atlas suggests, if there is one, and ``starts`` (s, n). The
    guess goes first when its pose is nearer to the target than the poses in the atlas, otherwise after them.

    Returns the evaluations spent and the number of the start that met them, or -1; ``best`` (n,) gets the coordinates.
    """
    tried = TRIED if atlas[0].shape[0] > 0 else 0
    suggested, goal, weights = looks[0], looks[1], looks[2]
    own = 0
    if tried > 0:
        target_feature(tasks, atlas[3], goal, weights)
        nearest = suggest(tasks, rows, bounds, atlas, work, looks)
        own = 0 if feature_distance(arm, guess, atlas[3], goal, weights, work) <= nearest else tried
    lower, upper, _ = bounds
    for c in range(best.shape[0]):
        best[c] = min(max(guess[c], lower[c]), upper[c])
    evaluations, few, far = patience
    spent = 0
    least = np.inf
    for k in range(1 + tried + starts.shape[0]):
        if spent >= evaluations or (spent >= few and least > far):
            break
        if k == own:
            start = guess
        elif k <= tried:
            start = suggested[k - 1 if own == 0 else k]
        else:
            start = starts[k - tried - 1]
        steps, met, least = descend_from(
            arm, tasks, rows, bounds, start, settings, evaluations - spent, least, best, work
        )
        spent += steps
        if met:
            unwind(best, guess, bounds)
            return spent, k
    return spent, -1


@jit(f"void(f8[:,::1], {ATLAS}, i8, f8[:,::1])")
def neighbours(
    tasks: Floats, leaves: Singles, entries: Singles, gains: Singles, scale: float, count: int, out: Floats
) -> None:
    """The ``count`` atlas entries (count, n) nearest to the targets, nearest first."""
    T = tasks.shape[0]
    goal, weights, away = np.empty(9 * T, np.float32), np.empty(9 * T, np.float32), np.empty(LEAF, np.float32)
    target_feature(tasks, scale, goal, weights)
    order, distances = np.zeros(count, np.int64), np.empty(count, np.float32)
    distances[:] = np.inf
    for leaf in range(leaves.shape[0] - 1):
        merge_nearest(leaves[1 + leaf], leaf, goal, weights, away, order, distances)
    for k in range(count):
        copy(entries[order[k]], out[k])


BOUNDS = "f8[::1], f8[::1], i8[::1]"  # lower, upper, winds
PROBLEM = f"{PATHS}, f8[:,::1], i8[:,::1]?, {BOUNDS}"  # ..., tasks, rows, ...
SETTINGS = "f8, f8, i8, i8"  # damping, progress, evaluations from one start, evaluations


@jit(f"UniTuple(i8, 2)({PROBLEM}, {ATLAS}, f8[:,::1], {SETTINGS}, f8[::1])")
def descend(
    joints: Floats,
    wiring: Ints,
    ends: Ints,
    tips: Floats,
    tasks: Floats,
    rows: Ints | None,
    lower: Floats,
    upper: Floats,
    winds: Ints,
    leaves: Singles,
    entries: Singles,
    gains: Singles,
    scale: float,
    starts: Floats,
    damping: float,
    progress: float,
    per_start: int,
    evaluations: int,
    best: Floats,
) -> tuple[int, int]:
    """``search`` for one problem; the first of the starts (s, n) is the guess."""
    n = lower.shape[0]
    return search(
        (joints, wiring, ends, tips),
        tasks,
        rows,
        (lower, upper, winds),
        (leaves, entries, gains, scale),
        starts[0],
        starts[1:],
        (damping, progress, per_start),
        (evaluations, evaluations, np.inf),
        best,
        workspace(n, rows, joints.shape[0]),
        lookup_space(n, tasks.shape[0]),
    )


@inline
def is_new(x: Floats, solutions: Floats, count: int, winds: Ints, apart: float) -> bool:
    """Whether x differs by more than ``apart`` in some coordinate, whole turns aside, from the solutions so far."""
    for s in range(count):
        same = True
        for c in range(x.shape[0]):
            d = x[c] - solutions[s, c]
            if winds[c] == 1:
                d -= TURN * np.round(d / TURN)
            same = same and abs(d) <= apart
        if same:
            return False
    return True


@jit(f"UniTuple(i8, 3)({PROBLEM}, f8[:,::1], f8, i8, b1, {SETTINGS}, f8[:,::1], i8)")
def descend_all(
    joints: Floats,
    wiring: Ints,
    ends: Ints,
    tips: Floats,
    tasks: Floats,
    rows: Ints | None,
    lower: Floats,
    upper: Floats,
    winds: Ints,
    starts: Floats,
    apart: float,
    patience: int,
    branch: bool,
    damping: float,
    progress: float,
    per_start: int,
    evaluations: int,
    solutions: Floats,
    known: int,
) -> tuple[int, int, int]:
    """Collect distinct solutions (l, n) from the starts (s, n), ``known`` of them being there already.

    Stops when the starts, the evaluations or the room for solutions are used up, or when ``patience`` starts in a row
    that met the tolerances brought nothing new. With ``branch`` each solution is started from again with one joint
    moved by pi, which is where others often are. Returns evaluations, solutions and the length of the last vain row.
    """
    n = lower.shape[0]
    work = workspace(n, rows, joints.shape[0])
    x, start = np.empty(n), np.empty(n)
    spent, count, vain = 0, known, 0
    turned = n * known  # half-turn starts already taken: joint turned % n of solution turned // n
    given = 0
    while spent < evaluations and count < solutions.shape[0] and vain < patience:
        if branch and turned < n * count:
            copy(solutions[turned // n], start)
            c = turned % n
            turned += 1
            start[c] += -np.pi if start[c] + np.pi > upper[c] else np.pi
            start[c] = min(max(start[c], lower[c]), upper[c])
        elif given < starts.shape[0]:
            copy(starts[given], start)
            given += 1
        else:
            break
        steps, met, _ = descend_from(
            (joints, wiring, ends, tips),
            tasks,
            rows,
            (lower, upper, winds),
            start,
            (damping, progress, per_start),
            evaluations - spent,
            np.inf,
            x,
            work,
        )
        spent += steps
        if met:
            vain += 1
            if is_new(x, solutions, count, winds, apart):
                copy(x, solutions[count])
                count += 1
                vain = 0
    return spent, count, vain
