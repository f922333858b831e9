"""Another library's solver as a method: it is given a serial arm, poses and starts, and the same budget."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import TypeAlias

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.compare.methods.method import Answer
from pin_metaik.compare.methods.peers.serial_arm import SerialArm
from pin_metaik.errors import InvalidTarget
from pin_metaik.ik import IKProblem
from pin_metaik.kinematics import Chain
from pin_metaik.lookup import need

TOLERANCE = 1e-5  # m, rad

Solve: TypeAlias = Callable[[Array, Array, int, np.random.Generator], Answer]
"""Answers a pose (4, 4) from coordinates x0 (n,), within so many kernel evaluations."""


@dataclass(frozen=True)
class Peer:
    """A solver of another package.

    Attributes:
        name: Name in tables.
        module: What must be importable.
        extra: The extra of this package that brings it.
        load: The solver for an arm. Called once for each arm, and not timed.
    """

    name: str
    module: str
    extra: str
    load: Callable[[SerialArm], Solve]

    def solve(self, problem: IKProblem, x0: Array, budget: int, rng: np.random.Generator) -> Answer:
        """Solve within the budget.

        Raises:
            MissingExtra: The package is not installed.
            ValueError: The chain branches, or has mimic joints.
            InvalidTarget: More is asked than one pose.
        """
        if problem.goals:
            raise InvalidTarget(f"the method {self.name!r} takes one pose, and no goals of other kinds")
        return _loaded(self, problem.chain)(problem.targets[0].pose.homogeneous, x0, budget, rng)

    def need(self) -> None:
        """Make sure that it is installed, before a comparison runs for minutes.

        Raises:
            MissingExtra: It is not.
        """
        need(f"the method {self.name!r}", self.extra, self.module)


@lru_cache(maxsize=16)
def _loaded(peer: Peer, chain: Chain) -> Solve:
    peer.need()
    return peer.load(SerialArm.of_chain(chain.model.name, chain))
