"""The result of checking a straight joint move: that it is free, or where it first collides."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.arguments import number
from pin_metaik.collision.contact import Contact
from pin_metaik.errors import InvalidSetting
from pin_metaik.plain import fields_of


class MoveStatus(StrEnum):
    """What is known of a move; only ``FREE`` is free."""

    FREE = "FREE"
    """Proved: no configuration on the way collides."""
    TOUCHES = "TOUCHES"
    """A configuration on the way collides, as the world's own check says."""
    UNDECIDED = "UNDECIDED"
    """No collision was found, but two bodies come nearer to their margin than the resolution: take it as not free."""


@dataclass(frozen=True, eq=False)
class Move:
    """A straight joint move from one configuration to another, and up to where it is free of collisions.

    Places on the way are fractions of the move, 0 at its start and 1 at its end.

    Attributes:
        status: What is known of it.
        clear: Fraction up to which it is proved that nothing collides; 1 if the move is free.
        touch: Fraction at which a collision was found; NaN if none was. There is none before ``clear``; between the two
            nothing is decided.
        q: (nq,) the configuration at ``touch``, NaN if there is none.
        contact: The two bodies that collide there, the deepest if there are several; None if there are none.
        start: (nq,) the configuration at 0.
        way: (nv,) the whole move as a tangent vector, rad or m.
        model: The robot's model.
    """

    status: MoveStatus
    clear: float
    touch: float
    q: NDArray[np.float64]
    contact: Contact | None
    start: NDArray[np.float64] = field(repr=False)
    way: NDArray[np.float64] = field(repr=False)
    model: pin.Model = field(repr=False)

    def __bool__(self) -> bool:
        """Whether it is proved to be free."""
        return self.status is MoveStatus.FREE

    def at(self, fraction: float) -> NDArray[np.float64]:
        """The configuration (nq,) at a fraction of the move, 0 to 1.

        Raises:
            InvalidSetting: If the fraction is not between 0 and 1.
        """
        if not 0.0 <= (share := number("fraction", fraction)) <= 1.0:
            raise InvalidSetting(f"fraction is between 0 (the start) and 1 (the end), got {share}")
        q: NDArray[np.float64] = pin.integrate(self.model, self.start, share * self.way)
        return q

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON: lengths in m, angles in rad."""
        return fields_of(self, "status", "clear", "touch", "q", "contact")

    def __str__(self) -> str:
        match self.status:
            case MoveStatus.FREE:
                return "free"
            case MoveStatus.TOUCHES:
                return f"touches at {self.touch:.4g} of the way: {self.contact}"
            case MoveStatus.UNDECIDED:
                return f"undecided: from {self.clear:.4g} of the way on, bodies are nearer than the resolution"
