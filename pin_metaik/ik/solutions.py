"""All distinct solutions of one target."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from time import perf_counter
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import checked
from pin_metaik.collision import CollisionWorld
from pin_metaik.errors import InvalidBudget, InvalidSetting
from pin_metaik.ik.collect import collect
from pin_metaik.ik.criteria import Selection, measure_of
from pin_metaik.ik.goals.pose import Target
from pin_metaik.ik.labels import labels_of
from pin_metaik.ik.plain_all import ENOUGH, ROOTS, all_of_plain
from pin_metaik.ik.problem import Asked, IKProblem, check_world
from pin_metaik.ik.proof import Proof
from pin_metaik.ik.result import Parts
from pin_metaik.ik.self_motion.curve import SelfMotionCurve
from pin_metaik.ik.self_motion.motions import (
    MOTION_BUDGET,
    RESOLUTION,
    find_self_motions,
    has_curves,
)
from pin_metaik.ik.singular import dimension_at
from pin_metaik.ik.solver import APART, DEFAULT_SOLVER, IKSolver
from pin_metaik.kinematics import Chain
from pin_metaik.optimize import Budget
from pin_metaik.optimize.settings import few, positive
from pin_metaik.plain import fields_of
from pin_metaik.randomness import Rng
from pin_metaik.watching import Stopped, Watch

DEFAULT_BUDGET = Budget(evaluations=1_000_000)


@dataclass(frozen=True, eq=False)
class IKSolutions:
    """Distinct solutions of one problem, the nearest to the start first.

    Attributes:
        q: (s, nq) configurations, each judged by Pinocchio, and in a world by coal.
        complete: What proves that these are all, each to within the distance between distinct solutions: the branches
            of the arm's closed form, the number of its configurations, real and complex, or boxes that cover all
            configurations; ``None`` where nothing does, as on a chain with more joints than its target needs, in a
            singularity, or where tolerances leave room for more than one answer. What meets the tolerances but not the
            pose exactly counts only where nothing near it does.
        evaluations: Forward kinematics computed.
        seconds: Time taken, s.
        chain: The chain, with its held joints where the start has them.
        given: What was asked; a pose as position and quaternion, which is cheaper than a copy: see ``problem``.
        world: The world they must not collide in, if one was given. A pickle leaves it behind, as it has all meshes in
            it.
        interrupted: Whether a watch ended the search.
    """

    q: NDArray[np.float64]
    complete: Proof | None
    evaluations: int
    seconds: float
    chain: Chain = field(repr=False)
    given: IKProblem | Target | Parts = field(repr=False)
    world: CollisionWorld | None = field(default=None, repr=False)
    interrupted: bool = False

    def __getstate__(self) -> dict[str, object]:
        """Pickle without the world: kilobytes rather than megabytes."""
        kept = {name: value for name, value in self.__dict__.items() if name != "problem"}
        given = replace(self.given, world=None) if isinstance(self.given, IKProblem) else self.given
        return {**kept, "given": given, "world": None}

    @cached_property
    def problem(self) -> IKProblem:
        """What was asked."""
        asked = self.given
        if isinstance(asked, IKProblem):
            return asked
        target = asked if isinstance(asked, Target) else pin.XYZQUATToSE3(asked[0] + asked[1])
        return IKProblem.of(self.chain, target, self.world)

    @cached_property
    def curves(self) -> tuple[SelfMotionCurve, ...]:
        """All self-motions of a chain with one spare coordinate, the longest first; found when first asked for.

        See ``self_motions``, which also says whether they are proved to be all, and takes a resolution and a budget.
        There are none where solutions are separate, or have more than one degree of freedom: those are sampled in q.
        """
        problem = replace(self.problem.exact, world=None)
        if not has_curves(problem):
            return ()
        return find_self_motions(problem, problem.chain.reference, RESOLUTION, MOTION_BUDGET).curves

    @property
    def x(self) -> NDArray[np.float64]:
        """(s, n) the chain's coordinates."""
        return self.problem.chain.x(self.q)

    @cached_property
    def labels(self) -> tuple[str, ...]:
        """The branch that each solution is on, such as "shoulder + elbow - wrist +".

        It stays the same from pose to pose along any motion that crosses no singularity: it has the signs of what
        vanishes in them, of arms with a closed form three factors, of other chains with separate solutions the
        determinant of the Jacobian, which several solutions share. Empty where solutions are not separate.
        """
        return labels_of(self.problem, self.x)

    @cached_property
    def dimensions(self) -> tuple[int, ...]:
        """How many degrees of freedom the solutions near each one have: 0 where it is separate, else it is one of many.

        On a redundant chain it is the number of its spare coordinates. On any other it is above 0 in singularities
        where joints move while the frame stands still, as far as a motion that is tried shows: then q has one solution
        of each curve (1), the nearest to the start of all points 0.05 rad or m apart, and of all surfaces (2) one.
        """
        return tuple(dimension_at(self.problem.exact, x) for x in self.x)

    @checked
    def best(self, criterion: Selection, q0: ArrayLike | None = None) -> NDArray[np.float64]:
        """The solution (nq,) where a criterion is least.

        Args:
            criterion: As for ``IKSolver.select``: a name, ``Weighted``, or a function of a configuration (nq,).
            q0: (nq,) what ``"nearest"`` is near to; default: the chain's reference.

        Raises:
            UnknownName: No criterion of that name.
            InvalidSetting: There is no solution, no world for ``"clearance"``, or the function gives no number.
            InvalidConfiguration: If ``q0`` is not a configuration of the model.
        """
        measure, chain = measure_of(criterion), self.problem.chain
        if not len(self.q):
            raise InvalidSetting("there is no solution to choose from")
        x0 = chain.x(chain.reference if q0 is None else chain.configuration(q0))
        best: NDArray[np.float64] = self.q[np.argmin(measure(self.problem, self.x, x0))]
        return best

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON: lengths in m, angles in rad."""
        return fields_of(self, "q", "labels", "dimensions", "complete", "interrupted", "evaluations", "seconds")

    def __len__(self) -> int:
        return len(self.q)

    def __iter__(self) -> Iterator[NDArray[np.float64]]:
        return iter(self.q)


@checked
def solve_ik_all(
    chain: Chain,
    target: Asked,
    q0: ArrayLike | None = None,
    *,
    limit: int = 64,
    apart: float = APART,
    solver: IKSolver | None = None,
    budget: Budget = DEFAULT_BUDGET,
    certify: bool = True,
    world: CollisionWorld | None = None,
    rng: Rng = None,
    watch: Watch | None = None,
) -> IKSolutions:
    """Find all distinct solutions of a target, and prove that there are no others where that can be had.

    Solutions that differ by whole turns count as one and come as the copy nearest to ``q0``. Descents start from what a
    closed form says, if the arm has one, and from all configurations of six coordinates, real and complex, which are
    found by elimination and continuation. Otherwise, and where some of these are missing, as in singularities, they
    start from an atlas of the chain, from random configurations, and from the solutions known with one joint turned
    half round, until no new one appears. Then, on chains of six coordinates and fewer, boxes of configurations are
    looked at for what may be missing, unless counting has proved that nothing is.

    Args:
        chain: The joints to move and the frames to place.
        target: As for ``solve_ik``.
        q0: (nq,) configuration the solutions are ordered by, and that has the joints outside the chain and the locked
            ones; default: the chain's reference.
        limit: Solutions to stop at; what ends the search on redundant chains.
        apart: rad or m by which some coordinate of two solutions must differ.
        solver: Whose refiner descends; default ``IKSolver()``. Of a solver, nothing else is used here.
        budget: Evaluations (and seconds, which are not reproducible) that may be spent.
        certify: Whether boxes may be looked at to prove that no solution is missing, which takes milliseconds.
        world: What must not collide: solutions that do are left out, after they have counted towards the limit.
        rng: Seed or generator; ``None`` is a fixed seed.
        watch: Called between batches of descents with evaluations spent and allowed; True ends the search.

    Raises:
        InvalidTarget: If the target is not a pose, position or orientation.
        InvalidConfiguration: If ``q0`` is not a configuration of the model.
        InvalidSetting: If ``limit`` or ``apart`` is not above zero, the solver has no refiner, or the world is another
            model's than the chain.
        InvalidBudget: If the budget has no limit on evaluations.
    """
    few("limit", limit)
    positive("apart", apart)
    if budget.evaluations is None:
        raise InvalidBudget("collecting solutions needs a budget of evaluations: Budget(evaluations=...)")
    solver = DEFAULT_SOLVER if solver is None else solver
    if solver.refiner is None:
        raise InvalidSetting("all solutions are found by a refiner: give the solver one, e.g. IKSolver(refiner='dls')")
    began = perf_counter()
    chain = chain if q0 is None else chain.at(q0)
    if limit >= ROOTS and budget.seconds is None and budget.evaluations >= ENOUGH and watch is None:
        plain = all_of_plain(chain, target, q0, solver.descent, apart, certify)
        if plain is not None:
            q = plain.q
            if world is not None:
                check_world(chain, world)
                q = q[[not world.checker.collides(one) for one in q]]
            return IKSolutions(q, plain.complete, plain.evaluations, perf_counter() - began, chain, plain.given, world)
    base = chain.reference if q0 is None else chain.configuration(q0)
    problem = IKProblem.of(chain, target, world).at(base)
    x0 = chain.x(base)
    interrupted = False
    try:
        _, found, complete, spent = collect(
            problem,
            x0,
            solver.descent,
            rng,
            limit=limit,
            apart=apart,
            budget=budget,
            certify=certify,
            watch=watch,
        )
    except Stopped as stop:
        (found, spent), complete, interrupted = stop.result, None, True
    found = problem.nearest_turns(found, x0)
    found = found[np.argsort(np.linalg.norm(found - x0, axis=1), kind="stable")]
    q = chain.q(found, base)
    judged = np.array([problem.accepts(one) for one in q], dtype=bool)
    return IKSolutions(q[judged], complete, spent, perf_counter() - began, chain, problem, world, interrupted)
