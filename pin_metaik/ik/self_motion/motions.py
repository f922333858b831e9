"""All self-motions of a target: every curve of solutions inside the limits, and the proof that none is missing."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidBudget, InvalidSetting
from pin_metaik.ik.criteria import Selection
from pin_metaik.ik.goals.pose import TargetLike
from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.proof import Proof
from pin_metaik.ik.self_motion.curve import CurvePoint, SelfMotionCurve, Values
from pin_metaik.ik.self_motion.search import Search
from pin_metaik.kinematics import Chain
from pin_metaik.optimize import Budget
from pin_metaik.optimize.settings import positive
from pin_metaik.plain import fields_of
from pin_metaik.watching import Stopped, Watch

MOTION_BUDGET = Budget(evaluations=400_000)
RESOLUTION = 0.3  # rad or m


@dataclass(frozen=True, eq=False)
class SelfMotions:
    """The self-motions of a chain with one spare degree of freedom for one target.

    Attributes:
        curves: The curves, the longest first.
        complete: ``Proof.BOXES``: every solution inside the limits is within ``resolution`` of a point of one of the
            curves in every coordinate, so that a missing curve would be that close to these all along. ``None``:
            nothing is proved.
        resolution: rad or m; see ``complete``.
        evaluations: Forward kinematics computed, and boxes looked at.
        seconds: Time taken, s.
        interrupted: Whether a watch ended the search.
    """

    curves: tuple[SelfMotionCurve, ...]
    complete: Proof | None
    resolution: float
    evaluations: int
    seconds: float
    interrupted: bool = False

    def __len__(self) -> int:
        return len(self.curves)

    def __iter__(self) -> Iterator[SelfMotionCurve]:
        return iter(self.curves)

    @checked
    def nearest(self, q: ArrayLike, weights: Mapping[str, float] | None = None) -> CurvePoint:
        """The point of all curves with the least distance from a configuration (nq,); see ``SelfMotionCurve.nearest``.

        Raises:
            InvalidSetting: There is no curve.
        """
        return self._least(lambda curve: curve._distance(q, weights))

    @checked
    def best(self, criterion: Selection) -> CurvePoint:
        """The point of all curves where a criterion is least; see ``SelfMotionCurve.best``.

        Raises:
            InvalidSetting: There is no curve.
        """
        return self._least(lambda curve: curve._criterion(criterion))

    def _least(self, values_on: Callable[[SelfMotionCurve], tuple[Values, float | None]]) -> CurvePoint:
        """Where values are least of all curves."""
        least: CurvePoint | None = None
        for curve in self.curves:
            point = curve._least(*values_on(curve), np.inf if least is None else least.value)
            if point is not None and (least is None or point.value < least.value):
                least = point
        if least is None:
            raise InvalidSetting("there is no self-motion to choose from: the target has no solution that was found")
        return least

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON: lengths in m, angles in rad."""
        plain = fields_of(self, "complete", "resolution", "interrupted", "evaluations", "seconds")
        return {"curves": [curve.as_dict() for curve in self.curves], **plain}


@checked
def self_motions(
    chain: Chain,
    target: TargetLike | Sequence[TargetLike],
    q0: ArrayLike | None = None,
    *,
    resolution: float = RESOLUTION,
    budget: Budget = MOTION_BUDGET,
    watch: Watch | None = None,
) -> SelfMotions:
    """Find every curve of solutions of a target that leaves a chain one spare degree of freedom.

    Boxes of configurations that cannot be excluded cover all solutions. From each box that no known curve comes near, a
    descent leads to a point of another curve, which is followed in both directions to its ends.

    Args:
        chain: The joints to move and the frame to place.
        target: As for ``solve_ik``; it must constrain one axis less than the chain has coordinates. The curves meet the
            middle of its tolerances.
        q0: (nq,) configuration that gives the values of joints outside the chain and of locked ones, and to which
            copies by whole turns are nearest; default: the chain's reference.
        resolution: rad or m; how close to the curves found a missing one would have to be (``SelfMotions.complete``).
        budget: Evaluations that may be spent, and seconds.
        watch: Called between boxes with evaluations spent and allowed; True ends the search.

    Raises:
        InvalidTarget: If the target is not a pose, position or orientation.
        InvalidConfiguration: If ``q0`` is not a configuration of the model.
        InvalidSetting: If the chain has none or several spare degrees of freedom, or ``resolution`` is not above zero.
        InvalidBudget: If the budget has no limit on evaluations.
    """
    positive("resolution", resolution)
    if budget.evaluations is None:
        raise InvalidBudget("finding self-motions needs a budget of evaluations: Budget(evaluations=...)")
    chain = chain if q0 is None else chain.at(q0)
    problem = IKProblem.of(chain, target).exact
    if not has_curves(problem):
        spare = chain.n - problem.m
        raise InvalidSetting(
            f"self-motions are curves where one coordinate is spare and one frame is placed; here {spare} are, of "
            f"{len(chain.frames)} frames: solve_ik_all samples the solutions"
        )
    base = chain.reference if q0 is None else chain.configuration(q0)
    return find_self_motions(problem, base, resolution, budget, watch)


def has_curves(problem: IKProblem) -> bool:
    """Whether a problem's solutions are curves: one frame, one spare coordinate, and nothing but a target."""
    return len(problem.targets) == 1 and problem.chain.n == problem.m + 1 and not problem.goals


def find_self_motions(
    problem: IKProblem, base: Array, resolution: float, budget: Budget, watch: Watch | None = None
) -> SelfMotions:
    """``self_motions`` of a problem that has curves, to be met exactly."""
    began = perf_counter()
    search = Search(problem, base, resolution, budget, watch)
    interrupted = False
    try:
        search.run()
    except Stopped:
        interrupted = True
    curves = tuple(sorted(search.curves, key=lambda curve: -curve.length))
    complete = Proof.BOXES if search.covered and not interrupted else None
    return SelfMotions(curves, complete, resolution, search.spent, perf_counter() - began, interrupted)
