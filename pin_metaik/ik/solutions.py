"""All solutions of one target: the set a choice is made from."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import count
from time import perf_counter

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import checked
from pin_metaik.collision import CollisionWorld
from pin_metaik.errors import InvalidBudget
from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.refine.dls import DLS, PROGRESS
from pin_metaik.ik.starts import drawn
from pin_metaik.ik.target import TargetLike
from pin_metaik.kinematics import Chain
from pin_metaik.optimize import Budget
from pin_metaik.optimize.settings import few, positive
from pin_metaik.randomness import Rng

BRANCHLESS = 1000
BATCH = 128  # starts between two looks at what came of them
VAIN = 60  # starts in a row that led to nothing new ...
VAIN_EACH = 15  # ... and as many more for each solution known, before the set counts as complete
MIDDLE = 5000  # evaluations for a solution in the middle of loose tolerances before all of them is aimed at
ROOM = 0.1  # of the distance between distinct solutions: tolerances that may move a solution so far
SETTINGS = DLS()
DEFAULT_BUDGET = Budget(evaluations=200_000)


@dataclass(frozen=True, eq=False)
class IKSolutions:
    """Distinct solutions of one problem, the nearest to the start first.

    Attributes:
        q: (s, nq) configurations, each judged by Pinocchio, and in a world by coal.
        complete: Whether the search ended because nothing new appeared. A chain with more joints than its target needs
            has endlessly many solutions, and so has one whose tolerances leave room for more than one answer: then this
            is a sample, and False.
        evaluations: Forward kinematics computed.
        seconds: Time taken, s.
        problem: What was asked; out of a pickle, without its world, which has all meshes in it.
    """

    q: NDArray[np.float64]
    complete: bool
    evaluations: int
    seconds: float
    problem: IKProblem = field(repr=False)

    def __getstate__(self) -> dict[str, object]:
        """Pickle without the world: kilobytes rather than megabytes."""
        return {**self.__dict__, "problem": replace(self.problem, world=None)}

    @property
    def x(self) -> NDArray[np.float64]:
        """(s, n) the chain's coordinates."""
        return self.problem.chain.x(self.q)

    def __len__(self) -> int:
        return len(self.q)

    def __iter__(self) -> Iterator[NDArray[np.float64]]:
        return iter(self.q)


@checked
def solve_ik_all(
    chain: Chain,
    target: TargetLike | Sequence[TargetLike],
    q0: ArrayLike | None = None,
    *,
    limit: int = 64,
    apart: float = 1e-2,
    budget: Budget = DEFAULT_BUDGET,
    world: CollisionWorld | None = None,
    rng: Rng = None,
) -> IKSolutions:
    """Find all distinct solutions of a target, until no new one appears.

    Solutions that differ by whole turns count as one and come as the copy nearest to ``q0``. Descents start from what a
    closed form says, if the arm has one; otherwise, and in singularities, from an atlas of the chain, from random
    configurations, and from the solutions known with one joint turned half round.

    Args:
        chain: The joints to move and the frames to place.
        target: As for ``solve_ik``.
        q0: (nq,) configuration the solutions are ordered by, and that has the joints outside the chain and the locked
            ones; default: the chain's reference.
        limit: Solutions to stop at; what ends the search on redundant chains.
        apart: rad or m by which some coordinate of two solutions must differ.
        budget: Evaluations (and seconds, which are not reproducible) that may be spent.
        world: What must not collide: solutions that do are left out, after they have counted towards the limit.
        rng: Seed or generator; ``None`` is a fixed seed.

    Raises:
        InvalidTarget: If the target is not a pose, position or orientation.
        InvalidConfiguration: If ``q0`` is not a configuration of the model.
        InvalidSetting: If ``limit`` or ``apart`` is not above zero, or the world is another model's than the chain.
        InvalidBudget: If the budget has no limit on evaluations.
    """
    few("limit", limit)
    positive("apart", apart)
    if budget.evaluations is None:
        raise InvalidBudget("collecting solutions needs a budget of evaluations: Budget(evaluations=...)")
    began = perf_counter()
    chain = chain if q0 is None else chain.at(q0)
    problem = IKProblem.of(chain, target, world)
    base = chain.reference if q0 is None else chain.configuration(q0)
    x0 = chain.x(base)
    _, found, complete, spent = collect(problem, x0, rng, limit=limit, apart=apart, budget=budget)
    found = chain.limits.nearest_turns(found, x0)
    found = found[np.argsort(np.linalg.norm(found - x0, axis=1), kind="stable")]
    q = chain.q(found, base)
    judged = np.array([problem.accepts(one) for one in q], dtype=bool)
    return IKSolutions(q[judged], complete, spent, perf_counter() - began, problem)


def collect(
    problem: IKProblem,
    x0: NDArray[np.float64],
    rng: Rng,
    *,
    limit: int,
    apart: float,
    budget: Budget,
) -> tuple[IKProblem, NDArray[np.float64], bool, int]:
    """Distinct solutions (s, n), whether the set is complete, and the evaluations spent.

    They are in the middle of the tolerances; if nothing is, anywhere in them, which is returned as the problem first.
    """
    total = budget.evaluations or 0
    in_vain = (
        MIDDLE
        if problem.loose
        else BRANCHLESS
        if problem.form_branches is not None and problem.form_branches.proved
        else total - total // 10
    )
    found, complete, spent = _collect(problem, x0, rng, limit, apart, budget, in_vain)
    if len(found) or spent >= total or problem.gap > 0.0 or problem.limits.rigid:
        return problem, found, complete and not _roomy(problem, apart), spent
    rest = replace(budget, evaluations=total - spent)
    found, _, more = _collect(problem.whole, x0, rng, limit, apart, rest, in_vain)
    return problem.whole, found, False, spent + more


def _roomy(problem: IKProblem, apart: float) -> bool:
    """Whether the tolerances leave room for solutions that are as far apart as distinct ones: then there is no end."""
    slack = problem.whole.tasks[:, 12:18]
    return bool((np.abs(slack[np.isfinite(slack)]) > ROOM * apart).any())


def _collect(
    problem: IKProblem,
    x0: NDArray[np.float64],
    rng: Rng,
    limit: int,
    apart: float,
    budget: Budget,
    in_vain: int,
) -> tuple[NDArray[np.float64], bool, int]:
    """The same where the problem aims; given up when so many evaluations found nothing."""
    began = perf_counter()
    found = np.empty((limit, problem.chain.n))
    total = budget.evaluations or 0
    known, complete, spent = _by_closed_form(problem, x0, found, apart, total)
    if complete:
        return found[:known], True, spent
    vain, unreachable = 0, problem.gap > 0.0 or problem.limits.rigid
    for index in count():
        starts = drawn(problem.chain, rng, index, BATCH)
        if index == 0:
            starts = np.concatenate([x0[None], problem.near(BATCH), starts])
        evaluations, more, row = gather(
            problem, starts, found, known, apart, VAIN + VAIN_EACH * known - vain, total - spent
        )
        vain = vain + row if more == known else row
        known, spent = more, spent + evaluations
        enough = VAIN + VAIN_EACH * known
        late = budget.seconds is not None and perf_counter() - began >= budget.seconds
        hopeless = known == 0 and (unreachable or spent >= in_vain)
        if known == limit or spent >= total or late or vain >= enough or hopeless:
            return found[:known], known < limit and vain >= enough, spent
    raise AssertionError("count() does not end")


def _by_closed_form(
    problem: IKProblem, x0: NDArray[np.float64], found: NDArray[np.float64], apart: float, evaluations: int
) -> tuple[int, bool, int]:
    """Descend from the branches of the arm's closed form: solutions, whether these are all, and evaluations.

    In a singularity a joint that does not matter stays where it is: from somewhere else there are others.
    """
    known = spent = before = 0
    elsewhere = np.where(x0 + 1.0 < problem.limits.upper, x0 + 1.0, x0 - 1.0)
    for x in (x0, problem.limits.clip(elsewhere)):
        starts, before = problem.branches(x), known
        taken, known, _ = gather(
            problem, starts, found, known, apart, len(starts) + 1, evaluations - spent, branch=False
        )
        spent += taken
    return known, 0 < known == before < len(found) and spent < evaluations, spent


def gather(
    problem: IKProblem,
    starts: NDArray[np.float64],
    found: NDArray[np.float64],
    known: int,
    apart: float,
    patience: int,
    evaluations: int,
    *,
    branch: bool = True,
) -> tuple[int, int, int]:
    """Descend from each start (s, n) and add what is new to ``found``, of which ``known`` rows are taken.

    Returns evaluations, rows taken, and how many starts in a row led to nothing new at the end.
    """
    chain = problem.chain
    result: tuple[int, int, int] = chain.kernels.descend_all(
        *chain.paths.arrays,
        problem.tasks,
        problem.descended,
        *chain.limits.arrays,
        np.ascontiguousarray(starts),
        apart,
        patience,
        branch,
        SETTINGS.damping,
        PROGRESS,
        SETTINGS.iterations,
        evaluations,
        found,
        known,
    )
    return result
