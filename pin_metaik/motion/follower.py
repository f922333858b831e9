"""Following a target that moves, tick by tick: for teleoperation and servoing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import array, checked, instance
from pin_metaik.collision import CollisionWorld
from pin_metaik.errors import InvalidConfiguration, InvalidSetting
from pin_metaik.ik import IKProblem, solve_ik_all
from pin_metaik.ik.problem import check_world
from pin_metaik.ik.target import TargetLike
from pin_metaik.kinematics import Chain
from pin_metaik.kinematics.model import as_configuration
from pin_metaik.motion.limits import MotionLimits
from pin_metaik.motion.step import FollowerStep, Following
from pin_metaik.motion.stops import Stopping, Stops
from pin_metaik.optimize.settings import positive
from pin_metaik.randomness import Rng

SHARES = 1.0, 0.5, 0.25, 0.1  # of the change of speed, tried one after the other where bodies are near
POSTURE_RATE = 2.0  # 1/s at which what the targets leave free returns to the posture
LOST = 0.5  # of the square of an error: where no direction makes up more than the rest, there is none
NOTHING_NEAR = np.empty((0, 10)), np.empty((0, 2), dtype=np.int64)


class Goal(NamedTuple):
    """What a tick is after: the targets, and what of them counts; as the compiled loops take them."""

    tasks: NDArray[np.float64]
    rows: NDArray[np.int64]


@checked
class Follower:
    """Configurations, one a control tick, that follow targets within limits.

    For every target, and for every configuration from which it is started at rest, inside its limits, or which it has
    returned itself, each tick keeps, to rounding:

    1. |v_j| <= velocity_j;
    2. |v_j - v_j of the tick before| <= acceleration_j dt;
    3. the joint's lower and upper limit; and it can stop before either.

    Why: a joint that brakes from a speed v >= 0 has v - a, v - 2 a, ... with a = acceleration dt, and goes on by
    D(v) = dt ((v - a) + (v - 2 a) + ...) in the ticks to come. A tick takes only speeds with dt v + D(v) <= d, where d
    is how far the limit is away; in the next one d' = d - dt v >= D(v). There the speed w = max(v - a, 0) keeps (1) and
    (2), and dt w + D(w) = D(v) <= d': it is one of those that may be taken. So after a tick that has kept (3) there is
    always a speed that keeps all, braking is one, and by induction from a start at rest none is ever broken. The same
    holds towards the lower limit, and for each joint by itself. The speeds that may be taken are an interval; the tick
    takes the one that serves the target best.

    With a world, each tick is one from which the robot can brake, every joint as hard as its acceleration allows,
    without a collision: that is proved before the tick is taken, by distances and by how far bodies can move; where the
    proof fails for all speeds that are tried, it brakes, for which the proof of the tick before still stands. So as long
    as nothing else moves, and it was started at rest free of collisions, it never collides and its braking never does.
    Its own joints outside the chain count as standing. What moves by itself is seen where it is at each tick; what comes
    too fast can hit it. Distances beyond the margin down to ``clearance`` slow it down; nearer it goes only if it must.

    If it is given another configuration than its last one (a measured one), (1) and (2) still hold; a joint that is too
    near its limit for its speed brakes as hard as (2) allows, and one that is beyond it goes back. Commands to a
    position controller are best made from the commands before: ``step(target, last.q)``.

    It moves towards a target by damped least squares with these intervals inside, leads a target that moves by its
    speed since the last tick, and slows down in time so that no joint overshoots. In a singularity the damping lets go
    of the directions that are lost, smoothly, and the target is missed for a while; a target out of reach is approached
    as near as the linearised arm sees it, without swinging. Jerk is not limited. It never changes to another branch of
    solutions by itself: where its own ends, ``step`` says so, and ``switch`` and ``move`` lead to another one.

    Attributes:
        chain: The joints to move and the frames to place.
        rate: Ticks per second, Hz.
        limits: How fast the joints may move.
        world: What must not collide; None: nothing is looked at.
        posture: (nq,) what the joints return to as far as the targets leave them free; None: they stay.
        clearance: Distance beyond the world's margin from which on it is kept from coming nearer, m.
        v: (n,) speeds of the last tick, rad/s or m/s.
    """

    def __init__(
        self,
        chain: Chain,
        rate: float = 500.0,
        limits: MotionLimits | None = None,
        world: CollisionWorld | None = None,
        *,
        posture: ArrayLike | None = None,
        clearance: float = 0.01,
    ) -> None:
        """Begin at rest.

        Args:
            chain: The joints to move and the frames to place; position limits are the chain's.
            rate: Ticks per second, Hz.
            limits: How fast the joints may move; default: ``MotionLimits.of(chain)``, the model's.
            world: What must not collide.
            posture: (nq,) what the joints return to as far as the targets leave them free; default: they stay.
            clearance: m.

        Raises:
            InvalidSetting: If ``rate`` or ``clearance`` is not above 0 and finite, limits are not those of n joints or
                a joint has none, or the world is another model's than the chain.
            InvalidConfiguration: If ``posture`` is not a configuration of the model.
        """
        positive("rate", rate)
        positive("clearance", clearance)
        check_world(chain, world)
        limits = MotionLimits.of(chain) if limits is None else limits
        if len(limits.velocity) != chain.n:
            raise InvalidSetting(f"limits are of {len(limits.velocity)} joints, the chain has {chain.n}")
        self.chain, self.rate, self.limits, self.world, self.clearance = chain, float(rate), limits, world, clearance
        self.posture = None if posture is None else chain.configuration(posture)
        self.v = np.zeros(chain.n)
        self._dt = 1.0 / self.rate
        self._motion = np.array([limits.velocity, limits.acceleration * self._dt, np.zeros(chain.n)])
        self._stops = None if world is None else Stops(chain, world, clearance)
        self._moves = np.zeros((chain.model.njoints, len(chain.paths.joints)), dtype=np.int64)
        if self._stops is not None:
            self._moves = self._stops.moves
        self._out, self._sizes = np.empty((3, chain.n)), np.empty(2)
        self._before: Goal | None = None
        self._aim, self._head, self._judge = _loops()

    def step(self, target: TargetLike | Sequence[TargetLike], q: ArrayLike) -> FollowerStep:
        """One tick towards a target.

        Args:
            target: As for ``solve_ik``; a target that is where it was one tick before stands, one that is not moves.
            q: (nq,) where the robot is: at first the measured configuration, then what the last step returned.

        Raises:
            InvalidTarget: If the target is none.
            InvalidConfiguration: If q is not a configuration of the model.
        """
        at = as_configuration(self.chain.model, q)
        chain = self.chain.at(at)
        problem = IKProblem.of(chain, target)
        goal = Goal(problem.tasks, problem.rows)
        before, self._before = self._before, goal
        if before is None or before.rows is not goal.rows:
            before = goal
        x = chain.x(at)
        if self.posture is not None:
            self._motion[2] = POSTURE_RATE * chain.limits.way(x, chain.x(self.posture))
        around = None if self._stops is None else self._stops.around(at, self._farthest())
        near, carriers = NOTHING_NEAR if around is None else around[1:]
        lost = self._aim(
            chain.bare, before.tasks, *goal, x, self.v, self._motion, self._dt, near, carriers, self._moves, self._out
        )
        share = 1.0 if around is None else self._slowed(chain, at, around.rooms)
        after = self._taken(chain, at, x, share)
        met = self._judge(chain.bare, *goal, chain.x(after), self._sizes)
        stopped = tuple(name for name, at_limit in zip(chain.names, self._out[2].tolist(), strict=True) if at_limit)
        held = share < 1.0 or bool(len(near) and self._near_stops(near))
        if met:
            status = Following.ON_TARGET
        elif held:
            status = Following.NEAR_COLLISION
        elif stopped and lost > LOST:
            status = Following.AT_LIMITS
        else:
            status = Following.NO_DIRECTION if lost > LOST else Following.UNDER_WAY
        return FollowerStep(after, self.v.copy(), status, *self._sizes.tolist(), share, stopped)
