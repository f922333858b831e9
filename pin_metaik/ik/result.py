"""The result of an inverse-kinematics search, and the reason for its status."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import Any, TypeAlias, cast

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.collision import CollisionWorld, Contact
from pin_metaik.dexterity import rank
from pin_metaik.ik.goals.goal import Outcome
from pin_metaik.ik.labels import labels_of
from pin_metaik.ik.problem import Asked, IKProblem
from pin_metaik.ik.proof import Proof
from pin_metaik.ik.reasons import cannot_move, collisions, in_collision, out_of_reach
from pin_metaik.kinematics import Chain
from pin_metaik.plain import fields_of, plain

Parts: TypeAlias = tuple[tuple[float, float, float], tuple[float, float, float, float]]

AT_LIMIT = 1e-9  # rad or m


class IKStatus(StrEnum):
    """Why a search ended; only ``SOLVED`` is a success."""

    SOLVED = "SOLVED"
    """Within the tolerances and inside the limits, by Pinocchio; in a world also free of collisions, by coal."""
    UNREACHABLE = "UNREACHABLE"
    """Proved: no configuration inside the limits is within the tolerances; see ``IKResult.proof``."""
    OUT_OF_TOLERANCE = "OUT_OF_TOLERANCE"
    """The budget of evaluations is spent and nothing found is close enough."""
    IN_COLLISION = "IN_COLLISION"
    """The solutions found meet the target, but all of them collide."""
    STOPPED = "STOPPED"
    """The budget of seconds was spent, or a watch ended a batch. Ctrl-C raises ``KeyboardInterrupt`` instead."""


@dataclass(eq=False, slots=True)  # not frozen: that takes four times as long to make, a tenth of a quick solve
class IKResult:
    """The best configuration found. It is inside the limits, whether the target is met or not.

    Attributes:
        q: (nq,) configuration.
        status: Why the search ended.
        position_error: Distance to the target in m, by Pinocchio; of the worst frame; 0 if the position is free.
        orientation_error: Angle to the target in rad, by Pinocchio; of the worst frame; 0 if the orientation is free.
        evaluations: Forward kinematics computed, one a configuration.
        seconds: Time taken, s.
        chain: The chain, with its held joints as in ``q`` (``Chain.at``).
        given: The target as it was given, or ``None``: see ``target``.
        trace: (g, 2) evaluations and best cost after each generation of the seeder, when asked for.
        world: The world in which collisions were checked, if one was given. It is not pickled, because of all its
            meshes: an unpickled result has ``None`` until a world is assigned.
        contacts: What collides at ``q``, the deepest first, when the status is ``IN_COLLISION``.
        proof: With status ``UNREACHABLE``, how it is proved that the target is out of reach; with ``IN_COLLISION``, how
            it is proved that every solution collides (see ``IKSolutions.complete``), or None.
        resolution: With status ``IN_COLLISION``, for a chain with more joints than the target needs: half the width
            (rad or m) of boxes that cover all solutions, one solution of each having been checked. ``None`` if that was
            not done.
        parts: A pose target as position and quaternion, which is cheaper than to copy the SE3.
    """

    q: NDArray[np.float64]
    status: IKStatus
    position_error: float
    orientation_error: float
    evaluations: int
    seconds: float
    chain: Chain = field(repr=False)
    given: Asked | None = field(repr=False)
    trace: NDArray[np.float64] | None = field(default=None, repr=False)
    world: CollisionWorld | None = field(default=None, repr=False)
    contacts: tuple[Contact, ...] = ()
    proof: Proof | None = None
    resolution: float | None = None
    parts: Parts | None = field(default=None, repr=False)

    @property
    def target(self) -> Asked:
        """The target: a pose as a ``pin.SE3``, anything else as it was given."""
        if self.parts is None:
            return cast(Asked, self.given)
        return cast(pin.SE3, pin.XYZQUATToSE3(self.parts[0] + self.parts[1]))

    @property
    def problem(self) -> IKProblem:
        """The problem that was solved, with joints outside the chain as in ``q``."""
        return IKProblem.of(self.chain, self.target, self.world).at(self.q)

    @property
    def success(self) -> bool:
        """Whether the target is met."""
        return self.status is IKStatus.SOLVED

    def __bool__(self) -> bool:
        return self.success

    @property
    def x(self) -> NDArray[np.float64]:
        """(n,) the chain's coordinates at ``q``."""
        return self.chain.x(self.q)

    @property
    def binding(self) -> tuple[str, ...]:
        """Names of the joints that are at a limit."""
        limits, x = self.chain.limits, self.x
        at_limit = (x <= limits.lower + AT_LIMIT) | (x >= limits.upper - AT_LIMIT)
        return tuple(name for name, binds in zip(limits.names, at_limit, strict=True) if binds)

    @property
    def rank(self) -> int:
        """Rank of the target's Jacobian at ``q``; if it is less than its number of rows, ``q`` is singular."""
        return rank(self.problem.linearize(self.x)[1])

    @property
    def label(self) -> str:
        """The branch of ``q``, named as in ``IKSolutions.labels``; empty where the solutions form a continuum."""
        return "".join(labels_of(self.problem, self.x[None]))

    @property
    def goals(self) -> tuple[Outcome, ...]:
        """The outcome of each goal: whether it is met at ``q``, and by how much it is missed."""
        return self.problem.outcomes(self.q)[0]

    @property
    def wishes(self) -> tuple[Outcome, ...]:
        """The outcome of each wish."""
        return self.problem.outcomes(self.q)[1]

    @property
    def why(self) -> str:
        """The reason for the status, in words."""
        match self.status:
            case IKStatus.SOLVED:
                return "within the tolerances and inside the limits"
            case IKStatus.UNREACHABLE:
                return out_of_reach(self.problem, self._nearest)
            case IKStatus.OUT_OF_TOLERANCE:
                return f"nothing close enough found in {self.evaluations} evaluations; {self._nearest}"
            case IKStatus.IN_COLLISION:
                shown = collisions(self.chain, self.world, self.contacts)
                return f"{in_collision(self.proof, self.resolution)}; the least deep found: {shown}"
            case IKStatus.STOPPED:
                return "time was up, or a watch said so, before it was solved; this is the best so far"

    @property
    def _nearest(self) -> str:
        """How far ``q`` is from the target, and what keeps it from it."""
        still, free = cannot_move(self.problem), [n for n in self.binding if n not in self.chain.limits.stuck]
        stuck = (f"; at a limit: {', '.join(free)}" if free else "") + (f"; {still}" if still else "")
        if self.problem.goals:
            return f"the nearest misses {'; '.join(str(one) for one in self.goals if not one.met)}{stuck}"
        asked = self.problem.m
        lost = f"; {asked - self.rank} of {asked} directions lost there" if self.rank < asked else ""
        away = f"{self.position_error:.3g} m and {self.orientation_error:.3g} rad away"
        return f"the nearest is {away}{stuck}{lost}"

    def verify(self) -> bool:
        """Judge ``q`` again: errors by Pinocchio, the limits, and collisions by coal in the world as it is now.

        An unpickled result, which has no world, counts its stored ``contacts`` as collisions.
        """
        return self.problem.accepts(self.q) and not (self.world is None and self.contacts)

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON, in m and rad; ``joints`` are the chain's coordinates by name."""
        names = (
            "status",
            "success",
            "why",
            "q",
            "position_error",
            "orientation_error",
            "proof",
            "evaluations",
            "seconds",
        )
        return {
            "frames": list(self.chain.frames),
            **fields_of(self, *names),
            "joints": dict(zip(self.chain.names, self.x.tolist(), strict=True)),
            "goals": [one.as_dict() for one in self.goals],
            "wishes": [one.as_dict() for one in self.wishes],
            "collisions": plain(self.contacts),
        }

    def __getstate__(self) -> dict[str, object]:
        """Pickle without the world: kilobytes rather than megabytes."""
        return {**{name: getattr(self, name) for name in self.__slots__}, "world": None}

    def __setstate__(self, state: dict[str, object]) -> None:
        for name, value in state.items():
            setattr(self, name, value)

    def __copy__(self) -> IKResult:
        return replace(self)

    def __str__(self) -> str:
        return (
            f"{self.status}: {self.position_error:.3g} m, {self.orientation_error:.3g} rad from the target after "
            f"{self.evaluations} evaluation{'s' * (self.evaluations != 1)} in {1e3 * self.seconds:.4g} ms"
        )
