"""Collisions on top of inverse kinematics: a result is checked, and the search goes on when it collides."""

from __future__ import annotations

from dataclasses import replace
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from pin_metaik.collision import CollisionWorld
from pin_metaik.ik.clearance.search import ClearSearch
from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.proof import Proof
from pin_metaik.ik.refine.descent import Descent
from pin_metaik.ik.result import IKResult, IKStatus
from pin_metaik.ik.state import SearchState
from pin_metaik.optimize import Budget, Metaheuristic
from pin_metaik.randomness import Rng

LEVER = 2.0  # m, bound of the lever arms of bodies attached to a frame
HELD = 0.01  # m; a frame with a looser target is not taken to be fixed by it


def keep_clear(
    first: IKResult,
    problem: IKProblem,
    base: NDArray[np.float64],
    *,
    descent: Descent,
    seeder: Metaheuristic,
    budget: Budget,
    rng: Rng,
) -> IKResult:
    """Return ``first`` if it is free of collisions; otherwise search for a solution that is.

    Without one the result is the solution with the smallest penetration. No search is made if the target is not met
    without the world, or if the colliding bodies are fixed, or attached to a frame whose whole pose is given.

    Args:
        first: What was found without regard to collisions, or among what is free of them.
        problem: The problem with its world.
        base: (nq,) configuration that has the joints that the chain does not move.
        descent: How solutions are reached.
        seeder: A metaheuristic, for points that are near the target and not deep in collision.
        budget: Of ``first`` and of this search together.
        rng: Seed or generator.
    """
    began, world, chain = perf_counter(), problem.world, problem.chain
    assert world is not None
    met = first.status in (IKStatus.SOLVED, IKStatus.IN_COLLISION)
    if not met or not world.checker.collides(first.q):
        return replace(first, world=world, seconds=first.seconds + perf_counter() - began)
    state = SearchState(problem, budget, began - first.seconds, first.x)
    state.spent = first.evaluations
    search = ClearSearch(problem.whole if problem.loose else problem, base, state, descent, rng)
    free: NDArray[np.float64] | None = None
    if _hopeless(problem, world, first.q):
        search.proof = Proof.CONTACT
    else:
        free = search.run(first.x, seeder)
    if free is not None:
        q, status = chain.q(problem.nearest_turns(free[None], chain.x(base))[0], base), IKStatus.SOLVED
    else:
        q = chain.q(search.least_deep(), base) if search.known else first.q
        status = IKStatus.STOPPED if state.late() else IKStatus.IN_COLLISION
    verdict = problem.verdict(q)
    return replace(
        first,
        q=q,
        status=status,
        position_error=verdict.position_error,
        orientation_error=verdict.orientation_error,
        evaluations=state.spent,
        seconds=first.seconds + perf_counter() - began,
        world=world,
        contacts=world.checker.contacts(q) if verdict.collides else (),
        proof=search.proof if verdict.collides else None,
        resolution=search.resolution if verdict.collides else None,
    )


def _hopeless(problem: IKProblem, world: CollisionWorld, q: NDArray[np.float64]) -> bool:
    """Whether the collision at q (nq,) is common to all solutions: of two bodies that are fixed, or held by a target.

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
