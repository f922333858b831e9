"""A joint move from one configuration to another, or to any of several, that collides nowhere."""

from __future__ import annotations

from dataclasses import dataclass, field
from importlib.util import find_spec
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import array, checked
from pin_metaik.collision import CollisionWorld
from pin_metaik.errors import InvalidConfiguration
from pin_metaik.kinematics import Chain
from pin_metaik.lookup import lookup
from pin_metaik.optimize.settings import positive
from pin_metaik.plain import fields_of
from pin_metaik.planning.adapter import Adapter
from pin_metaik.randomness import Rng, as_generator

PLANNERS = ("RRTConnect", "RRT", "RRTstar", "InformedRRTstar", "BITstar", "PRM", "KPIECE1", "LBKPIECE1", "BKPIECE1")
SIMPLIFYING = 1.0  # s at most


@dataclass(frozen=True, eq=False)
class JointPlan:
    """A path from a start to a goal, made of straight joint moves that are each proved free of collisions.

    Attributes:
        q: (p, nq) configurations, from the start to one of the goals; (0, nq) if no path was found.
        goal: The number of the goal that is reached; None if none is.
        seconds: Time taken, s.
        chain: The chain.
    """

    q: NDArray[np.float64]
    goal: int | None
    seconds: float
    chain: Chain = field(repr=False)

    @property
    def success(self) -> bool:
        """Whether a path was found. If none was, there may be one nevertheless."""
        return self.goal is not None

    def __bool__(self) -> bool:
        """Whether a way was found."""
        return self.success

    @property
    def x(self) -> NDArray[np.float64]:
        """(p, n) the chain's coordinates; those of continuous joints run on through whole turns."""
        return self.chain.unwrapped(self.q)

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON: lengths in m, angles in rad."""
        return fields_of(self, "q", "goal", "success", "seconds")


def installed() -> bool:
    """Whether OMPL is installed."""
    return find_spec("ompl") is not None


@checked
def plan_joint_move(
    chain: Chain,
    world: CollisionWorld,
    q0: ArrayLike,
    goals: ArrayLike,
    *,
    planner: str = "RRTConnect",
    seconds: float = 5.0,
    rng: Rng = None,
) -> JointPlan:
    """Plan a joint motion around obstacles with OMPL.

    Args:
        chain: The joints that move.
        world: The world in which nothing must collide.
        q0: (nq,) start configuration; joints that the chain does not move keep its values.
        goals: (nq,) goal configuration, or (k, nq) several, any of which will do, for instance all solutions of a pose:
            ``mik.solve_ik_all(chain, pose, q0, world=world).q``.
        planner: Name of a geometric planner of OMPL.
        seconds: Time that the planner may take, s; shortening the path takes up to a second more. A planner that goes
            on to improve its path, such as ``"RRTstar"``, takes all of it.
        rng: Seed or generator; ``None`` is a fixed seed. OMPL has one random source per process, so the same seed gives
            the same path only in a process that has not planned before.

    Returns:
        The plan: check ``plan.success``. That none was found proves nothing.

    Raises:
        MissingExtra: OMPL is not installed.
        UnknownName: There is no such planner.
        InvalidConfiguration: If ``q0`` or a goal is not a configuration of the model, or there is no goal.
        InvalidBounds: If a sliding joint of the chain has no limits.
        InvalidSetting: If ``seconds`` is not above 0, or the world is another model's than the chain.
    """
    began = perf_counter()
    positive("seconds", seconds)
    lookup("planner", planner, dict.fromkeys(PLANNERS))
    adapter = Adapter(chain, world, q0)
    ends = np.atleast_2d(array("goals", goals, "...", chain.model.nq, error=InvalidConfiguration))
    if not len(ends):
        raise InvalidConfiguration("goals has at least one configuration, got none")
    start = chain.configuration(q0)
    ends = chain.q(chain.x(chain.inside(ends)), adapter.base)
    open_ends = [k for k, q in enumerate(ends) if not world.in_collision(q)]
    way = np.empty((0, chain.model.nq))
    if open_ends and not world.in_collision(start):
        way = _planned(adapter, start, ends[open_ends], planner, seconds, int(as_generator(rng).integers(1, 2**31)))
    goal = None
    if len(way):
        goal = open_ends[int(np.abs(chain.limits.way(chain.x(ends[open_ends]), chain.x(way[-1]))).max(axis=1).argmin())]
        way[0], way[-1] = start, ends[goal]
        if not world.clear_between_batch(way[:-1], way[1:], workers=1).all():
            way, goal = way[:0], None
    return JointPlan(way, goal, perf_counter() - began, adapter.chain)


def _planned(
    adapter: Adapter, start: NDArray[np.float64], ends: NDArray[np.float64], planner: str, seconds: float, seed: int
) -> NDArray[np.float64]:
    """The configurations (p, nq) of the way that OMPL finds; none, if it finds none."""
    from ompl import base as ob
    from ompl import geometric as og
    from ompl import util as ou

    before = ou.getLogLevel()
    ou.setLogLevel(ou.LOG_NONE)
    try:
        ou.RNG.setSeed(seed)
        setup = adapter.setup()
        information = setup.getSpaceInformation()
        goals = ob.GoalStates(information)
        for q in ends:
            goals.addState(adapter.state(q))
        setup.setStartState(adapter.state(start))
        setup.setGoal(goals)
        setup.setPlanner(getattr(og, planner)(information))
        setup.solve(seconds)
        if not setup.haveExactSolutionPath():
            return np.empty((0, len(start)))
        setup.simplifySolution(SIMPLIFYING)
        return np.array([adapter.q(state) for state in setup.getSolutionPath().getStates()])
    finally:
        ou.setLogLevel(before)
