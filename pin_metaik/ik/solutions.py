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
from pin_metaik.ik.singular import dimensions_at
from pin_metaik.ik.solver import APART, DEFAULT_SOLVER, IKSolver
from pin_metaik.kinematics import Chain
from pin_metaik.kinematics.roots.real import FOR_ROOTS
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
        complete: How it is proved that no solution is missing that is farther than ``apart`` from all of these: by the
            branches of the arm's closed form, by the number of its real and complex configurations, or by boxes that
            cover all configurations. ``None`` without a proof, as for a chain with more joints than the target needs,
            in a singularity, or where the tolerances admit more than one solution close by. A configuration that meets
            the tolerances but not the exact pose counts as a solution only where none near it meets the pose.
        evaluations: Forward kinematics computed.
        seconds: Time taken, s.
        chain: The chain, with its held joints as in the start.
        given: The target; a pose as position and quaternion, which is cheaper than a copy: see ``problem``.
        world: The world in which collisions were checked, if one was given. It is not pickled, because of all its
            meshes.
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

        ``self_motions`` takes a resolution and a budget, and says whether it is proved that none is missing. Empty
        where the solutions are isolated, and where they have more than one degree of freedom: then ``q`` samples them.
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

        A label does not change along a motion that crosses no singularity, because it consists of signs of quantities
        that vanish only there: for an arm with a closed form, of three factors of its determinant; for another chain
        with isolated solutions, of the determinant of its Jacobian, so that several solutions share a label. Empty
        where the solutions form a continuum.
        """
        return labels_of(self.problem, self.x)

    @cached_property
    def dimensions(self) -> tuple[int, ...]:
        """How many degrees of freedom the solutions near each one have: 0 where it is separate, else it is one of many.

        On a redundant chain it is the number of its spare coordinates. On any other it is above 0 in singularities
        where joints move while the frame stands still, within half of the tolerances and 5e-6 m and rad, as far as a
        motion that is tried shows: then q has one solution
        of each curve (1), the nearest to the start of all points 0.05 rad or m apart, and of all surfaces (2) one.
        """
        return dimensions_at(self.problem, self.x)

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
    """Find all distinct solutions of a target, and prove where possible that there are no others.

    Solutions that differ by whole turns count as one; the copy nearest to ``q0`` is given. Descents start from the
    branches of the closed form, if the arm has one, or, with six coordinates, from all its real and complex
    configurations, found by elimination and continuation. For other chains, and where some of these are missing, as in
    singularities, they start from sampled configurations, from random ones, and from known solutions with one joint
    turned by half a turn, until no new solution appears. Then, for chains of up to six coordinates, boxes of
    configurations are searched for missing solutions, unless the count of configurations has proved that none is
    missing.

    Args:
        chain: The joints to move and the frames to place.
        target: As for ``solve_ik``.
        q0: (nq,) configuration by whose distance the solutions are ordered; it also gives the values of joints outside
            the chain and of locked ones. Default: the chain's reference.
        limit: Number of solutions at which the search stops; on redundant chains this is what ends it.
        apart: Distinct solutions differ in some coordinate by more than this, rad or m.
        solver: Only its refiner is used, for the descents; default ``IKSolver()``.
        budget: Evaluations (and seconds, which are not reproducible) that may be spent.
        certify: Whether boxes may be used to prove that no solution is missing, which takes milliseconds.
        world: World in which nothing must collide: solutions that do are left out, but count towards ``limit``.
        rng: Seed or generator; ``None`` is a fixed seed.
        watch: Called between batches of descents with the evaluations spent and allowed; returning True ends the
            search.

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
    if limit >= ROOTS and budget.seconds is None and budget.evaluations >= ENOUGH + FOR_ROOTS and watch is None:
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
