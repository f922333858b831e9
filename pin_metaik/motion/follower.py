"""Following a moving target tick by tick, for teleoperation and servoing."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any, NamedTuple, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import checked
from pin_metaik.collision import CollisionWorld
from pin_metaik.errors import InvalidSetting, InvalidTarget
from pin_metaik.ik import IKProblem, solve_ik_all
from pin_metaik.ik.goals.pose import TargetLike
from pin_metaik.ik.problem import check_world
from pin_metaik.kinematics import Chain
from pin_metaik.kinematics.model import as_configuration
from pin_metaik.motion.step import FollowerStatus, FollowerStep
from pin_metaik.motion.stops import Stopping, Stops, Surroundings
from pin_metaik.optimize.settings import positive
from pin_metaik.randomness import Rng
from pin_metaik.timing.limits import MotionLimits

SHARES = 1.0, 0.5, 0.25, 0.1  # of the change of speed, tried one after the other where bodies are near
POSTURE_RATE = 2.0  # 1/s at which what the targets leave free returns to the posture
LOST = 0.5  # of the square of an error: where no direction makes up more than the rest, there is none
SWITCHES = 32  # solutions to choose from, at most
THERE = 1e-9  # rad or m from a configuration that is moved to
GENTLE = 0.25  # of the greatest speed, at most, towards the posture
NO_MOVES = np.empty((0, 0), dtype=np.int64)
NO_ROOMS = np.empty(0)
NOTHING_NEAR = Surroundings(
    np.empty((0, 3), dtype=np.int64), NO_ROOMS, NO_ROOMS, np.empty((0, 12)), np.empty((0, 10)), NO_MOVES.reshape(0, 2)
)


@checked
class Follower:
    """A controller: at each tick it gives the next configuration, following targets within the joints' limits.

    If it was started at rest at a configuration inside the limits and is then given the configurations that it
    returned, each tick, whatever the target, satisfies up to rounding:

    1. |v_j| <= velocity_j;
    2. |v_j - v_j of the tick before| <= acceleration_j dt;
    3. the joint's lower and upper limit; and it can stop before either.

    Proof: a joint that brakes from a speed v >= 0 has the speeds v - a, v - 2 a, ... with a = acceleration dt, and
    moves on by D(v) = dt ((v - a) + (v - 2 a) + ...) in the following ticks. A tick admits only speeds v with dt v +
    D(v) <= d, where d is the distance to the limit; at the next tick that distance is d' = d - dt v >= D(v). There the
    speed w = max(v - a, 0) satisfies (1) and (2), and dt w + D(w) = D(v) <= d', so that it is admitted. Hence after a
    tick with (3) there is always an admitted speed, braking being one, and by induction from a start at rest (1) to (3)
    always hold. The same is true towards the lower limit, and for each joint by itself. The admitted speeds are an
    interval; the tick takes the one that serves the target best.

    With a world, before each tick it is proved, from distances and from bounds on how far bodies can move, that after
    it the robot can brake, every joint as hard as its acceleration allows, without a collision. If the proof fails for
    all speeds that are tried, the robot brakes, for which the proof of the tick before still holds. So it never
    collides, provided that it was started at rest and free of collisions and that nothing else moves, including joints
    outside the chain. Moving obstacles are taken at each tick where they then are; one that is too fast can hit the
    robot. The robot slows down as distances approach the margin plus ``clearance``; it goes nearer only where it must,
    and then by at most half of the remaining distance in a tick.

    If it is given another configuration than the one it returned (a measured one), (1) and (2) still hold; a joint that
    is too close to its limit for its speed brakes as hard as (2) allows, and one that is beyond its limit moves back.
    With a position controller, it is best to pass the last command: ``step(target, last.q)``.

    Speeds are found by damped least squares within these intervals. The velocity of a moving target is estimated from
    its last tick and fed forward; for a target at rest the robot slows down in time. In a singularity the damping gives
    up the lost directions smoothly, and the target is missed for a while; a target out of reach is approached as
    closely as the linearised arm allows, without oscillation. Jerk is not limited. The follower never jumps to another
    branch of solutions: where its branch ends, it goes along the limits as near to the target as it can, and ``step``
    reports that; ``switch`` and ``move`` lead to another branch.

    Attributes:
        chain: The joints to move and the frames to place.
        rate: Ticks per second, Hz.
        limits: Largest velocity and acceleration of each joint.
        world: The world in which nothing must collide; None: collisions are not checked.
        posture: (nq,) configuration that the joints return to as far as the targets leave freedom; None: they stay.
        clearance: Distance beyond the world's margin that is kept where possible, m.
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
        self._gentle = GENTLE * limits.velocity
        self._stops = None if world is None else Stops(chain, world, clearance)
        self._moves = NO_MOVES if self._stops is None else self._stops.moves
        self._out, self._sizes = np.empty((3, chain.n)), np.empty(2)
        self._before: IKProblem | None = None
        self._loops = _loops()

    def step(self, target: TargetLike | Sequence[TargetLike], q: ArrayLike) -> FollowerStep:
        """One tick towards a target.

        Args:
            target: As for ``solve_ik``. Its velocity is estimated from the target one tick ago, so targets that come
                less often than ticks should be interpolated.
            q: (nq,) where the robot is: at first the measured configuration, then what the last step returned.

        Raises:
            InvalidTarget: If the target is none.
            InvalidConfiguration: If q is not a configuration of the model.
        """
        at = as_configuration(self.chain.model, q)
        chain = self.chain.at(at)
        problem = IKProblem.of(chain, target)
        if problem.goals:
            raise InvalidTarget(f"a follower follows targets, one a frame, got {problem.goals.each[0]!r} as well")
        before, self._before = self._before, problem
        if before is None or before.rows is not problem.rows:
            before = problem
        x = chain.x(at)
        if self.posture is not None:
            wish = POSTURE_RATE * chain.limits.way(x, chain.x(self.posture))
            self._motion[2] = np.clip(wish, -self._gentle, self._gentle)
        around = self._around(at)
        lost, pushed = self._loops.aim(
            chain.bare, before.records, problem.records, problem.rows, x, self.v, self._motion, self._dt,
            around.near, around.carriers, self._moves, self._out,
        )  # fmt: skip
        share, after = self._go(chain, at, x, around)
        met = self._loops.judge(chain.bare, problem.records, problem.rows, chain.x(after), self._sizes)
        stopped = self._stopped()
        if met:
            status = FollowerStatus.ON_TARGET
        elif share < 1.0 or pushed:
            status = FollowerStatus.NEAR_COLLISION
        elif lost > LOST:
            status = FollowerStatus.AT_LIMITS if stopped else FollowerStatus.NO_DIRECTION
        else:
            status = FollowerStatus.UNDER_WAY
        position, orientation = self._sizes.tolist()
        return FollowerStep(after, self.v.copy(), status, position, orientation, share, stopped)

    def move(self, goal: ArrayLike, q: ArrayLike) -> FollowerStep:
        """One tick towards a configuration in joint space; usually all joints begin and end together.

        Args:
            goal: (nq,) configuration to reach, clipped to the limits; joints outside the chain stay as they are.
            q: (nq,) where the robot is, as for ``step``.

        Raises:
            InvalidConfiguration: If ``goal`` or ``q`` is not a configuration of the model.
        """
        at = as_configuration(self.chain.model, q)
        chain = self.chain.at(at)
        self._before = None
        x, end = chain.x(at), chain.x(chain.configuration(goal))
        around = self._around(at)
        way = chain.limits.way(x, end)
        self._loops.head(chain.bare, way, x, self.v, self._motion, self._dt, self._out)
        share, after = self._go(chain, at, x, around)
        there = bool((np.abs(chain.limits.way(chain.x(after), end)) <= THERE).all())
        status = (
            FollowerStatus.ON_TARGET
            if there
            else FollowerStatus.UNDER_WAY
            if share == 1.0
            else FollowerStatus.NEAR_COLLISION
        )
        return FollowerStep(after, self.v.copy(), status, math.nan, math.nan, share)

    def stop(self, q: ArrayLike) -> FollowerStep:
        """One tick of braking, every joint as hard as its acceleration allows.

        Args:
            q: (nq,) where the robot is, as for ``step``.

        Raises:
            InvalidConfiguration: If ``q`` is not a configuration of the model.
        """
        return self.move(q, q)

    def reset(self) -> None:
        """Forget speeds and targets: the robot is at rest and starts anew."""
        self.v, self._before = np.zeros(self.chain.n), None

    def switch(
        self, target: TargetLike | Sequence[TargetLike], q: ArrayLike, *, rng: Rng = None
    ) -> NDArray[np.float64] | None:
        """Another configuration (nq,) that meets a target, to ``move`` to when a branch ends.

        It takes milliseconds, or longer in a world: call it while the robot is at rest. The move there may be blocked
        by a collision, before which ``move`` stops.

        Args:
            target: As for ``solve_ik``.
            q: (nq,) where the robot is.
            rng: Seed or generator; ``None`` is a fixed seed.

        Returns:
            Of the solutions found (in a world, of those free of collisions) the one that the joints reach in the least
            time; None if there is none.

        Raises:
            InvalidTarget: If the target is none.
            InvalidConfiguration: If q is not a configuration of the model.
        """
        found = solve_ik_all(self.chain, target, q, limit=SWITCHES, world=self.world, rng=rng)
        if not len(found):
            return None
        ways = self.chain.limits.way(self.chain.x(as_configuration(self.chain.model, q)), found.x)
        nearest: NDArray[np.float64] = found.q[np.argmin((np.abs(ways) / self.limits.velocity).max(axis=1))]
        return nearest

    def _around(self, q: NDArray[np.float64]) -> Surroundings:
        """What is near a configuration (nq,), as far as the robot may go before it stands."""
        if self._stops is None:
            return NOTHING_NEAR
        fastest = np.minimum(np.abs(self.v) + self._motion[1], self.limits.velocity)
        return self._stops.around(self._stopping(q, fastest))

    def _stopping(self, q: NDArray[np.float64], v: NDArray[np.float64]) -> Stopping:
        return Stopping(self.chain, q, v, self._motion[1], self._dt)

    def _go(
        self, chain: Chain, q: NDArray[np.float64], x: NDArray[np.float64], around: Surroundings
    ) -> tuple[float, NDArray[np.float64]]:
        """Take the speeds of the tick as far as the robot can stop after it: which part, and where it leads (nq,)."""
        wanted, braked = self._out[0], self._out[1]
        share = 1.0
        if self._stops is not None and len(around.pairs):
            share = self._share(self._stops, q, around)
        self.v = wanted.copy() if share == 1.0 else braked + share * (wanted - braked)
        limits = chain.limits
        return share, chain.q(np.minimum(np.maximum(x + self._dt * self.v, limits.lower), limits.upper), q)

    def _share(self, stops: Stops, q: NDArray[np.float64], around: Surroundings) -> float:
        """The largest share, of those tried, of the change from braking to the speeds wanted, that is proved free."""
        wanted, braked = self._out[0], self._out[1]

        def stopping(share: float) -> Stopping:
            return self._stopping(q, braked + share * (wanted - braked))

        for share in SHARES:
            if stops.free(around, stopping(share)):
                return share
        tiny = SHARES[-1] * stops.harmless(around, stopping(SHARES[-1]))  # from rest, it is free without a look
        return tiny if stops.free(around, stopping(tiny)) else 0.0

    def _stopped(self) -> tuple[str, ...]:
        """Names of the joints that stand at limits which the way leads beyond."""
        if not self._out[2].any():
            return ()
        return tuple(name for name, stopped in zip(self.chain.names, self._out[2].tolist(), strict=True) if stopped)


class _Loops(NamedTuple):
    """The compiled loops, without the frame around them."""

    aim: Callable[..., tuple[float, int]]
    head: Callable[..., None]
    judge: Callable[..., bool]


@cache
def _loops() -> _Loops:
    """Imported late: what compiles them takes 0.4 s to import."""
    from pin_metaik.motion import kernel

    return _Loops(*(cast(Any, loop).compiled() for loop in (kernel.aim, kernel.head, kernel.judge)))
