"""Multi-start descent: from one start after the other until one arrives, or from all for all solutions."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from pin_metaik.compiled import Floats, Ints, inline, jit, separate
from pin_metaik.kinematics.kernel.descent import Descent, descend_from, descent_of
from pin_metaik.kinematics.kernel.forward import FULL_TURN, copy, nearest_turn, sizes_of, unpack
from pin_metaik.kinematics.kernel.layout import Arm, Bounds, Samples
from pin_metaik.kinematics.kernel.scratch import TRIED, LookupScratch, Scratch, lookup_scratch, scratch_for
from pin_metaik.kinematics.kernel.warm_starts import feature_distance, samples_of, suggest, target_feature


class Patience(NamedTuple):
    """Evaluations in all, and after which a search ends whose nearest is farther than ``far``, |r|^2."""

    evaluations: int
    few: int
    far: float


@inline
def unwind(x: Floats, x0: Floats, bounds: Bounds) -> None:
    """Move each winding angle by the whole turns that bring it nearest to x0 inside its limits."""
    lower, upper, multi_turn = bounds.lower, bounds.upper, bounds.multi_turn
    for c in range(x.shape[0]):
        if multi_turn[c] == 1:
            x[c] = min(max(nearest_turn(x[c], x0[c], lower[c], upper[c]), lower[c]), upper[c])


@separate
def search(
    arm: Arm,
    goals: Floats,
    rows: Ints | None,
    bounds: Bounds,
    samples: Samples,
    guess: Floats,
    starts: Floats,
    descent: Descent,
    patience: Patience,
    best: Floats,
    work: Scratch,
    look: LookupScratch,
) -> tuple[int, int]:
    """Descend from one start after the other until one meets the tolerances or patience is at its end.

    The starts are somebody's guess (n,), those that the samples suggest, if there are any, and ``starts`` (s, n). The
    guess goes first when its pose is nearer to the target than the poses of the samples, otherwise after them.

    Returns the evaluations spent and the number of the start that met them, or -1; ``best`` (n,) gets the coordinates.
    """
    tried = TRIED if samples.leaves.shape[0] > 0 else 0
    own = 0
    if tried > 0:
        target_feature(goals, samples.scale, look.feature, look.weights)
        nearest = suggest(goals, rows, bounds, samples, work, look)
        mine = feature_distance(arm, guess, samples.scale, look.feature, look.weights, work)
        own = 0 if mine <= nearest else tried
    lower, upper = bounds.lower, bounds.upper
    for c in range(best.shape[0]):
        best[c] = min(max(guess[c], lower[c]), upper[c])
    evaluations, few, far = patience.evaluations, patience.few, patience.far
    spent = 0
    least = np.inf
    for k in range(1 + tried + starts.shape[0]):
        if spent >= evaluations or (spent >= few and least > far):
            break
        if k == own:
            start = guess
        elif k <= tried:
            start = look.starts[k - 1 if own == 0 else k]
        else:
            start = starts[k - tried - 1]
        steps, met, least = descend_from(
            arm, goals, rows, bounds, start, descent, evaluations - spent, least, best, work
        )
        spent += steps
        if met:
            unwind(best, guess, bounds)
            return spent, k
    return spent, -1


@inline
def descend_in(
    block: Floats,
    goals: Floats,
    rows: Ints | None,
    starts: Floats,
    settings: Floats,
    best: Floats,
    work: Scratch,
    look: LookupScratch,
) -> tuple[int, int]:
    """``descend`` in room that was made for it."""
    arm, bounds, _, _, _ = unpack(block)
    descent, most = descent_of(settings)
    patience = Patience(most, most, np.inf)
    return search(
        arm, goals, rows, bounds, samples_of(block), starts[0], starts[1:], descent, patience, best, work, look
    )


@jit("UniTuple(i8, 2)(f8[::1], f8[:,::1], i8[:,::1]?, f8[:,::1], f8[::1], f8[::1])")
def descend(
    block: Floats, goals: Floats, rows: Ints | None, starts: Floats, settings: Floats, best: Floats
) -> tuple[int, int]:
    """``search`` for one problem; the first of the starts (s, n) is the guess."""
    S, n, T = sizes_of(block)
    return descend_in(block, goals, rows, starts, settings, best, scratch_for(n, rows, S), lookup_scratch(n, T))


@inline
def is_new(x: Floats, solutions: Floats, count: int, multi_turn: Ints, apart: float) -> bool:
    """Whether x differs by more than ``apart`` in some coordinate, whole turns aside, from the solutions so far."""
    for s in range(count):
        same = True
        for c in range(x.shape[0]):
            d = x[c] - solutions[s, c]
            if multi_turn[c] == 1:
                d -= FULL_TURN * np.round(d / FULL_TURN)
            same = same and abs(d) <= apart
        if same:
            return False
    return True


@inline
def collect_in(
    block: Floats,
    goals: Floats,
    rows: Ints | None,
    starts: Floats,
    settings: Floats,
    apart: float,
    patience: int,
    branch: bool,
    solutions: Floats,
    known: int,
    work: Scratch,
    x: Floats,
    start: Floats,
) -> tuple[int, int, int]:
    """``descend_all`` in room that was made for it."""
    arm, bounds, _, _, _ = unpack(block)
    descent, evaluations = descent_of(settings)
    n = x.shape[0]
    spent, count, vain = 0, known, 0
    turned = n * known  # half-turn starts already taken: joint turned % n of solution turned // n
    given = 0
    while spent < evaluations and count < solutions.shape[0] and vain < patience:
        if branch and turned < n * count:
            copy(solutions[turned // n], start)
            c = turned % n
            turned += 1
            start[c] += -np.pi if start[c] + np.pi > bounds.upper[c] else np.pi
            start[c] = min(max(start[c], bounds.lower[c]), bounds.upper[c])
        elif given < starts.shape[0]:
            copy(starts[given], start)
            given += 1
        else:
            break
        steps, met, _ = descend_from(arm, goals, rows, bounds, start, descent, evaluations - spent, np.inf, x, work)
        spent += steps
        if met:
            vain += 1
            if is_new(x, solutions, count, bounds.multi_turn, apart):
                copy(x, solutions[count])
                count += 1
                vain = 0
    return spent, count, vain


@jit("UniTuple(i8, 3)(f8[::1], f8[:,::1], i8[:,::1]?, f8[:,::1], f8[::1], f8, i8, b1, f8[:,::1], i8)")
def descend_all(
    block: Floats,
    goals: Floats,
    rows: Ints | None,
    starts: Floats,
    settings: Floats,
    apart: float,
    patience: int,
    branch: bool,
    solutions: Floats,
    known: int,
) -> tuple[int, int, int]:
    """Collect distinct solutions (l, n) from the starts (s, n), ``known`` of them being there already.

    Stops when the starts, the evaluations or the room for solutions are used up, or when ``patience`` starts in a row
    that met the tolerances brought nothing new. With ``branch`` each solution is started from again with one joint
    moved by pi, which is where others often are. Returns evaluations, solutions and the length of the last vain row.
    """
    S, n, _ = sizes_of(block)
    work, x, start = scratch_for(n, rows, S), np.empty(n), np.empty(n)
    return collect_in(block, goals, rows, starts, settings, apart, patience, branch, solutions, known, work, x, start)
