"""Steps that are quadratic programs: joint limits and step limits are constraints, not afterthoughts."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arguments import instance, shown
from pin_metaik.errors import InvalidSetting
from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.refine.iterate import Patience, Step, iterate
from pin_metaik.ik.refine.protocol import Refinement
from pin_metaik.ik.refine.qp_solvers import box_qp, check_installed
from pin_metaik.optimize.settings import positive

FLOOR = 1e-9  # what is left of the damping at a solution


@dataclass(frozen=True)
class QP:
    """Inverse kinematics as a sequence of quadratic programs (Kanoun, Lamiraux and Wieber 2011; Escande et al. 2014).

    Each step minimises |J dx + r|^2 + (damping |r|^2 + 1e-9) |dx|^2 + posture_weight |r|^2 |N (x + dx - posture)|^2
    with lower <= x + dx <= upper and |dx_i| <= largest, where N projects into the null space of J: the posture uses
    only the freedom that the target leaves. The solver's result is clipped to these bounds.

    Attributes:
        solver: ``"osqp"`` comes with this package; ``"daqp"`` (the quickest), ``"proxqp"``, ``"piqp"``, ``"quadprog"``
            and whatever else qpsolvers supports when it is installed.
        damping: Factor of the squared error, 1/m^2 or 1/rad^2.
        largest: The most that any coordinate moves in one step, rad or m.
        posture: Coordinates (n,) of the chain that the steps are drawn towards, rad or m; ``"middle"`` of the search
            box; or ``None``. It is not a second target: the descent ends as soon as the target is met.
        posture_weight: Weight of the squared distance from the posture, relative to the squared error, 1/rad^2. 0.02
            costs no evaluations; from 0.05 on some targets near limits are missed (200 on the Panda, weights 0.01 to
            1).
        tolerance: Of iterative solvers, relative to the step.
        patience: When a start is given up.
    """

    solver: str = "osqp"
    damping: float = 0.02
    largest: float = np.pi / 2.0
    posture: tuple[float, ...] | Literal["middle"] | None = None
    posture_weight: float = 0.02
    tolerance: float = 1e-5
    patience: Patience = field(default=Patience())

    def __post_init__(self) -> None:
        """Check names and settings where they enter.

        Raises:
            UnknownName: If the solver is not installed.
            InvalidSetting: If a setting is outside its range.
        """
        check_installed(self.solver)
        positive("damping", self.damping)
        positive("largest", self.largest)
        positive("posture_weight", self.posture_weight)
        positive("tolerance", self.tolerance)
        if self.posture is not None and not (isinstance(self.posture, str) and self.posture == "middle"):
            object.__setattr__(self, "posture", _coordinates(self.posture))

    def refine(self, problem: IKProblem, starts: NDArray[np.float64], evaluations: int) -> Refinement:
        """Descend from each of the starts (s, n), in order, until one meets the tolerances or the budget is spent.

        Raises:
            InvalidSetting: If the posture has not one coordinate for each joint of the chain.
        """
        instance(IKProblem, problem=problem)
        return iterate(problem, starts, evaluations, self.steps(problem), self.patience)

    def steps(self, problem: IKProblem) -> Step:
        """The step for a problem, with its solver set up."""
        n, lower, upper = problem.chain.n, problem.limits.lower, problem.limits.upper
        backward, forward = np.full(n, -self.largest), np.full(n, self.largest)
        solve = box_qp(self.solver, n, self.tolerance)
        posture = self._posture(problem)

        def step(
            x: NDArray[np.float64], r: NDArray[np.float64], J: NDArray[np.float64], square: float
        ) -> NDArray[np.float64]:
            size = math.sqrt(square)  # dx = |r| z: then z is of order 1, and any tolerance is one relative to the step
            w = self.damping * square + FLOOR
            P = J.T.dot(J)  # half the time of @ at this size
            P.flat[:: n + 1] += w
            q = J.T.dot(r) / size
            if posture is not None:
                pull = self.posture_weight * square * null_space(J, w)
                P += pull
                q += pull @ (x - posture) / size
            least = np.maximum(lower - x, backward)
            most = np.minimum(upper - x, forward)
            z = solve(P, q, least / size, most / size)
            dx: NDArray[np.float64] = np.minimum(np.maximum(size * z, least), most)
            return dx

        return step

    def _posture(self, problem: IKProblem) -> NDArray[np.float64] | None:
        if self.posture is None:
            return None
        if self.posture == "middle":
            middle: NDArray[np.float64] = 0.5 * (problem.box.lower + problem.box.upper)
            return middle
        if len(self.posture) != problem.chain.n:
            raise InvalidSetting(f"posture has {len(self.posture)} coordinates, the chain {problem.chain.n}")
        return np.array(self.posture)


def _coordinates(posture: object) -> tuple[float, ...]:
    """A posture somebody gave, as numbers."""
    try:
        coordinates = np.array(posture, dtype=float)
    except (TypeError, ValueError, OverflowError):
        coordinates = np.empty(0)
    if coordinates.ndim != 1 or coordinates.size == 0 or not np.isfinite(coordinates).all():
        raise InvalidSetting(f"posture must be finite coordinates, 'middle' or None, not {shown(posture)}")
    return tuple(coordinates.tolist())


def null_space(J: NDArray[np.float64], w: float) -> NDArray[np.float64]:
    """The projection N (n, n) = 1 - J'(J J' + w 1)^-1 J into the null space of J (m, n), w keeping it regular."""
    H = J @ J.T
    H.flat[:: len(J) + 1] += w
    N: NDArray[np.float64] = np.eye(J.shape[1]) - J.T @ np.linalg.solve(H, J)
    return N
