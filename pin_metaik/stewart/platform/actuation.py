"""How the legs of a platform are actuated: the protocol of a leg, and legs that are linear actuators.

Every leg ends in a straight link between two joints. The link of a slide begins in the base joint and changes its
length; that of a servo is a rod of fixed length, which begins at the tip of a horn. Whatever is said about a platform
(rates, dexterity, distances, pictures) is said about these links, and about the coordinate q that moves each: a length
in m or an angle in rad.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arrays import Array


class Words(NamedTuple):
    """What people call the legs of a kind, and what moves them."""

    legs: str
    coordinate: str
    coordinates: str
    extremes: str
    first_joints: str
    columns: tuple[str, str]
    """Of a table over time: coordinates and rates, before the number of the leg."""


@dataclass(frozen=True, eq=False)
class Links:
    """The result of inverse kinematics: the legs of a platform at k poses. Vectors are in the base frame.

    Attributes:
        coordinates: q of each leg (k, n): lengths in m or servo angles in rad; NaN where the leg cannot reach.
        starts: First points of the links, m (k, n, 3): base joints, or tips of horns.
        vectors: Vectors from there to the platform joints, m (k, n, 3). For a rod that cannot reach: from the horn's
            tip where it is nearest to the platform joint.
        pushes: Velocity along the link per rate of the actuator (k, n): 1 for a slide; for a servo, in m/rad, its horn
            times the transmission, negative where it pulls. NaN where the leg cannot reach.
        transmission: Cosine (k, n), 0 ... 1, of the angle between a rod and the motion of its horn's tip; 1 for a
            slide. NaN where the leg cannot reach.
        missing: By how much a link is too short, m (k, n); negative if it is too long; 0 where it reaches.
    """

    coordinates: Array
    starts: Array
    vectors: Array
    pushes: Array
    transmission: Array
    missing: Array

    @property
    def reached(self) -> NDArray[np.bool_]:
        """Whether every leg reaches its platform joint, whatever its limits are (k,)."""
        reached: NDArray[np.bool_] = (self.missing == 0.0).all(axis=1)
        return reached

    @property
    def why(self) -> str:
        """Which leg misses its platform joint at the first pose, and by how much; empty if none does."""
        leg = int(np.abs(self.missing[0]).argmax())
        short = float(self.missing[0, leg])
        if short == 0.0:
            return ""
        return f"the rod of leg {leg + 1} is {abs(short):.6g} m too {'short' if short > 0.0 else 'long'}"


class Actuation(Protocol):
    """What moves the legs: between legs from base to platform joint, their links and their coordinates."""

    words: Words

    @property
    def upright(self) -> Array:
        """The axes (3,) or (n, 3) that the first joints of links have by default, as ``in_first_joint`` has them."""

    def span(self) -> tuple[float, float] | None:
        """Least and greatest distance in m that a leg can have by its parts alone; None: its limits say."""

    def links(self, b: Array, v: Array) -> Links:
        """Inverse kinematics, from base joints b (n, 3) and vectors v (k, n, 3) to the platform joints."""

    def can_be(self, q: Array) -> NDArray[np.bool_]:
        """Which of these numbers (k, n) can be coordinates at all."""

    def held(self, b: Array, q: Array) -> tuple[Array, Array]:
        """Where links begin (k or 1, n, 3) and how long they are (k, n) while coordinates q (k, n) are held."""

    def in_first_joint(self, links: Links) -> Array:
        """Unit directions (k, n, 3) of links in the frame that carries their first joints."""


@dataclass(frozen=True)
class Slides:
    """Legs that change their length: linear actuators between base and platform joints (6-UPS)."""

    words = Words("legs", "length", "leg lengths", "shortest, longest", "base joints", ("d", "v"))

    @property
    def upright(self) -> Array:
        """Square to the base."""
        return np.array([0.0, 0.0, 1.0])

    def span(self) -> None:
        """Their limits say how long they are."""

    def links(self, b: Array, v: Array) -> Links:
        """The legs are the links; there is always a length."""
        lengths = np.linalg.norm(v, axis=-1)
        ones = np.ones_like(lengths)
        return Links(lengths, np.broadcast_to(b, v.shape), v, ones, ones, np.zeros_like(lengths))

    def can_be(self, q: Array) -> NDArray[np.bool_]:
        """Lengths are above zero."""
        return np.isfinite(q) & (q > 0.0)

    def held(self, b: Array, q: Array) -> tuple[Array, Array]:
        """From the base joints, as long as their coordinates say."""
        return b[None], q

    def in_first_joint(self, links: Links) -> Array:
        """Base joints stand still."""
        return directions(links.vectors, self.upright)


def directions(vectors: Array, otherwise: ArrayLike) -> Array:
    """Unit vectors (..., 3); those of no length become another direction."""
    d = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(np.divide(vectors, d, out=np.full_like(vectors, np.asarray(otherwise)), where=d > 0.0))


SLIDES = Slides()
