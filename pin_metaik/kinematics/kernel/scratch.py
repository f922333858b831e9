"""The arrays that loops work in, made once before they begin, and every one by its name."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from pin_metaik.compiled import Floats, Ints, Singles, separate_allocating
from pin_metaik.kinematics.kernel.layout import LEAF

OPENED, TRIED = 4, 8  # leaves of the table of samples that are opened, entries that are tried


class Scratch(NamedTuple):
    """Of a descent.

    Attributes:
        axes: (S, 3) axis of each joint, in the target frame.
        origins: (S, 3) a point on each, m.
        pose: (12,) of the tip, in the target frame.
        error: (6,) translation and rotation vector of that.
        r6: (6,) weighted residual of one tip ...
        J6: (n, 6) ... and its Jacobian by coordinate.
        r: (m,) of the rows that count ...
        J: (n, m) ... and theirs.
        H: (m, m) J' J + damping I.
        y: (m,) the solution of H y = r.
        x: (n,) where the descent is.
        dx: (n,) the step from there.
        held: (n,) 1 where a coordinate is kept by its limit.
    """

    axes: Floats
    origins: Floats
    pose: Floats
    error: Floats
    r6: Floats
    J6: Floats
    r: Floats
    J: Floats
    H: Floats
    y: Floats
    x: Floats
    dx: Floats
    held: Floats


@separate_allocating
def scratch_for(n: int, rows: Ints | None, S: int) -> Scratch:
    """One allocation for all starts; ``rows`` None: for the whole pose of one tip."""
    m = 6 if rows is None else rows.shape[0]
    return Scratch(
        np.empty((S, 3)), np.empty((S, 3)), np.empty(12), np.empty(6), np.empty(6), np.empty((n, 6)), np.empty(m),
        np.empty((n, m)), np.empty((m, m)), np.empty(m), np.empty(n), np.empty(n), np.empty(n),
    )  # fmt: skip


class LookupScratch(NamedTuple):
    """Of a look-up in the table of samples.

    Attributes:
        starts: (TRIED, n) what it suggests, best first.
        feature: (9 T,) of the targets.
        weights: (9 T,) 0 where they leave position or orientation free.
        away: (LEAF,) squared distances of the entries of a leaf.
        opened: (OPENED,) the nearest leaves ...
        spans: (OPENED,) ... and the squared distances of their means.
        order: (TRIED,) the nearest entries ...
        distances: (TRIED,) ... and their squared distances.
        scores: (TRIED,) of the starts, smaller is better.
    """

    starts: Floats
    feature: Singles
    weights: Singles
    away: Singles
    opened: Ints
    spans: Singles
    order: Ints
    distances: Singles
    scores: Floats


@separate_allocating
def lookup_scratch(n: int, T: int) -> LookupScratch:
    """For one look-up after the other."""
    return LookupScratch(
        np.empty((TRIED, n)),
        np.empty(9 * T, np.float32),
        np.empty(9 * T, np.float32),
        np.empty(LEAF, np.float32),
        np.empty(OPENED, np.int64),
        np.empty(OPENED, np.float32),
        np.empty(TRIED, np.int64),
        np.empty(TRIED, np.float32),
        np.empty(TRIED),
    )
