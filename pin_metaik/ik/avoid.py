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
from pin_metaik.ik.proof import Proof
from pin_metaik.ik.result import IKResult, IKStatus
from pin_metaik.ik.solver import FALLBACK, IKSolver
from pin_metaik.optimize import make
from pin_metaik.randomness import Rng

LEVER = 2.0  # m; how far from its frame what a frame holds may reach, generously
HELD = 0.01  # m; looser targets do not hold their frame


def keep_clear(first: IKResult, q0: ArrayLike | None, solver: IKSolver, world: CollisionWorld, rng: Rng) -> IKResult:
    """The result itself where it is free of collisions in the world, else one that is, else the least deep one.

    What is not solved without the world is not solved in it. Where what collides cannot move, or is held where it is by
    the target, no configuration is free and none is looked for.
    """
    began = perf_counter()
    problem = IKProblem.of(first.chain, first.target, world)
    met = first.status in (IKStatus.SOLVED, IKStatus.IN_COLLISION)
    if not met or not world.checker.collides(first.q):
        return replace(first, world=world, seconds=first.seconds + perf_counter() - began)
    chain = first.chain
    base = chain.reference if q0 is None else chain.configuration(q0)
    ledger = Ledger(problem, solver.budget, began - first.seconds, first.x)
    ledger.spent = first.evaluations
    search = ClearSearch(problem.whole if problem.loose else problem, world, base, ledger, rng)
    free: NDArray[np.float64] | None = None
    if _hopeless(problem, world, first.q):
        search.proof = Proof.CONTACT
    else:
        free = search.run(first.x, make(FALLBACK if solver.seeder in (None, "auto") else solver.seeder))
    if free is not None:
        q, status = chain.q(chain.limits.nearest_turns(free, chain.x(base)), base), IKStatus.SOLVED
    else:
        q = chain.q(search.least_deep(), base) if search.known else first.q
        status = IKStatus.STOPPED if ledger.late() else IKStatus.IN_COLLISION
    verdict = problem.verdict(q)
    return replace(
        first,
        q=q,
        status=status,
        position_error=verdict.position_error,
        orientation_error=verdict.orientation_error,
        evaluations=ledger.spent,
        seconds=first.seconds + perf_counter() - began,
        world=world,
        contacts=world.checker.contacts(q) if verdict.collides else (),
        proof=search.proof if verdict.collides else None,
        resolution=search.resolution if verdict.collides else None,
    )


def _hopeless(problem: IKProblem, world: CollisionWorld, q: NDArray[np.float64]) -> bool:
    """Whether every solution collides as this one, q (nq,), does: two bodies that stand, or that the target holds.

    A body stands when none of the chain's joints moves it. A frame with a whole pose for a target holds every body that
    none of them moves against it, to within the tolerances.
    """
    checker, chain = world.checker, problem.chain
    if checker.fixed or chain.limits.rigid:
        return True
    model = chain.model
    moved_by = [chain.movers.intersection(supports) for supports in model.supports]
    slacks = {0: 0.0}  # of a joint that is held like this one, m
    for frame, target in zip(chain.frame_ids, problem.targets, strict=True):
        slack = sum(target.allowance) * LEVER
        if all(target.counts) and slack < HELD:
            slacks[int(model.frames[frame].parentJoint)] = slack
    held = {j: slack for like, slack in slacks.items() for j in range(model.njoints) if moved_by[j] == moved_by[like]}
    return any(contact.depth > held[a] + held[b] for contact, (a, b) in checker.contacts_of(q, held))
