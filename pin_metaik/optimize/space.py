"""The search space: one lower and one upper bound for each coordinate."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import array, instance
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidBounds
from pin_metaik.optimize.settings import MANY, few


@dataclass(frozen=True, eq=False, init=False)
class Box:
    """The search space of an optimisation: the points ``lower <= x <= upper``, coordinate by coordinate.

    It has any number of dimensions. (``collision.Box`` is another class: a solid.)

    A coordinate with ``lower == upper`` is fixed, which every algorithm supports.

    Attributes:
        lower: Lower bounds (n,), finite, read-only.
        upper: Upper bounds (n,), finite, read-only.

    Raises:
        InvalidBounds: The bounds are not two vectors of the same length, not finite, or crossed.
    """

    lower: Array
    upper: Array
    _rows: tuple[Array, Array] = field(init=False, repr=False)

    def __init__(self, lower: ArrayLike, upper: ArrayLike | None = None) -> None:
        if upper is None:
            raise InvalidBounds("the box of a search has lower and upper bounds; a solid is a mik.collision.Box(size)")
        lower, upper = _vector("lower", lower), _vector("upper", upper)
        if lower.shape != upper.shape:
            raise InvalidBounds(f"lower has {lower.size} bounds and upper has {upper.size}: they must match")
        for index in np.flatnonzero(lower > upper):
            raise InvalidBounds(f"bounds are crossed at index {index}: lower {lower[index]:g} > upper {upper[index]:g}")
        with np.errstate(over="ignore"):
            too_wide = np.flatnonzero(~np.isfinite(upper - lower))
        for index in too_wide:
            raise InvalidBounds(f"bounds at index {index} are so far apart that their difference overflows")
        object.__setattr__(self, "lower", lower)
        object.__setattr__(self, "upper", upper)
        object.__setattr__(self, "_rows", (lower[None], upper[None]))

    @property
    def dimension(self) -> int:
        """Number of coordinates n."""
        return self.lower.size

    @property
    def width(self) -> Array:
        """``upper - lower`` (n,)."""
        width: Array = self.upper - self.lower
        return width

    def sample(self, rng: np.random.Generator, count: int) -> Array:
        """Points drawn uniformly: (count, n)."""
        if not isinstance(rng, np.random.Generator):
            instance(np.random.Generator, rng=rng)
        if type(count) is not int or not 0 <= count <= MANY:
            few("count", count, 0)
        X: Array = self.lower + rng.random((count, self.dimension)) * self.width
        return np.minimum(X, self.upper, out=X)  # rounding may have passed it

    def clip(self, X: Array) -> Array:
        """The nearest point of the box, for each of the points X (k, n) or (n,)."""
        X = self._points("X", X)
        lower, upper = self._bounds_like(X)
        clipped: Array = np.maximum(X, lower)
        return np.minimum(clipped, upper, out=clipped)

    def halfway(self, X: Array, origin: Array) -> Array:
        """X with every coordinate outside the box moved half-way between its origin and the bound it crossed.

        Unlike `clip` this keeps a population from piling up on the walls (Zhang and Sanderson 2009, JADE).

        Args:
            X: Points (k, n), anywhere.
            origin: The points in the box (k, n) they came from.
        """
        inside = self.clip(X)
        if not isinstance(origin, np.ndarray) or origin.shape != inside.shape:
            origin = array("origin", origin, *inside.shape)
        outside = inside != X
        return np.where(outside, 0.5 * inside + 0.5 * origin, X) if outside.any() else X

    def contains(self, X: Array) -> NDArray[np.bool_]:
        """Whether each of the points X (k, n) or (n,) lies in the box: (k,) or one answer. NaN does not."""
        inside: NDArray[np.bool_] = (self.clip(X) == X).all(axis=-1)
        return inside

    def contains_all(self, X: Array) -> bool:
        """Whether all of the points X (k, n) lie in the box."""
        return bool((self.clip(X) == X).all())

    def _points(self, name: str, X: Array) -> Array:
        """X as points (k, n) or one point (n,)."""
        if type(X) is np.ndarray and X.dtype.char == "d" and X.ndim in (1, 2) and X.shape[-1] == self.lower.size:
            return X
        given = array(name, X, "...", self.lower.size, finite=False)
        return array(name, X, "k", self.lower.size, finite=False) if given.ndim > 2 else given

    def _bounds_like(self, X: Array) -> tuple[Array, Array]:
        """The bounds repeated for every row of X: three times as fast as broadcasting six columns."""
        if X.ndim != 2:
            return self.lower, self.upper
        if len(X) > len(self._rows[0]):
            object.__setattr__(self, "_rows", (np.tile(self.lower, (len(X), 1)), np.tile(self.upper, (len(X), 1))))
        lower, upper = self._rows
        return lower[: len(X)], upper[: len(X)]


def _vector(name: str, values: ArrayLike) -> Array:
    """A read-only copy of a vector of finite floats."""
    try:
        vector = np.array(values, dtype=float)
    except (TypeError, ValueError, OverflowError) as error:
        raise InvalidBounds(f"{name} bounds must be numbers: {error}") from None
    if vector.ndim != 1 or vector.size == 0:
        raise InvalidBounds(f"{name} bounds must be one vector of at least one number, not of shape {vector.shape}")
    for index in np.flatnonzero(~np.isfinite(vector)):
        raise InvalidBounds(f"{name} bound at index {index} is {vector[index]}: a search needs finite bounds")
    vector.flags.writeable = False
    return vector
