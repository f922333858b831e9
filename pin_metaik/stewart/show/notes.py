"""Remarks on the figures of a mechanism: where they are uncertain, and why."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from pin_metaik.stewart.mechanism.mechanism import Mechanism
from pin_metaik.stewart.platform.geometry import MOST_LEGS
from pin_metaik.stewart.platform.limits import LegLimits
from pin_metaik.stewart.workspace.surveying import LEAST
from pin_metaik.stewart.workspace.workspace import Workspace


def in_unit(mechanism: Mechanism, lengths: ArrayLike) -> str:
    """Lengths given in m, in the mechanism's unit."""
    return f"{', '.join(f'{value / mechanism.metres:.6g}' for value in np.ravel(lengths))} {mechanism.unit}"


def notes(mechanism: Mechanism, workspace: Workspace | None = None) -> list[str]:
    """Remarks on the figures: where they are uncertain, and why."""
    geometry, limits = mechanism.geometry, mechanism.limits
    said = []
    if geometry.n < MOST_LEGS:
        free = MOST_LEGS - geometry.n
        said.append(
            f"{geometry.n} legs between universal and spherical joints leave the platform {free} "
            f"degree{'s' if free > 1 else ''} of freedom: they do not hold it, and dexterity says only how they act"
        )
    if isinstance(limits, LegLimits) and limits.stroke > limits.shortest and limits.dead_length is None:
        said.append(
            f"a stroke of {in_unit(mechanism, limits.stroke)} does not fit into a leg that is "
            f"{in_unit(mechanism, limits.shortest)} long when retracted, unless it telescopes in several stages"
        )
    if workspace is None:
        return said
    if not workspace.complete:
        said.append("interrupted: the figures are about the poses seen until then")
    if max(workspace.cells.shape[:3]) > 1 and workspace.cells_reached < LEAST:
        said.append(f"only {workspace.cells_reached} cells were reached: the figures are rough; use a finer grid")
    return said
