"""Random: poses of uniformly random configurations."""

from __future__ import annotations

import numpy as np

from pin_metaik.compare.cases.case import Case, Task
from pin_metaik.kinematics import Chain


def draw(chain: Chain, rng: np.random.Generator) -> Task:
    """The pose of coordinates drawn uniformly."""
    return Task.at(chain, chain.box.sample(rng, 1))


RANDOM = Case(
    "random", "Poses of configurations drawn uniformly within the limits, one turn for continuous joints.", draw
)
