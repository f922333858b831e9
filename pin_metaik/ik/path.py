"""A sequence of poses with bounded joint steps, or the places where there is none.

Every pose gets a layer of solutions: those followed from the layer before it and after it, and some found afresh. The
best way through the layers is found by dynamic programming: the fewest breaks first, then the shortest way.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import array, checked, shown
from pin_metaik.collision import CollisionWorld
from pin_metaik.errors import InvalidSetting, InvalidTarget
from pin_metaik.ik.goals.pose import TargetLike
from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.proof import Proof
from pin_metaik.ik.solver import DEFAULT_SOLVER
from pin_metaik.ik.starts import drawn
from pin_metaik.kinematics import Chain
from pin_metaik.plain import fields_of
from pin_metaik.randomness import Rng
from pin_metaik.watching import Progress, Stopped, Watch, tell

WIDEST = 48  # solutions in a layer
FRESH = 24  # starts from the atlas and as many random ones for a layer of its own
APART = 1e-2  # rad or m between solutions of one layer
EVALUATIONS = 10_000  # for one layer, each way


@dataclass(frozen=True, eq=False)
class IKPath:
    """One configuration for each pose of a path.

    Attributes:
        q: (k, nq) configurations; angles run on through whole turns where limits allow.
        success: (k,) whether each pose is met, by Pinocchio.
        breaks: Numbers i of the poses that cannot be reached from pose i - 1 within the step bound.
        longest_step: Largest step of any joint between poses without a break, rad or m.
        seconds: Time taken, s.
        chain: The chain.
        interrupted: Whether a watch ended it before every pose was looked at.
    """

    q: NDArray[np.float64]
    success: NDArray[np.bool_]
    breaks: tuple[int, ...]
    longest_step: float
    seconds: float
    chain: Chain = field(repr=False)
    interrupted: bool = False

    @property
    def continuous(self) -> bool:
        """Whether every pose is met and no step is longer than the bound."""
        return bool(self.success.all()) and not self.breaks

    def __bool__(self) -> bool:
        """Whether it is continuous."""
        return self.continuous

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON: lengths in m, angles in rad."""
        return fields_of(self, "q", "success", "continuous", "breaks", "longest_step", "interrupted", "seconds")

    @property
    def x(self) -> NDArray[np.float64]:
        """(k, n) the chain's coordinates; those of continuous joints run on through whole turns."""
        x = self.chain.x(self.q)
        periodic = self.chain.limits.periodic
        x[:, periodic] = np.unwrap(x[:, periodic], axis=0)
        return x


@checked
def solve_ik_path(
    chain: Chain,
    targets: Sequence[TargetLike] | NDArray[np.float64],
    q0: ArrayLike | None = None,
    *,
    max_step: float | ArrayLike = 0.2,
    world: CollisionWorld | None = None,
    rng: Rng = None,
    watch: Watch | None = None,
) -> IKPath:
    """Follow a sequence of poses without jumps.

    Args:
        chain: The joints to move and the frame to place.
        targets: k targets, as for ``solve_ik``; close enough to each other for the step bound.
        q0: (nq,) configuration the path should start near, with the joints outside the chain and the locked ones where
            they stay; default: wherever the path as a whole is best, from the chain's reference.
        max_step: Largest step of a joint from one pose to the next, rad or m: one number, or (n,) one a joint.
        world: What must not collide at any of the poses; the steps between them are not looked at.
        rng: Seed or generator; ``None`` is a fixed seed.
        watch: Called with poses done and in all; True ends the path: the poses that follow are not met.

    Returns:
        The path. Where it is not continuous, ``breaks`` and ``success`` say where: nothing jumps silently.

    Raises:
        InvalidTarget: If there are no targets, or one of them is none.
        InvalidSetting: If ``max_step`` is not above zero, or the world is another model's than the chain.
        InvalidConfiguration: If ``q0`` is not a configuration of the model.
    """
    began = perf_counter()
    if isinstance(targets, str) or not (isinstance(targets, Sequence) or np.ndim(targets)):
        raise InvalidTarget(f"targets are a list of poses or positions, got {shown(targets)}")
    if len(targets) == 0:
        raise InvalidTarget("a path has at least one target")
    given = array("max_step", max_step, "...", finite=False)
    bound = np.full(chain.n, given) if given.ndim == 0 else array("max_step", given, chain.n, finite=False)
    if not (bound > 0.0).all():
        raise InvalidSetting(f"max_step is above 0, got {bound}")
    chain = chain if q0 is None else chain.at(q0)
    base = chain.reference if q0 is None else chain.configuration(q0)
    problems = [IKProblem.of(chain, target, world).at(base) for target in targets]
    layers: list[NDArray[np.float64]] = []
    interrupted = False
    try:
        _add_layers(layers, problems, base, q0 is not None, rng, watch)
    except Stopped:
        layers += [np.empty((0, chain.n))] * (len(problems) - len(layers))
        interrupted = True
    x, breaks = _best_way(chain, layers, bound, None if q0 is None else chain.x(base))
    q = chain.q(x, base)
    success = np.array([problem.accepts(one) for problem, one in zip(problems, q, strict=True)])
    steps = np.abs(chain.limits.way(x[:-1], x[1:])).max(axis=1, initial=0.0)
    steps[[i - 1 for i in breaks]] = 0.0
    return IKPath(q, success, tuple(breaks), float(steps.max(initial=0.0)), perf_counter() - began, chain, interrupted)


def _add_layers(
    layers: list[NDArray[np.float64]],
    problems: list[IKProblem],
    base: NDArray[np.float64],
    near: bool,
    rng: Rng,
    watch: Watch | None,
) -> None:
    """Add solutions (s, n) of every pose, the joints off the chain being as in base (nq,); empty where none was found.

    Raises:
        Stopped: The watch says so; the layers are those so far.
    """
    x0 = problems[0].chain.x(base)
    followed = x0[None] if near else np.empty((0, len(x0)))
    for index, problem in enumerate(problems):
        if index:
            tell(watch, Progress(index, len(problems)))
        if problem.refuted not in (None, Proof.LIMITS):
            layers.append(np.empty((0, len(x0))))
            continue
        fresh = problem.branches(followed[0] if len(followed) else x0)
        if not len(fresh):
            fresh = np.concatenate([problem.near(FRESH), drawn(problem.chain, rng, index, FRESH)])
        layer = _widened(problem, base, np.empty((0, len(x0))), followed, followed=True)
        layer = _widened(problem, base, layer, fresh)
        if not len(layer):  # nothing in the middle of the tolerances
            layer = _widened(problem.whole, base, _widened(problem.whole, base, layer, followed, followed=True), fresh)
        layers.append(layer)
        followed = layer if len(layer) else followed
    for i in range(len(problems) - 2, -1, -1):  # what only a later pose found may have begun earlier
        layers[i] = _widened(problems[i], base, layers[i], layers[i + 1], followed=True)
    if watch is not None:
        watch(Progress(len(problems), len(problems)))  # there is nothing left to end


def _widened(
    problem: IKProblem,
    base: NDArray[np.float64],
    layer: NDArray[np.float64],
    starts: NDArray[np.float64],
    followed: bool = False,
) -> NDArray[np.float64]:
    """A layer with the solutions that these starts lead to; those found afresh must leave room for followed ones.

    In a world only what is free of collisions is added.
    """
    room = WIDEST if followed else WIDEST // 2
    if len(layer) >= room or not len(starts):
        return layer
    found = np.empty((room, problem.chain.n))
    found[: len(layer)] = layer
    gather = DEFAULT_SOLVER.descent.gather
    _, known, _ = gather(problem, starts, found, len(layer), APART, len(starts) + 1, EVALUATIONS, branch=False)
    if problem.world is not None:
        clear = [problem.accepts(q) for q in problem.chain.q(found[len(layer) : known], base)]
        return np.concatenate([layer, found[len(layer) : known][clear]])
    return found[:known]


def _best_way(
    chain: Chain, layers: list[NDArray[np.float64]], bound: NDArray[np.float64], x0: NDArray[np.float64] | None
) -> tuple[NDArray[np.float64], list[int]]:
    """Coordinates (k, n) with the fewest breaks, then the shortest way, and the poses that a break comes before.

    A pose without a solution keeps the joints where the pose before it had them.
    """
    jump = 1e6  # more than any path costs
    here = layers[0]
    costs = np.zeros(len(here)) if x0 is None else np.linalg.norm(chain.limits.way(x0, here), axis=1)
    trail: list[tuple[int, NDArray[np.int64]]] = [(0, np.zeros(0, np.int64))] if len(here) else []
    for i in range(1, len(layers)):
        if not len(layers[i]):
            continue
        if not len(here):
            here, costs = layers[i], np.zeros(len(layers[i]))
            trail.append((i, np.zeros(0, np.int64)))
            continue
        step = chain.limits.way(here[:, None], layers[i][None])  # (a, b, n)
        broken = (np.abs(step) > bound).any(axis=2)
        total = costs[:, None] + np.linalg.norm(step, axis=2) + jump * broken
        before = total.argmin(axis=0)
        here, costs = layers[i], total[before, np.arange(len(layers[i]))]
        trail.append((i, before))
    return _traced(chain, layers, bound, trail, costs, x0)


def _traced(
    chain: Chain,
    layers: list[NDArray[np.float64]],
    bound: NDArray[np.float64],
    trail: list[tuple[int, NDArray[np.int64]]],
    costs: NDArray[np.float64],
    x0: NDArray[np.float64] | None,
) -> tuple[NDArray[np.float64], list[int]]:
    """The way back from the cheapest end."""
    x = np.empty((len(layers), chain.n))
    solved = {}
    at = int(costs.argmin()) if trail else 0
    for i, before in reversed(trail):
        solved[i] = layers[i][at]
        at = int(before[at]) if len(before) else 0
    last = chain.limits.clip(chain.x(chain.reference)) if x0 is None else x0
    last = solved[min(solved)] if solved else last
    for i in range(len(layers)):
        last = x[i] = solved.get(i, last)
    steps = chain.limits.way(x[:-1], x[1:])
    return x, [int(i) + 1 for i in np.flatnonzero((np.abs(steps) > bound).any(axis=1))]
