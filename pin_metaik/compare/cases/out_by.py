"""Out by so much: poses just as far past the bound on an arm's reach as their case's name says."""

from __future__ import annotations

from functools import partial

import numpy as np

from pin_metaik.compare.cases.case import Case, Task
from pin_metaik.compare.cases.just_out_of_reach import REPORTED, draw, reported_unreachable
from pin_metaik.kinematics import Chain

MARGINS = {"0.1mm": 1e-4, "1mm": 1e-3, "1cm": 1e-2, "10cm": 1e-1}  # m


def draw_at(margin: float, chain: Chain, rng: np.random.Generator) -> Task:
    """A random pose, pushed out until it is past the bound by the margin (m)."""
    return draw(chain, rng, (margin, margin))


OUT_BY = {
    f"out_by_{name}": Case(
        f"out_by_{name}",
        f"Random poses pushed outward, {name} past the bound on the arm's reach that its links give.",
        partial(draw_at, margin),
        judge=reported_unreachable,
        success=REPORTED,
    )
    for name, margin in MARGINS.items()
}
