"""Any of several targets: the first that is met, or the one whose solution is the nearest or the best."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import checked
from pin_metaik.collision import CollisionWorld
from pin_metaik.errors import InvalidTarget
from pin_metaik.ik.criteria import Selection, measure_of
from pin_metaik.ik.problem import Asked, IKProblem, check_targets
from pin_metaik.ik.result import IKResult, IKStatus
from pin_metaik.ik.solve import solve_ik
from pin_metaik.ik.solver import DEFAULT_SOLVER, IKSolver
from pin_metaik.kinematics import Chain
from pin_metaik.optimize import Budget
from pin_metaik.plain import fields_of
from pin_metaik.randomness import Rng, as_seed
from pin_metaik.watching import Progress, Stopped, Watch, tell

FIRST, GROWTH, ROUNDS = 500, 8, 12  # evaluations of a target in the first round, how rounds grow, and their number


@dataclass(frozen=True, eq=False)
class IKChoice:
    """Which of several targets is met, and by which configuration.

    Attributes:
        index: Number of the target that is met; None if none is.
        result: The answer to it; None if none is met.
        status: For each target why its search ended; None where it was not tried.
        evaluations: Forward kinematics computed, for all targets.
        seconds: Time taken, s.
        interrupted: Whether a watch ended the search.
    """

    index: int | None
    result: IKResult | None
    status: tuple[IKStatus | None, ...]
    evaluations: int
    seconds: float
    interrupted: bool = False

    @property
    def success(self) -> bool:
        """Whether any target is met."""
        return self.result is not None

    def __bool__(self) -> bool:
        """Whether any target is met."""
        return self.success

    @property
    def q(self) -> NDArray[np.float64] | None:
        """(nq,) the configuration that meets the target; None if none is met."""
        return None if self.result is None else self.result.q

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON: lengths in m, angles in rad."""
        return fields_of(self, "success", "index", "q", "status", "evaluations", "interrupted", "seconds")

    def __str__(self) -> str:
        found = "none is met" if self.index is None else f"target {self.index} is met"
        return f"of {len(self.status)} targets {found}, after {self.evaluations} evaluations in {self.seconds:.3g} s"


@checked
def solve_ik_any(
    chain: Chain,
    targets: Sequence[Asked] | NDArray[np.float64],
    q0: ArrayLike | None = None,
    *,
    solver: IKSolver | None = None,
    world: CollisionWorld | None = None,
    rng: Rng = None,
    watch: Watch | None = None,
) -> IKChoice:
    """Meet any of several targets, such as the grasps of an object.

    In a first round all targets are tried with a small budget; in further rounds those that are not decided, with
    larger ones, up to the solver's: so a target that is hard to decide does not delay others. The solver's ``select``
    says which is chosen: ``"first"`` takes the first target that is met in a round, in the order of the list; any other
    criterion compares the solutions of all targets that are met in the first round in which any is.

    Args:
        chain: The joints to move and the frame to place.
        targets: k targets, as for ``solve_ik``, those that are preferred first.
        q0: (nq,) configuration to start from; default: the chain's reference.
        solver: How to search; default ``IKSolver()``. Its budget of evaluations is for each target; its seconds, if it
            has any, are for all of them.
        world: What must not collide.
        rng: Seed or generator; ``None`` is a fixed seed. A generator gives one number as the seed.
        watch: Called with targets decided and in all before each search; True ends the work.

    Returns:
        The choice: check ``choice.success``, then ``choice.index`` and ``choice.result``.

    Raises:
        InvalidTarget: If there are no targets, or one of them is not valid; the message has its number.
        InvalidConfiguration: If ``q0`` is not a configuration of the model.
        InvalidSetting: If the world is another model's than the chain.
    """
    began = perf_counter()
    check_targets(targets, "one of no targets cannot be met: give at least one")
    seed = as_seed(rng)
    solver = DEFAULT_SOLVER if solver is None else solver
    for i, target in enumerate(targets):
        try:
            IKProblem.of(chain, target, world)
        except InvalidTarget as error:
            raise InvalidTarget(f"target {i}: {error}") from None
    results: dict[int, IKResult] = {}
    spent, interrupted = 0, False
    waiting = list(range(len(targets)))
    try:
        for budget in _rounds(solver.budget):
            for i in list(waiting):
                left = None if solver.budget.seconds is None else solver.budget.seconds - (perf_counter() - began)
                if left is not None and left <= 0.0:
                    raise Stopped(None)
                tell(watch, Progress(len(targets) - len(waiting), len(targets)))
                now = replace(solver, budget=replace(solver.budget, evaluations=budget, seconds=left))
                results[i] = result = solve_ik(chain, targets[i], q0, solver=now, world=world, rng=seed)
                spent += result.evaluations
                if _decided(result):
                    waiting.remove(i)
                if result.success and solver.select == "first":
                    break
            if any(result.success for result in results.values()) or not waiting:
                break
    except Stopped:
        interrupted = True
    met = [i for i, result in sorted(results.items()) if result.success]
    index = _best(results, met, solver.select, q0) if met else None
    return IKChoice(
        index,
        None if index is None else results[index],
        tuple(results[i].status if i in results else None for i in range(len(targets))),
        spent,
        perf_counter() - began,
        interrupted,
    )


def _rounds(budget: Budget) -> list[int]:
    """Evaluations for each target, round by round."""
    rounds, most = [FIRST], budget.evaluations
    while len(rounds) < ROUNDS and (most is None or rounds[-1] < most):
        rounds.append(GROWTH * rounds[-1])
    return [*rounds[:-1], rounds[-1] if most is None else most]


def _decided(result: IKResult) -> bool:
    """Whether more evaluations would change nothing."""
    proved = result.status is IKStatus.IN_COLLISION and result.proof is not None
    return result.success or result.status is IKStatus.UNREACHABLE or proved


def _best(results: dict[int, IKResult], met: list[int], select: Selection, q0: ArrayLike | None) -> int:
    """Of the targets that are met, the number of the one whose solution is best; of equals the first."""
    if select == "first":
        return met[0]
    measure = measure_of(select)
    values = []
    for i in met:
        chain = results[i].chain
        x0 = chain.x(chain.reference if q0 is None else chain.configuration(q0))
        values.append(float(measure(results[i].problem, results[i].x[None], x0)[0]))
    return met[int(np.argmin(values))]
