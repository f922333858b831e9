"""Levenberg-Marquardt steps, which differ in how they choose the damping."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.refine.iterate import Patience, iterate
from pin_metaik.ik.refine.protocol import Refinement
from pin_metaik.optimize.settings import one_of, positive

Rule: TypeAlias = Literal["chan", "sugihara", "wampler"]

SCALES: dict[Rule, float] = {"chan": 0.1, "sugihara": 1e-4, "wampler": 1e-4}
FLOOR = 1e-9  # of the damping: at a singular pose J J' alone cannot be solved with


@dataclass(frozen=True)
class LM:
    """Levenberg-Marquardt, dx = -(J'J + W_n)^-1 J'r with W_n = w 1, clipped at the limits.

    With E = |r|^2 / 2 the damping w is, as in the Robotics Toolbox,

    * ``"chan"``: scale E (Chan and Lawrence 1988): vanishes at the solution, converges quadratically there;
    * ``"sugihara"``: E + scale (Sugihara 2011): stays solvable at singular poses, and for targets out of reach;
    * ``"wampler"``: scale (Wampler 1986; Nakamura and Hanafusa 1986): damped least squares with a constant damping.

    Attributes:
        rule: How to choose the damping.
        scale: The constant of the rule: 1/rad^2 for Chan, otherwise in the unit of J'J; ``None``: 0.1, 1e-4 and 1e-4.
        patience: When a start is given up.
    """

    rule: Rule = "chan"
    scale: float | None = None
    patience: Patience = field(default=Patience())

    def __post_init__(self) -> None:
        """Raises InvalidSetting for an unknown rule or a scale that is not above 0."""
        one_of("rule", self.rule, Rule)
        if self.scale is not None:
            positive("scale", self.scale)

    def refine(self, problem: IKProblem, starts: NDArray[np.float64], evaluations: int) -> Refinement:
        """Descend from each of the starts (s, n), in order, until one meets the tolerances or the budget is spent."""
        return iterate(problem, starts, evaluations, self.step, self.patience)

    def step(
        self, x: NDArray[np.float64], r: NDArray[np.float64], J: NDArray[np.float64], square: float
    ) -> NDArray[np.float64]:
        """dx (n,) for a residual r (m,), its Jacobian J (m, n) and square = |r|^2."""
        E = 0.5 * square
        scale = SCALES[self.rule] if self.scale is None else self.scale
        match self.rule:
            case "chan":
                w = scale * E
            case "sugihara":
                w = E + scale
            case "wampler":
                w = scale
        return damped(r, J, max(w, FLOOR))


def damped(r: NDArray[np.float64], J: NDArray[np.float64], w: float) -> NDArray[np.float64]:
    """dx (n,) = -J'(J J' + w 1)^-1 r, which is -(J'J + w 1)^-1 J'r from the smaller system."""
    H = J @ J.T
    H.flat[:: len(r) + 1] += w
    dx: NDArray[np.float64] = -(J.T @ np.linalg.solve(H, r))
    return dx
