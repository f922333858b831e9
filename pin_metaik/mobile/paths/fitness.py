"""The cost of a path through via points, for planners that search: exact, or as in the paper."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal, Protocol

import numpy as np
import shapely
from numpy.typing import NDArray

from pin_metaik.arguments import checked, shown
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidSetting
from pin_metaik.lookup import lookup
from pin_metaik.mobile.paths import fitness_kernels as kernels
from pin_metaik.mobile.world.border import rings
from pin_metaik.mobile.world.freespace import FreeSpace
from pin_metaik.mobile.world.growth import grow
from pin_metaik.mobile.world.scene import Point
from pin_metaik.optimize.settings import one_of, within

Counts = NDArray[np.int64]

C_P = 12.0  # widths of the workspace: 120 in the paper's, which is 10 x 10


class Objective(Protocol):
    """Costs of paths between one start and one goal."""

    def __call__(self, X: Array) -> Array:
        """Costs (k,) of paths with the via points X (k, 2 n): x and y of one after the other."""
        ...

    def hits(self, X: Array) -> Counts:
        """How often each path hits an obstacle (k,)."""
        ...


class Fitness(Protocol):
    """A cost function of paths; its settings are its fields."""

    def on(self, space: FreeSpace, start: Point, goal: Point) -> Objective:
        """The costs of paths from start to goal in a free space."""
        ...


@checked
@dataclass(frozen=True)
class ExactFitness:
    """Length, plus ``c_p (1 + length inside)`` for every part of a segment inside obstacles or walls.

    The obstacles are the exact ones (also where they are concave), grown by the clearance and united with the walls.

    Attributes:
        penalty: c_p in widths of the workspace. From 6 on no path is cheaper by going through an obstacle.
    """

    penalty: float = C_P

    def __post_init__(self) -> None:
        within("penalty", self.penalty, 0)

    @checked
    def on(self, space: FreeSpace, start: Point, goal: Point) -> Overlap:
        """The costs of paths from start to goal in a free space."""
        return Overlap(space, np.array([*start, *goal]), self.penalty * space.extent)


@checked
@dataclass(frozen=True)
class PaperFitness:
    """Eq. 5 of Toz, Erdogmus and Sahin 2011, to the letter: ``f = sum L + sum c_p (1 + h - d)^2``.

    Obstacles are replaced by their convex hulls; h is half the diagonal of a hull's bounding box, d the distance of the
    box's centre from the line of the segment; a segment hits an obstacle if their bounding boxes overlap and the
    obstacle has vertices on both sides of the segment's line (Eq. 4). So a path may be penalised for an obstacle that
    it does not touch, never the reverse; a start or goal in the pocket of a concave obstacle is always penalised.

    Attributes:
        penalty: c_p in widths of the workspace; the paper's 120 by default.
        detour_penalty: p_p, factor for a length above ``detour_limit``.
        detour_limit: That limit, as a multiple of the distance from start to goal.
        detour_of: Whose length: the paper's ``segment``, which is never so long in its workspace, or the ``path``.
    """

    penalty: float = C_P
    detour_penalty: float = 2.2
    detour_limit: float = 3.0
    detour_of: Literal["segment", "path"] = "segment"

    def __post_init__(self) -> None:
        within("penalty", self.penalty, 0)
        within("detour_penalty", self.detour_penalty, 1)
        within("detour_limit", self.detour_limit, 0)
        one_of("detour_of", self.detour_of, Literal["segment", "path"])

    @checked
    def on(self, space: FreeSpace, start: Point, goal: Point) -> Hulls:
        """The costs of paths from start to goal among the hulls of the grown obstacles."""
        return Hulls(space, np.array([*start, *goal]), self)


FITNESSES: dict[str, type[Fitness]] = {"exact": ExactFitness, "paper": PaperFitness}


def make_fitness(fitness: str | Fitness) -> Fitness:
    """A fitness from its name, with its default settings; an object is returned unchanged.

    Raises:
        UnknownName: No fitness of that name.
        InvalidSetting: Neither a name nor an object with a method ``on``.
    """
    if not isinstance(fitness, str):
        if isinstance(fitness, type) or not callable(getattr(fitness, "on", None)):
            raise InvalidSetting(
                f"not a fitness: {shown(fitness)}; give a name or an object with on(space, start, goal)"
            )
        return fitness
    return lookup("fitness", fitness, FITNESSES)()


@dataclass(frozen=True, eq=False)
class Overlap:
    """Length and overlap with obstacles; see ``ExactFitness``.

    Attributes:
        space: The free space.
        ends: Start and goal (4,).
        c_p: Collision constant, in the scene's unit.
    """

    space: FreeSpace
    ends: Array
    c_p: float
    vertices: Array = field(init=False, repr=False)
    after: Counts = field(init=False, repr=False)

    def __post_init__(self) -> None:
        borders = list(rings(self.space.core))
        first = np.cumsum([0, *map(len, borders)])
        after = [start + np.roll(np.arange(len(ring)), -1) for start, ring in zip(first, borders, strict=False)]
        object.__setattr__(self, "vertices", np.ascontiguousarray(np.concatenate(borders)))
        object.__setattr__(self, "after", np.concatenate(after))

    def __call__(self, X: Array) -> Array:
        """Costs (k,) of the via points X (k, 2 n)."""
        return self._both(X)[0]

    def hits(self, X: Array) -> Counts:
        """Stretches inside obstacles (k,)."""
        return self._both(X)[1]

    def _both(self, X: Array) -> tuple[Array, Counts]:
        costs, hits = np.empty(len(X)), np.empty(len(X), dtype=np.int64)
        kernels.overlap_costs(
            np.array(X, dtype=float, order="C"), self.ends, self.vertices, self.after, self.c_p, costs, hits
        )
        return costs, hits


@dataclass(frozen=True, eq=False)
class Hulls:
    """Length and hits of convex obstacle areas; see ``PaperFitness``.

    Attributes:
        space: The free space; its walls are left to the box of the search.
        ends: Start and goal (4,).
        fitness: The settings.
    """

    space: FreeSpace
    ends: Array
    fitness: PaperFitness

    @cached_property
    def hulls(self) -> list[shapely.Polygon]:
        """The convex obstacle areas."""
        space = self.space
        grown = (
            shapely.union_all(grow((each,), space.clearance_of(each), space.join)) for each in space.scene.obstacles
        )
        return [region.convex_hull for region in grown]

    @cached_property
    def _arrays(self) -> tuple[Array, Counts, Array]:
        """Vertices (m, 2), offsets (obstacles + 1,) and penalty areas (obstacles, 7) as the kernel takes them."""
        corners = [shapely.get_coordinates(hull.exterior)[:-1] for hull in self.hulls]
        boxes = np.array([hull.bounds for hull in self.hulls]).reshape(-1, 4)
        centres = (boxes[:, :2] + boxes[:, 2:]) / 2
        h = np.hypot(*(boxes[:, 2:] - boxes[:, :2]).T) / 2
        offsets = np.cumsum([0, *map(len, corners)])
        vertices = np.ascontiguousarray(np.concatenate([np.empty((0, 2)), *corners]))
        return vertices, offsets, np.ascontiguousarray(np.column_stack((boxes, centres, h)))

    def __call__(self, X: Array) -> Array:
        """Costs (k,) of the via points X (k, 2 n)."""
        return self._both(X)[0]

    def hits(self, X: Array) -> Counts:
        """Pairs of a segment and an obstacle it hits (k,)."""
        return self._both(X)[1]

    def segment_hits(self, segments: Array) -> NDArray[np.bool_]:
        """Which obstacles segments (k, 4) from x, y to x, y hit by the paper's test (k, obstacles)."""
        hits = np.empty((len(segments), len(self.hulls)), dtype=bool)
        kernels.segment_hits(np.array(segments, dtype=float, order="C"), *self._arrays, hits)
        return hits

    def _both(self, X: Array) -> tuple[Array, Counts]:
        settings = self.fitness
        d_u = float(np.hypot(*(self.ends[2:] - self.ends[:2])))
        costs, hits = np.empty(len(X)), np.empty(len(X), dtype=np.int64)
        kernels.paper_costs(
            np.array(X, dtype=float, order="C"),
            self.ends,
            *self._arrays,
            settings.penalty * self.space.extent,
            settings.detour_penalty,
            settings.detour_limit * d_u,
            settings.detour_of == "path",
            costs,
            hits,
        )
        return costs, hits
