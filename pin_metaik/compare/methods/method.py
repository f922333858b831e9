"""Methods: anything that answers an inverse-kinematics problem within a budget of kernel evaluations."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.ik import IKProblem


@dataclass(frozen=True, eq=False)
class Answer:
    """The answer of a method to a problem.

    Attributes:
        x: (n,) the best coordinates found, whether the problem is solved or not.
        claimed: Whether the method claims to have solved the problem; Pinocchio checks it.
        evaluations: Kernel evaluations spent: 1 for a forward kinematics, ``FK_WITH_JACOBIAN`` for one with a Jacobian.
            None if the method does not count them.
        status: How it ended, in its own words; ``"UNREACHABLE"`` when it says that the target is out of reach.
        trace: (g, 2) evaluations and best cost so far, or None.
    """

    x: Array
    claimed: bool
    evaluations: int | None
    status: str = ""
    trace: Array | None = None


@runtime_checkable
class Method(Protocol):
    """A method to compare. Your own method is any object with a name and this function.

    Attributes:
        name: Name in tables.
    """

    @property
    def name(self) -> str:
        """Name in tables."""
        ...

    def solve(self, problem: IKProblem, x0: Array, budget: int, rng: np.random.Generator) -> Answer:
        """Answer a problem.

        Args:
            problem: One target for the only frame of ``problem.chain``, or goals to be met together.
            x0: (n,) coordinates to start from.
            budget: Kernel evaluations that may be spent.
            rng: The only source of randomness.
        """
        ...
