"""Descents from many starts, of which the distinct solutions are kept."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.refine.dls import DLS, PROGRESS

VAIN = 60  # consecutive starts without a new solution ...
VAIN_EACH = 15  # ... and as many more for each solution known, before a search for others ends
SETTINGS = DLS()


def gather(
    problem: IKProblem,
    starts: NDArray[np.float64],
    found: NDArray[np.float64],
    known: int,
    apart: float,
    patience: int,
    evaluations: int,
    *,
    branch: bool = True,
    settings: DLS = SETTINGS,
) -> tuple[int, int, int]:
    """Descend from each start (s, n) and add what is new to ``found``, of which ``known`` rows are taken.

    Returns evaluations, rows taken, and how many starts in a row led to nothing new at the end.
    """
    chain = problem.chain
    return chain.kernels.descend_all(
        chain.bare,
        problem.tasks,
        problem.descended,
        np.ascontiguousarray(starts),
        np.array([settings.damping, PROGRESS, settings.iterations, evaluations]),
        apart,
        patience,
        branch,
        found,
        known,
    )
