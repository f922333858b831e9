"""Searches for a collision-free solution: the whole of ours, its parts one by one, and plain rejection."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import pin_metaik as mik
from pin_metaik.ik.clearance.qp import Push
from pin_metaik.ik.clearance.search import ClearSearch
from pin_metaik.ik.goals.pose import TargetLike
from pin_metaik.ik.state import SearchState
from pin_metaik.optimize import make


class Outcome(NamedTuple):
    """Whether a free solution was found, the configuration, and the kernel evaluations spent."""

    success: bool
    q: NDArray[np.float64]
    evaluations: int


Search = Callable[[mik.Chain, mik.CollisionWorld, TargetLike, int, int], Outcome]  # ..., evaluations, seed


def ours(chain: mik.Chain, world: mik.CollisionWorld, target: TargetLike, evaluations: int, seed: int) -> Outcome:
    solver = mik.IKSolver(budget=mik.Budget(evaluations=evaluations))
    result = mik.solve_ik(chain, target, world=world, solver=solver, rng=seed)
    return Outcome(result.success, result.q, result.evaluations)


def rejection(chain: mik.Chain, world: mik.CollisionWorld, target: TargetLike, evaluations: int, seed: int) -> Outcome:
    """Descend from uniformly random starts, one after the other, until a solution is free."""
    problem, descent, rng, spent = mik.IKProblem.of(chain, target, world), mik.DLS(), np.random.default_rng(seed), 0
    q = chain.reference
    while spent < evaluations:
        found = descent.refine(problem, chain.box.sample(rng, 1), evaluations - spent)
        spent += found.evaluations
        q = chain.q(found.x)
        if found.met and problem.accepts(q):
            return Outcome(True, q, spent)
    return Outcome(False, q, spent)


def others(chain: mik.Chain, world: mik.CollisionWorld, target: TargetLike, evaluations: int, seed: int) -> Outcome:
    search, x = _begun(chain, world, target, evaluations, seed)
    return _ended(search, x, search.others(search.starts()))


def push(chain: mik.Chain, world: mik.CollisionWorld, target: TargetLike, evaluations: int, seed: int) -> Outcome:
    search, x = _begun(chain, world, target, evaluations, seed)
    pushed = Push().refine(search.problem, world, x, chain.reference, evaluations)
    return Outcome(pushed.met, chain.q(pushed.x), pushed.evaluations)


def seeds(chain: mik.Chain, world: mik.CollisionWorld, target: TargetLike, evaluations: int, seed: int) -> Outcome:
    search, x = _begun(chain, world, target, 50_000, seed)
    return _ended(search, x, search.seed(make("mtde")))


def _begun(
    chain: mik.Chain, world: mik.CollisionWorld, target: TargetLike, evaluations: int, seed: int
) -> tuple[ClearSearch, NDArray[np.float64]]:
    problem = mik.IKProblem.of(chain, target, world)
    x = mik.solve_ik(chain, target).x
    state = SearchState(problem, mik.Budget(evaluations=evaluations), 0.0, x)
    return ClearSearch(problem, chain.reference, state, mik.DLS().descent(), seed), x


def _ended(search: ClearSearch, x: NDArray[np.float64], free: NDArray[np.float64] | None) -> Outcome:
    chain = search.problem.chain
    return Outcome(free is not None, chain.q(x if free is None else free), search.state.spent)


SEARCHES: dict[str, Search] = {
    "ours": ours,
    "rejection": rejection,
    "others": others,
    "push": push,
    "seeds": seeds,
}
