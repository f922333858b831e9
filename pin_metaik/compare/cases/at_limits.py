"""Exactly at the limits: half of the joints are at one of their limits."""

from __future__ import annotations

import numpy as np

from pin_metaik.compare.cases.case import Case, Task
from pin_metaik.compare.cases.near_limit import near_limit
from pin_metaik.kinematics import Chain


def draw(chain: Chain, rng: np.random.Generator) -> Task:
    """A pose with half of the joints on one of their limits."""
    return Task.at(chain, chain.limits.clip(near_limit(chain, 1, rng, near=0.0)))


AT_LIMITS = Case("at_limits", "Poses of configurations with half of the joints exactly at one of their limits.", draw)
