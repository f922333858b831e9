"""Solutions as they are handed out: angles as near to a start as whole turns allow, the nearest solution first."""

from __future__ import annotations

from pin_metaik.compiled import Floats, inline
from pin_metaik.kinematics.kernel.forward import copy
from pin_metaik.kinematics.kernel.layout import Bounds, Entries
from pin_metaik.kinematics.kernel.multistart import unwind
from pin_metaik.kinematics.kernel.pose_solver import write_end


@inline
def write_nearest_first(
    solutions: Floats, count: int, x0: Floats, bounds: Bounds, entries: Entries, away: Floats, spare: Floats, q: Floats
) -> None:
    """Write the first ``count`` solutions (m, n) into the rows of q (m, nq), by their distance from x0 (n,).

    The rows have what other joints keep. ``away`` (m,) and ``spare`` (n,) are room; the solutions are moved.
    """
    for k in range(count):
        copy(solutions[k], spare)
        unwind(spare, x0, bounds)
        far = 0.0
        for c in range(x0.shape[0]):
            far += (spare[c] - x0[c]) * (spare[c] - x0[c])
        at = k
        while at > 0 and away[at - 1] > far:
            away[at] = away[at - 1]
            copy(solutions[at - 1], solutions[at])
            at -= 1
        away[at] = far
        copy(spare, solutions[at])
    for k in range(count):
        write_end(solutions[k], entries, q[k])


@inline
def repeat(q: Floats, rows: Floats) -> None:
    """Write q (nq,) into each of the rows (m, nq)."""
    for k in range(rows.shape[0]):
        copy(q, rows[k])
