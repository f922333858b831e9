"""All solutions of many targets, on all cores."""

from __future__ import annotations

import os
from collections.abc import Sequence
from contextlib import suppress

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import checked
from pin_metaik.collision import CollisionWorld
from pin_metaik.errors import InvalidTarget
from pin_metaik.ik.problem import Asked, IKProblem, check_targets, check_world
from pin_metaik.ik.solutions import DEFAULT_BUDGET, IKSolutions, solve_ik_all
from pin_metaik.ik.solver import APART, IKSolver
from pin_metaik.ik.threads import run_parallel
from pin_metaik.kinematics import Chain
from pin_metaik.optimize import Budget
from pin_metaik.optimize.settings import whole
from pin_metaik.randomness import Rng, as_seed
from pin_metaik.watching import Count, Stopped, Watch


@checked
def solve_ik_all_batch(
    chain: Chain,
    targets: Sequence[Asked] | NDArray[np.float64],
    q0: ArrayLike | None = None,
    *,
    limit: int = 64,
    apart: float = APART,
    solver: IKSolver | None = None,
    budget: Budget = DEFAULT_BUDGET,
    certify: bool = True,
    world: CollisionWorld | None = None,
    workers: int | None = None,
    rng: Rng = None,
    watch: Watch | None = None,
) -> tuple[IKSolutions, ...]:
    """Find all solutions of many targets, each as by ``solve_ik_all``; see there for the arguments and errors.

    Args:
        chain: The joints to move and the frames to place.
        targets: Poses (k, 4, 4) or positions (k, 3), or a list of any targets.
        q0: (nq,) configuration by whose distance the solutions of each target are ordered.
        limit: See ``solve_ik_all``.
        apart: rad or m; see ``solve_ik_all``.
        solver: See ``solve_ik_all``.
        budget: For each target.
        certify: See ``solve_ik_all``.
        world: What must not collide.
        workers: Threads; default: one a core. The solutions do not depend on it.
        rng: Seed or generator; ``None`` is a fixed seed. A generator gives the whole batch one seed.
        watch: Called with targets done and in all, from any of the threads, one at a time; True ends the batch: targets
            that were not done by then have no solutions, and are ``interrupted``.

    Returns:
        The solutions of each target, in their order.

    Raises:
        InvalidTarget: If there are no targets, or one of them is not valid; the message has its number.
        InvalidSetting: If ``workers`` is less than one, or as ``solve_ik_all`` says.
    """
    check_targets(targets, "there are no targets: give at least one")
    if workers is not None:
        whole("workers", workers, 1)
    check_world(chain, world)
    seed, k = as_seed(rng), len(targets)
    found: list[IKSolutions | None] = [None] * k
    count = Count(watch, k)

    def one(i: int) -> None:
        try:
            found[i] = solve_ik_all(
                chain, targets[i], q0, limit=limit, apart=apart, solver=solver, budget=budget,
                certify=certify, world=world, rng=seed,
            )  # fmt: skip
        except InvalidTarget as error:
            raise InvalidTarget(f"target {i}: {error}") from None
        count.add(1)

    with suppress(Stopped):
        run_parallel(one, range(k), min(workers or os.cpu_count() or 1, k))
    here = chain if q0 is None else chain.at(q0)
    nothing = np.empty((0, chain.model.nq))
    return tuple(
        IKSolutions(nothing, None, 0, 0.0, here, IKProblem.of(here, targets[i], world), world, True)
        if solutions is None
        else solutions
        for i, solutions in enumerate(found)
    )
