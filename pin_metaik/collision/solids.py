"""Bodies at three levels of detail, and where a configuration puts them: what pairs of them are asked by.

What joints carry is placed by Pinocchio, for each thread in scratch of its own. What stands was placed once, and costs
a check nothing until something comes near.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from threading import local
from typing import Any, NamedTuple, cast

import coal
import numpy as np
import pinocchio as pin
from numpy.lib.stride_tricks import as_strided
from numpy.typing import NDArray

from pin_metaik.collision.body import Body
from pin_metaik.collision.extent import centre, is_flat
from pin_metaik.collision.interior import Interior
from pin_metaik.collision.narrow import apart, touching
from pin_metaik.collision.padding import Padding
from pin_metaik.collision.simplify import Solid

ROOM = 256  # pairs that scratch has room for at first


class Level(NamedTuple):
    """One level of detail of a body.

    Attributes:
        geometry: As coal has it.
        pose: Its row among the poses.
        point: (1, 3) a point inside, in its frame, m; of no use for a mesh.
        mesh: The solid whose mesh it is; None where it is none.
    """

    geometry: Any
    pose: int
    point: NDArray[np.float64]
    mesh: Solid | None


class Levels(NamedTuple):
    """The levels of detail of a body, each inside the one before: coarse, hull and fine.

    Attributes:
        first: The level that is asked first, against a body with thickness and against one that is flat.
        last: The level that has the last word, against the same two.
        hull: Its hull.
        fine: The geometry as it is.
        flat: Whether it is a half-space or a plane, which meets a mesh exactly where it meets its hull.
    """

    first: tuple[Level, Level]
    last: tuple[Level, Level]
    hull: Level
    fine: Level
    flat: bool

    @staticmethod
    def of(body: Body, pose: int, coarse_pose: int) -> Levels:
        """The levels of a body; ``pose`` is the row of its original's pose, ``coarse_pose`` that of the first level."""
        solid = body.solid
        fine = _level(solid, solid.original, pose)
        hull = fine if solid.hull is solid.original else _level(solid, solid.hull, pose)
        known = {id(solid.original): fine, id(solid.hull): hull}
        coarse = known.get(id(solid.coarse)) or _level(solid, solid.coarse, coarse_pose)
        return Levels((coarse, hull), (fine, hull), hull, fine, is_flat(solid.original))


def _level(solid: Solid, geometry: Any, pose: int) -> Level:
    return Level(geometry, pose, centre(geometry), solid if isinstance(geometry, coal.BVHModelBase) else None)


@dataclass(frozen=True, eq=False)
class Pairs:
    """Which pairs of bodies are asked about, and how near they may be.

    Attributes:
        own: (p, 2) pairs of bodies that move.
        margins: (p,) the distance of each at or below which it collides, m.
        against: (m, s) which bodies that move are asked about against which that stand.
        margin: The distance of these at or below which they collide, m; their paddings come on top.
    """

    own: NDArray[np.int64]
    margins: NDArray[np.float64]
    against: NDArray[np.bool_]
    margin: float


@dataclass(frozen=True, eq=False)
class Solids:
    """Bodies that joints carry, and bodies that stand; numbered in this order.

    Attributes:
        model: The robot's model.
        moving: Bodies that joints carry, with what Pinocchio's world joint carries of the robot.
        standing: Bodies that stand in the world.
        padding: How far apart they are kept.
    """

    model: pin.Model
    moving: tuple[Body, ...]
    standing: tuple[Body, ...] = ()
    padding: Padding = field(default_factory=Padding)
    _local: local = field(init=False, default_factory=local, repr=False)

    @cached_property
    def geometry(self) -> pin.GeometryModel:
        """What Pinocchio places: every moving body, then those first levels that lie elsewhere in it."""
        geometry = pin.GeometryModel()
        for number, body in enumerate(self.moving):
            geometry.addGeometryObject(pin.GeometryObject(f"{number}", body.joint, body.placement, body.solid.original))
        for number in self._shifted:
            body = self.moving[number]
            placement = body.placement * body.solid.offset
            geometry.addGeometryObject(pin.GeometryObject(f"{number}'", body.joint, placement, body.solid.coarse))
        return geometry

    @cached_property
    def levels(self) -> Mapping[int, Levels]:
        """The levels of every body, by its number; made when it is first near another one."""
        return _Made(self._levels_of)

    def _levels_of(self, number: int) -> Levels:
        count = len(self.moving)
        if number < count:
            return Levels.of(self.moving[number], number, self._shifted.get(number, number))
        pose = number + len(self._shifted)
        return Levels.of(self.standing[number - count], pose, pose)

    @cached_property
    def boxes(self) -> NDArray[np.float64]:
        """(m, 8) the boxes of what moves, in its frames, as ``boxes.near`` takes them."""
        boxes = np.array([body.solid.box for body in self.moving]).reshape(-1, 7)
        return np.column_stack([boxes, self._paddings(self.moving)])

    @cached_property
    def stood(self) -> NDArray[np.float64]:
        """(s, 17) the boxes of what stands, in the world, as ``boxes.near`` takes them."""
        boxes = np.array([body.stood for body in self.standing]).reshape(-1, 16)
        return np.column_stack([boxes, self._paddings(self.standing)])

    def _paddings(self, bodies: tuple[Body, ...]) -> list[float]:
        return [self.padding.most(body.link) for body in bodies]

    @cached_property
    def _shifted(self) -> dict[int, int]:
        """Rows of the poses of those first levels that lie elsewhere in their body than the others, by body."""
        elsewhere = [k for k, body in enumerate(self.moving) if not body.solid.offset.isIdentity()]
        return {number: len(self.moving) + row for row, number in enumerate(elsewhere)}

    def place(self, q: NDArray[np.float64]) -> Placed:
        """The bodies where they are at q (nq,); until this thread places them somewhere else."""
        placed: Placed | None = getattr(self._local, "placed", None)
        if placed is None:
            placed = self._local.placed = Placed(self)
        placed.move(q)
        return placed


class Placed:
    """Bodies where a configuration has put them; scratch of one thread."""

    def __init__(self, solids: Solids) -> None:
        """Room for the poses of all bodies and for coal's answers."""
        from pin_metaik.collision.boxes import near

        self.solids = solids
        self.data, self.shapes = solids.model.createData(), solids.geometry.createData()
        self.poses, self.joints = _poses(self.shapes.oMg), _poses(self.data.oMi)
        self.moving = len(self.poses)
        self._turns = [pose[:9].reshape(3, 3).T for pose in self.poses]
        self._shifts = [pose[9:] for pose in self.poses]
        self._at = [coal.Transform3s() for _ in self.poses] + [body.at for body in solids.standing]
        self._fresh: set[int] = set()
        self._collision, self._distance = coal.CollisionResult(), coal.DistanceResult()
        self._boxes = np.empty((len(solids.moving), 17))
        self._found, self._least = np.empty((ROOM, 3), dtype=np.int64), np.empty(ROOM)
        self._near = cast(Any, near).compiled()  # a frame less

    def move(self, q: NDArray[np.float64]) -> None:
        """Put what joints carry where it is at q (nq,)."""
        pin.updateGeometryPlacements(self.solids.model, self.data, self.solids.geometry, self.shapes, q)
        self._fresh.clear()

    def at(self, pose: int) -> Any:
        """A pose as coal takes it, ``coal.Transform3s``."""
        if pose < self.moving and pose not in self._fresh:
            self._at[pose].setTransform(self._turns[pose], self._shifts[pose])
            self._fresh.add(pose)
        return self._at[pose]

    def near(self, pairs: Pairs, beyond: float = 0.0) -> list[list[int]]:
        """The pairs whose boxes are not farther apart than their margin and ``beyond``, m.

        Returns:
            Numbers of both bodies, and the pair's row in ``pairs.own`` or -1; the likeliest to collide first.
        """
        solids = self.solids
        own, margins, stood = pairs.own, pairs.margins, solids.stood
        asked = pairs.against, pairs.margin, beyond
        count = self._near(self.poses, solids.boxes, own, margins, stood, *asked, self._boxes, self._found, self._least)
        if count > len(self._found):
            self._found, self._least = np.empty((2 * count, 3), dtype=np.int64), np.empty(2 * count)
            return self.near(pairs, beyond)
        found: list[list[int]] = self._found[:count].tolist() if count else []
        return found

    @property
    def least(self) -> NDArray[np.float64]:
        """Distances (m) that the pairs ``near`` found last are at least apart by their boxes, in the same order."""
        return self._least

    def bounds(self, pairs: Pairs) -> NDArray[np.float64]:
        """Distances (p,) that the pairs that move are at least apart by their boxes, m; below 0 where these overlap."""
        rows = [row for _, _, row in self.near(pairs, math.inf)]
        bounds = np.empty(len(rows))
        bounds[rows] = self._least[: len(rows)]
        return bounds

    def overlap(self, a: Level, b: Level, margin: float) -> bool:
        """Whether two bodies are no farther apart than a margin (m), or one lies inside the other."""
        return self.meet(a, b, margin) or self.nested(a, b)

    def meet(self, a: Level, b: Level, margin: float) -> bool:
        """Whether two bodies, meshes by their surfaces, are no farther apart than a margin, m."""
        self._collision.clear()
        met = coal.collide(a.geometry, self.at(a.pose), b.geometry, self.at(b.pose), touching(margin), self._collision)
        return bool(met)

    def nested(self, a: Level, b: Level) -> bool:
        """Whether one of two bodies is a mesh that has a corner or the middle of a component of the other inside."""
        return (a.mesh is not None and self._holds(a, b)) or (b.mesh is not None and self._holds(b, a))

    def distance(self, a: Level, b: Level) -> float:
        """Distance of two bodies, meshes by their surfaces, m; of solids that overlap minus their depth."""
        self._distance.clear()
        return float(coal.distance(a.geometry, self.at(a.pose), b.geometry, self.at(b.pose), apart(), self._distance))

    def gap(self, a: Level, b: Level) -> float:
        """Distance of two bodies, m; at most 0 where they overlap, and minus their depth if neither is a mesh."""
        distance = self.distance(a, b)
        return min(distance, 0.0) if self.nested(a, b) else distance

    @property
    def points(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The nearest points (3,) of the two bodies whose distance was asked for last, in the world, m."""
        return np.array(self._distance.getNearestPoint1()), np.array(self._distance.getNearestPoint2())

    @property
    def normal(self) -> NDArray[np.float64]:
        """(3,) unit vector from the first to the second of them; NaN or zero where there is none."""
        return np.array(self._distance.normal)

    def _holds(self, mesh: Level, other: Level) -> bool:
        assert mesh.mesh is not None
        interior: Interior = mesh.mesh.interior
        points = other.point if other.mesh is None else other.mesh.interior.points
        return interior.holds(self.row(mesh.pose), points, self.row(other.pose))

    def row(self, pose: int) -> NDArray[np.float64]:
        """A pose as numbers (12,): rotation column by column, then translation."""
        row: NDArray[np.float64] = (
            self.poses[pose] if pose < self.moving else self.solids.standing[pose - self.moving].row
        )
        return row


class _Made(dict[int, Levels]):
    """What is made of a number when it is first asked for."""

    def __init__(self, make: Callable[[int], Levels]) -> None:
        super().__init__()
        self._make = make

    def __missing__(self, number: int) -> Levels:
        made = self[number] = self._make(number)
        return made


def _poses(placements: Any) -> NDArray[np.float64]:
    """A view (n, 12) of Pinocchio's placements, which lie one behind the other: rotation by columns, translation."""
    if not len(placements):
        return np.empty((0, 12))
    first = placements[0].rotation
    step = placements[1].rotation.ctypes.data - first.ctypes.data if len(placements) > 1 else first.nbytes
    return as_strided(first, (len(placements), 12), (step, first.itemsize))
