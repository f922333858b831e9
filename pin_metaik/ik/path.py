"""One configuration for each of a sequence of poses, with bounded joint steps; where that is impossible, and why.

Every pose gets a layer of solutions, and the best way through the layers is found. Where that has breaks, layers of
poses that leave a choice are widened first: to other targets within their tolerances, and a little along self-motions.
Where that does not do, whole self-motions are traced, and followed to the poses around.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import array, checked
from pin_metaik.collision import CollisionWorld
from pin_metaik.errors import InvalidSetting
from pin_metaik.ik.breaks import BreakReason, PathBreak, Reconfiguration
from pin_metaik.ik.labels import labels_of, signs_of
from pin_metaik.ik.layers import Layers
from pin_metaik.ik.problem import Asked, IKProblem, check_targets
from pin_metaik.ik.solver import IKSolver
from pin_metaik.ik.ways import Way, Ways
from pin_metaik.kinematics import Chain
from pin_metaik.plain import fields_of
from pin_metaik.planning import installed, plan_joint_move
from pin_metaik.randomness import Rng
from pin_metaik.timing import TimedPath, time_path
from pin_metaik.timing.limits import Share
from pin_metaik.watching import Stopped, Watch


@dataclass(frozen=True, eq=False)
class IKPath:
    """One configuration for each pose of a path.

    Attributes:
        q: (k, nq) configurations; angles run on through whole turns where limits allow.
        success: (k,) whether each pose is met, by Pinocchio's forward kinematics.
        breaks: Numbers i of the poses that cannot be reached from pose i - 1: not within the step bound, or in a world
            not by a straight joint move that is proved free of collisions.
        longest_step: Largest step of any joint between poses without a break, rad or m.
        seconds: Time taken, s.
        chain: The chain.
        interrupted: Whether a watch ended it before every pose was looked at.
        reasons: One for each pose that is not met and for each break, with the reason: see ``PathBreak``.
        moves: With ``reconfigure``, for each break i at which one was found: a joint move (p, nq) from pose i - 1 to
            pose i. Its straight parts stay inside the limits and are proved free of collisions in the world.
        labels: The branch of each pose that is met, named as in ``IKSolutions.labels``; an empty string for a pose that
            is not met, and where the solutions form a continuum.
    """

    q: NDArray[np.float64]
    success: NDArray[np.bool_]
    breaks: tuple[int, ...]
    longest_step: float
    seconds: float
    chain: Chain = field(repr=False)
    interrupted: bool = False
    reasons: tuple[PathBreak, ...] = ()
    moves: dict[int, NDArray[np.float64]] = field(default_factory=dict, repr=False)
    labels: tuple[str, ...] = field(default=(), repr=False)

    @property
    def reconfigurations(self) -> tuple[Reconfiguration, ...]:
        """Where the path changes its branch: at a break, or by passing a singularity between two poses."""
        met = np.flatnonzero(self.success).tolist()
        steps = [(a, b) for a, b in pairwise(met) if "" != self.labels[a] != self.labels[b] != ""]
        return tuple(Reconfiguration(b, self.labels[a], self.labels[b]) for a, b in steps)

    @property
    def continuous(self) -> bool:
        """Whether every pose is met and no step is longer than the bound."""
        return bool(self.success.all()) and not self.breaks

    def __bool__(self) -> bool:
        """Whether it is continuous."""
        return self.continuous

    @property
    def passable(self) -> bool:
        """Whether every pose is met, and ``moves`` has a joint move for every break."""
        return bool(self.success.all()) and set(self.breaks) <= self.moves.keys()

    @property
    def why(self) -> str:
        """What is wrong, in words, one line for each pose or break; empty for a continuous path."""
        return "\n".join(map(str, self.reasons))

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON: lengths in m, angles in rad."""
        names = ("q", "success", "continuous", "passable", "breaks", "longest_step", "interrupted", "seconds", "moves")
        changes = [change.as_dict() for change in self.reconfigurations]
        reasons = [reason.as_dict() for reason in self.reasons]
        return {**fields_of(self, *names), "reconfigurations": changes, "reasons": reasons}

    @property
    def x(self) -> NDArray[np.float64]:
        """(k, n) the chain's coordinates; those of continuous joints run on through whole turns."""
        return self.chain.unwrapped(self.q)

    def timed(self, *, velocity: Share = None, acceleration: Share = None, jerk: Share = None) -> TimedPath:
        """The path as a motion over time that is within the joints' limits at every instant; see ``timing.time_path``.

        Args:
            velocity: rad/s or m/s, one number or (n,) one a joint; default: the model's.
            acceleration: rad/s^2 or m/s^2; default: full speed within 0.2 s.
            jerk: rad/s^3 or m/s^3; default: not limited.

        Raises:
            InvalidSetting: If the path is not continuous; see ``timing.time_path``.
            MissingExtra: toppra (without jerk) or ruckig (with) is not installed.
        """
        if not self.continuous:
            missed = np.flatnonzero(~self.success).tolist()
            raise InvalidSetting(
                "only a continuous path can be timed; this one "
                + (f"does not meet pose {missed[0]}" if missed else f"jumps before pose {self.breaks[0]}")
            )
        return time_path(self.chain, self.q, velocity=velocity, acceleration=acceleration, jerk=jerk)


@checked
def solve_ik_path(
    chain: Chain,
    targets: Sequence[Asked] | NDArray[np.float64],
    q0: ArrayLike | None = None,
    *,
    max_step: float | ArrayLike = 0.2,
    solver: IKSolver | None = None,
    world: CollisionWorld | None = None,
    reconfigure: bool = False,
    rng: Rng = None,
    watch: Watch | None = None,
) -> IKPath:
    """Follow a sequence of poses without jumps, in a world without collisions at the poses and between them.

    The path aims at the middle of the tolerances. Only where it would break are other poses within the tolerances tried
    and, for a chain with more joints than the target needs, solutions along its self-motions. With one joint more than
    needed, or one free axis, all self-motions of the poses at the break are used (in a world, all their intervals that
    are free of collisions).

    Args:
        chain: The joints to move and the frame to place.
        targets: k targets, as for ``solve_ik``; close enough to each other for the step bound.
        q0: (nq,) configuration the path should start near, with the joints outside the chain and the locked ones where
            they stay; default: wherever the path as a whole is best, from the chain's reference.
        max_step: Largest step of a joint from one pose to the next, rad or m: one number, or (n,) with one for each
            joint.
        solver: Its refiner finds the solutions of each pose, with its budget of evaluations for each; where the refiner
            finds none, the solver searches for one. Its ``select`` is not used: of the solutions of each pose, those
            are taken that make the best path through all poses: with the fewest breaks, then the fewest changes of
            branch, then the shortest. Default: damped least squares, 10,000 evaluations a pose.
        world: What must not collide at any of the poses and on the straight joint moves between them, which is proved
            (``CollisionWorld.clear_between``).
        reconfigure: Whether to look, where the path breaks, for a joint move to the next pose: the straight one if it
            is free of collisions, otherwise, if OMPL is installed, a planned one. They are in ``IKPath.moves``.
        rng: Seed or generator; ``None`` is a fixed seed.
        watch: Called with the number of poses done and of all poses; returning True ends the work, and the remaining
            poses are not met.

    Returns:
        The path. Where it is not continuous, ``breaks`` and ``success`` say where and ``reasons`` why.

    Raises:
        InvalidTarget: If there are no targets, or one of them is not valid.
        InvalidSetting: If ``max_step`` is not above zero, or the world is another model's than the chain.
        InvalidConfiguration: If ``q0`` is not a configuration of the model.
    """
    began = perf_counter()
    check_targets(targets, "a path has at least one target")
    given = array("max_step", max_step, "...", finite=False)
    bound = np.full(chain.n, given) if given.ndim == 0 else array("max_step", given, chain.n, finite=False)
    if not (bound > 0.0).all():
        raise InvalidSetting(f"max_step is above 0, got {bound}")
    chain = chain if q0 is None else chain.at(q0)
    base = chain.reference if q0 is None else chain.configuration(q0)
    problems = [IKProblem.of(chain, target, world).at(base) for target in targets]
    layers = Layers(problems, base, bound, solver, rng)
    x0 = None if q0 is None else chain.x(base)
    interrupted = False
    ways = Ways(chain, layers.found, bound, x0, base, world, reconfigure, lambda i, X: signs_of(problems[i], X))
    way = Way({}, (), ())
    try:
        layers.fill(q0 is not None, watch)
        way = ways.best()
        for more in (layers.widen, layers.trace):
            if (way.breaks or len(way.rows) < len(problems)) and layers.flexible:
                more(way.breaks, watch)
                way = min(way, replace(ways).best(), key=lambda one: (-len(one.rows), len(one.breaks)))
    except Stopped:
        interrupted = True
        way = way if way.rows else ways.best()
    x = _coordinates(chain, layers.found, way, x0)
    q = chain.q(x, base)
    success = np.array([problem.accepts(one) for problem, one in zip(problems, q, strict=True)])
    steps = chain.limits.way(x[:-1], x[1:])  # (k - 1, n)
    reasons = tuple(_reasons(layers, way, success, steps, q, interrupted))
    moves = _moves(chain, way, q, world, rng) if reconfigure else {}
    steps[[i - 1 for i in way.breaks]] = 0.0
    longest = float(np.abs(steps).max(initial=0.0))
    labels = tuple(
        "".join(labels_of(problem, one[None])) if met else ""
        for problem, one, met in zip(problems, x, success, strict=True)
    )
    return IKPath(q, success, way.breaks, longest, perf_counter() - began, chain, interrupted, reasons, moves, labels)


def _coordinates(
    chain: Chain, layers: list[NDArray[np.float64]], way: Way, x0: NDArray[np.float64] | None
) -> NDArray[np.float64]:
    """Coordinates (k, n) along a way; a pose without a solution keeps the joints where the pose before it had them."""
    x = np.empty((len(layers), chain.n))
    last = chain.limits.clip(chain.x(chain.reference)) if x0 is None else x0
    last = layers[min(way.rows)][way.rows[min(way.rows)]] if way.rows else last
    for i, layer in enumerate(layers):
        last = x[i] = layer[way.rows[i]] if i in way.rows else last
    return x


def _reasons(
    layers: Layers,
    way: Way,
    success: NDArray[np.bool_],
    steps: NDArray[np.float64],
    q: NDArray[np.float64],
    interrupted: bool,
) -> Iterator[PathBreak]:
    """Why poses are not met, and why there are breaks, in their order."""
    world, base = layers.problems[0].world, layers.base
    for i, problem in enumerate(layers.problems):
        if not success[i]:
            proof = problem.refuted
            if i in layers.colliding and world is not None:
                deepest = world.checker.contacts(problem.chain.q(layers.colliding[i], base))[0]
                yield PathBreak(i, BreakReason.IN_COLLISION, contact=deepest)
            elif interrupted and proof is None:
                yield PathBreak(i, BreakReason.INTERRUPTED)
            else:
                yield PathBreak(i, BreakReason.NO_SOLUTION, proof=proof)
        elif i in way.breaks:
            over = np.abs(steps[i - 1]) / layers.bound
            worst = int(over.argmax())
            move = None if world is None else world.first_contact(q[i - 1], q[i])
            contact = None if move is None else move.contact
            if over[worst] > 1.0:
                name, step = problem.chain.names[worst], float(np.abs(steps[i - 1, worst]))
                yield PathBreak(i, BreakReason.STEP, contact=contact, joint=name, step=step, move=move)
            else:
                yield PathBreak(i, BreakReason.MOVE, contact=contact, move=move)


def _moves(
    chain: Chain, way: Way, q: NDArray[np.float64], world: CollisionWorld | None, rng: Rng
) -> dict[int, NDArray[np.float64]]:
    """Joint moves (p, nq) across the breaks of a way: straight ones where these are free."""
    found = {i: q[i - 1 : i + 1].copy() for i in way.breaks if i not in way.barred}
    if way.barred and world is not None and installed():
        for i in way.barred:
            planned = plan_joint_move(chain, world, q[i - 1], q[i], rng=rng)
            if planned.success:
                found[i] = planned.q
    return dict(sorted(found.items()))
