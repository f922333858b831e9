"""Collisions on top of inverse kinematics: a result is checked, and searched on from when it collides."""

from __future__ import annotations

from dataclasses import replace
from time import perf_counter

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.collision import CollisionWorld
from pin_metaik.ik.clear import ClearSearch
from pin_metaik.ik.ledger import Ledger
from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.result import IKResult, IKStatus
from pin_metaik.ik.solver import FALLBACK, IKSolver
from pin_metaik.ik.starts import Rng
from pin_metaik.optimize import make


def keep_clear(
    first: IKResult, q0: ArrayLike | None, solver: IKSolver, world: CollisionWorld, rng: Rng
) -> IKResult:
    """The result itself where it is free of collisions in the world, else one that is, else the least deep one.

    What is not solved without the world is not solved in it. Where the robot's base or what else cannot move
    collides, no configuration is free and none is looked for.
    """
    began = perf_counter()
    problem = IKProblem.of(first.chain, first.target, world)
    checker = world.checker
    if not first.success or not checker.collides(first.q):
        return replace(first, world=world, seconds=first.seconds + perf_counter() - began)
    if checker.fixed:
        return _ended(first, first.q, first.evaluations, IKStatus.IN_COLLISION, problem, world, began)
    chain = first.chain
    base = chain.reference if q0 is None else chain.configuration(q0)
    ledger = Ledger(problem, solver.budget, began - first.seconds, first.x)
    ledger.spent = first.evaluations
    search = ClearSearch(problem, world, base, ledger, rng)
    seeder = FALLBACK if solver.seeder in (None, "auto") else solver.seeder
    free: NDArray[np.float64] | None = None
    try:
        free = search.run(first.x, make(seeder))
    except KeyboardInterrupt:
        ledger.interrupted = True
    if free is not None:
        x = chain.limits.nearest_turns(free, chain.x(base))
        return _ended(first, chain.q(x, base), ledger.spent, IKStatus.SOLVED, problem, world, began)
    status = ledger.status if ledger.interrupted else IKStatus.IN_COLLISION
    q = chain.q(search.least_deep(), base) if search.known else first.q
    return _ended(first, q, ledger.spent, status, problem, world, began)


def _ended(
    first: IKResult, q: NDArray[np.float64], spent: int, status: IKStatus, problem: IKProblem, world: CollisionWorld, began: float
) -> IKResult:
    verdict = problem.verdict(q)
    return replace(
        first,
        q=q,
        status=status,
        position_error=verdict.position_error,
        orientation_error=verdict.orientation_error,
        evaluations=spent,
        seconds=first.seconds + perf_counter() - began,
        world=world,
        contacts=() if status is IKStatus.SOLVED else world.checker.contacts(q),
    )
