"""The world of a robot: its links, grasped objects and obstacles, checked by coal."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TypeAlias, get_args

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import array, checked
from pin_metaik.collision.batch import Ask, answers
from pin_metaik.collision.body import Body, Geometry, geometry_of, robot_bodies
from pin_metaik.collision.checker import Checker
from pin_metaik.collision.contact import Contact, Distance
from pin_metaik.collision.layout import Samples, lay_out, sample
from pin_metaik.collision.move import Move, MoveStatus
from pin_metaik.collision.obstacle import Obstacle, placement
from pin_metaik.collision.padding import Key, Padding, check_padding, entries, names_of, read_padding
from pin_metaik.collision.pairs import Srdf, disabled_pairs
from pin_metaik.collision.passage import Found, Passages
from pin_metaik.collision.shapes import Shape
from pin_metaik.collision.simplify import Simplify, solid_of
from pin_metaik.collision.solids import Solids
from pin_metaik.collision.srdf import Pair, pair_of, write_srdf
from pin_metaik.errors import Cancelled, InvalidConfiguration, InvalidGeometry, InvalidSetting, UnknownName
from pin_metaik.kinematics.model import as_configuration, frame_id
from pin_metaik.optimize.settings import positive, whole
from pin_metaik.output import writable
from pin_metaik.watching import Stopped, Watch

RESOLUTION = 1e-4  # m

AskMove: TypeAlias = Callable[..., float | tuple[float, ...]]


@checked
class CollisionWorld:
    """Collisions of a robot with itself and with obstacles, and of grasped objects with both.

    Two bodies collide when their distance is not above the margin, to a micrometre, or when one is inside the other;
    the original geometry decides. A connected part of a mesh is solid if it is closed, that is, if every edge belongs
    to an even number of its triangles; otherwise it is a sheet, and only its surface collides. A closed part inside
    another one is a hollow. A robot that stands on something touches it and does not collide.

    Queries may run in several threads at once; changes (add, move, remove, attach, detach, allow, check) may not.

    Attributes:
        robot: The robot.
        model: The robot's model, whose configurations q are.
        margin: Distance at or below which two bodies collide, m.
        padding: Distances that are added to the margin, m, by name or pair of names.
        simplify: The simplified geometry that is checked first.
        exact: Whether the original geometry confirms collisions of the simplified one.
        obstacles: The obstacles.
        grasped: The objects that the robot holds, each with the name of the frame that its pose refers to.
        disabled: The pairs that are not checked, with the reason.
    """

    def __init__(
        self,
        robot: Geometry,
        obstacles: Iterable[Obstacle] = (),
        margin: float = 0.0,
        srdf: Srdf = None,
        *,
        simplify: Simplify = "convex",
        exact: bool = True,
        padding: Mapping[Key, float] | None = None,
        visual: bool = True,
        watch: Watch | None = None,
    ) -> None:
        """Load the robot's geometry, find out which links ever touch, and put up the obstacles.

        Args:
            robot: A robot with collision geometry: a ``Robot``, or any object with ``name``, ``model``,
                ``collision_model`` and ``srdf`` (None or a path); or Pinocchio's ``RobotWrapper``.
            obstacles: What stands in the world; more can be added later.
            margin: Distance at or below which two bodies collide, m. It is not kept between: links that mostly are
                nearer to each other, as they are built so (they must only not touch); pairs that ``disabled`` names,
                which are not checked at all; and the robot's base and what stands, as neither can come nearer (they
                must only not overlap). A padding of the pair itself is kept in the first and the last case, too.
            srdf: A file with the pairs of links not to check; default: the robot's own, if it has one; ``False``: none.
                Neighbours, links that always touch and links that never do are found out either way.
            simplify: ``"convex"`` hulls or ``"capsule"``s are checked before the original geometry, or ``"none"``.
            exact: Ask the original geometry where simplified solids touch. Without it they decide, which is a little
                quicker, and calls some configurations collisions that are none.
            padding: What is added to the margin, m: by the name of a link or obstacle, in all pairs of it, so that the
                paddings of two add up; by two names, in that pair, instead of theirs. Such as
                ``{"panda_hand": 0.02, ("panda_hand", "table"): 0.05}``. It goes before what obstacles bring.
            visual: Check what a robot without collision geometry looks like, with a warning; otherwise refuse it.
            watch: Called with configurations looked at and in all, once for a robot, while links that ever touch are
                found out; True ends the work.

        Raises:
            Cancelled: The watch ended the work; there is no world yet.
            InvalidGeometry: If the robot has no geometry, or two obstacles have one name.
            InvalidModel: If a mesh of the robot or the SRDF cannot be read.
            InvalidSetting: If the margin or a padding is negative or not finite, or a padding is of a pair that is not
                checked; the message says why it is not.
            UnknownName: If the SRDF, a padding or an obstacle names something that does not exist, or ``simplify`` is
                no level.
        """
        robot = geometry_of(robot)
        if not 0.0 <= margin < math.inf:
            raise InvalidSetting(f"margin is a finite distance of at least 0 m, got {margin!r}")
        if simplify not in get_args(Simplify):
            raise UnknownName("simplification", str(simplify), get_args(Simplify))
        self.robot, self.model, self.margin = robot, robot.model, float(margin)
        self.simplify, self.exact = simplify, exact
        self._links = robot_bodies(robot, simplify, visual)
        self.padding = read_padding(padding or {})
        try:
            self.disabled = disabled_pairs(robot, self._links, srdf, Padding(self.margin, self.padding), watch)
        except Stopped:
            raise Cancelled("a watch ended the work before it was known which links ever touch") from None
        self.obstacles: tuple[Obstacle, ...] = ()
        self.grasped: tuple[tuple[Obstacle, str], ...] = ()
        self._others: dict[str, Body] = {}
        self._samples: Samples = {}
        self._checker: Checker | None = None
        self._passages: Passages | None = None
        given = tuple(obstacles)
        self._take_in([(obstacle, 0, obstacle.pose) for obstacle in given])
        self.obstacles = given
        check_padding(self.padding, self.disabled)
        for key in self.padding:
            for name in names_of(key):
                if name not in self.names:
                    raise UnknownName("body", name, self.names)

    def __getstate__(self) -> dict[str, object]:
        """Pickle without the checks, which hold scratch of this process: they are laid out again."""
        return {**self.__dict__, "_checker": None, "_passages": None}

    @property
    def names(self) -> tuple[str, ...]:
        """Links with geometry, obstacles and grasped objects."""
        return (*dict.fromkeys(body.link for body in self._links), *self._others)

    @property
    def pairs(self) -> dict[Pair, str]:
        """Every pair of names, with the reason why it is not checked; empty where it is."""
        names = sorted(self.names)
        every = (pair_of(a, b) for i, a in enumerate(names) for b in names[:i])
        return {pair: self.disabled.get(pair, "") for pair in every}

    @checked
    def add(self, obstacle: Obstacle) -> None:
        """Add an obstacle.

        Raises:
            InvalidGeometry: If its name is taken.
            UnknownName: If it may touch, or is kept away from, something that does not exist.
        """
        self._take_in([(obstacle, 0, obstacle.pose)])
        self.obstacles = (*self.obstacles, obstacle)

    @checked
    def move(self, name: str, pose: pin.SE3 | ArrayLike) -> None:
        """Move an obstacle to another pose.

        Raises:
            UnknownName: If there is no such obstacle.
            InvalidGeometry: If the pose is not finite and orthonormal.
        """
        known = [obstacle.name for obstacle in self.obstacles]
        if name not in known:
            raise UnknownName("obstacle", name, known)
        there = placement(name, pose)
        self._others[name] = replace(self._others[name], placement=there)
        self.obstacles = tuple(replace(o, pose=there) if o.name == name else o for o in self.obstacles)
        self._checker = None

    @checked
    def remove(self, name: str) -> None:
        """Remove an obstacle or a grasped object.

        Raises:
            UnknownName: If nothing has that name.
        """
        if name not in self._others:
            raise UnknownName("obstacle", name, self._others)
        del self._others[name]
        self.obstacles = tuple(o for o in self.obstacles if o.name != name)
        self.grasped = tuple((o, frame) for o, frame in self.grasped if o.name != name)
        self.disabled = {pair: reason for pair, reason in self.disabled.items() if name not in pair}
        self.padding = {key: m for key, m in self.padding.items() if name not in names_of(key)}
        self._checker = None

    @checked
    def attach(
        self,
        name: str,
        shape: Shape,
        frame: str,
        pose: pin.SE3 | ArrayLike = (0.0, 0.0, 0.0),
        touching: Iterable[str] | None = None,
        padding: float | Mapping[str, float] = 0.0,
    ) -> None:
        """Grasp an object: from now on it moves with a frame and is checked for collisions.

        Args:
            name: What to call it.
            shape: Its shape.
            frame: The frame that holds it.
            pose: Pose of the object in that frame.
            touching: Names of links and obstacles that may touch it; default: the links that move on the frame's own
                link, such as fingers. Links that are fixed to the frame may touch it in any case.
            padding: Distance that is added to the margin, m: one for all its pairs, or one by name of the other body.

        Raises:
            FrameNotFound: If the model has no such frame.
            InvalidGeometry: If the name is taken, the shape is not one of ``Shape``, the pose is not finite and
                orthonormal, or the padding is not a distance.
            UnknownName: If it may touch, or is kept away from, something that does not exist.
        """
        holder = self.model.frames[frame_id(self.model, frame)]
        fingers = [b.link for b in self._links if b.joint and self.model.parents[b.joint] == holder.parentJoint]
        away = padding if isinstance(padding, Mapping) else {}
        touching = (link for link in fingers if link not in away) if touching is None else touching
        held = Obstacle(name, shape, pose, tuple(touching), padding)
        self._take_in([(held, int(holder.parentJoint), holder.placement * held.pose)])
        self.grasped = (*self.grasped, (held, frame))

    @checked
    def detach(self, name: str, q: ArrayLike) -> None:
        """Let go of a grasped object: it stays, as an obstacle, where it is at configuration q (nq,).

        Raises:
            UnknownName: If nothing of that name is grasped.
            InvalidConfiguration: If q is not a configuration of the model.
        """
        held = {obstacle.name: obstacle for obstacle, _ in self.grasped}
        if name not in held:
            raise UnknownName("grasped object", name, held)
        data, body = self.model.createData(), self._others[name]
        pin.forwardKinematics(self.model, data, as_configuration(self.model, q))
        self.remove(name)
        self.add(replace(held[name], pose=data.oMi[body.joint] * body.placement))

    @checked
    def allow(self, first: str, second: str, reason: str = "User") -> None:
        """Do not check a pair any longer.

        Raises:
            UnknownName: If a name is neither a link with geometry, an obstacle nor a grasped object.
        """
        self.disabled[self._pair(first, second)] = reason
        self._checker = None

    @checked
    def check(self, first: str, second: str) -> None:
        """Check a pair that was not checked.

        Raises:
            UnknownName: If a name is neither a link with geometry, an obstacle nor a grasped object.
        """
        self.disabled.pop(self._pair(first, second), None)
        self._checker = None

    @checked
    def write_srdf(self, path: str | Path) -> None:
        """Write the pairs of links that are not checked as an SRDF file, which can be edited and given as ``srdf``."""
        links = {body.link for body in self._links}
        mine = {pair: reason for pair, reason in self.disabled.items() if links.issuperset(pair)}
        write_srdf(writable(path), self.model.name, mine)

    @property
    def checker(self) -> Checker:
        """The current checks."""
        if self._checker is None:
            held = {obstacle.name for obstacle, _ in self.grasped}
            others = self._others.items()
            moving = (*self._links, *(body for name, body in others if name in held))
            standing = tuple(body for name, body in others if name not in held)
            solids = Solids(self.model, moving, standing, Padding(self.margin, self.padding))
            self._samples = sample(solids, self.disabled, self._samples)
            self._checker = lay_out(solids, self._samples, self.disabled, self.exact)
        return self._checker

    def in_collision(self, q: ArrayLike) -> bool:
        """Whether anything collides at configuration q (nq,).

        Raises:
            InvalidConfiguration: If q is not a configuration of the model.
        """
        return self.checker.collides(as_configuration(self.model, q))

    def pairs_in_collision(self, q: ArrayLike) -> tuple[Contact, ...]:
        """The pairs of bodies that collide at configuration q (nq,), the deepest first.

        Raises:
            InvalidConfiguration: If q is not a configuration of the model.
        """
        return self.checker.contacts(as_configuration(self.model, q))

    @checked
    def min_distance(self, q: ArrayLike, *, of: str | None = None) -> Distance:
        """The two bodies nearest to each other at configuration q (nq,), and where; the margin does not count.

        Args:
            q: The configuration.
            of: Name of a body, e.g. an obstacle: then the other is what is nearest to it. Default: any two.

        Raises:
            InvalidConfiguration: If q is not a configuration of the model.
            UnknownName: Nothing has that name.
        """
        if of is not None and of not in self.names:
            raise UnknownName("body", of, self.names)
        return self.checker.nearest(as_configuration(self.model, q), None if of is None else (of,))

    def in_collision_batch(self, Q: ArrayLike, *, workers: int | None = None) -> NDArray[np.bool_]:
        """Whether anything collides, (k,), at configurations Q (k, nq).

        Processes are used where they save time: on two cores from about 100,000 quick checks, or a few thousand that
        take milliseconds each.

        Args:
            Q: Configurations.
            workers: Number of processes; default: one for each core where they are forked and this is the only thread,
                otherwise none. The result does not depend on it. Where processes are spawned instead of forked, a
                script that asks for them needs the guard ``if __name__ == "__main__":``.

        Raises:
            InvalidConfiguration: If a row is not a configuration of the model.
            InvalidSetting: If ``workers`` is less than one.
        """
        return self._answers(_collides, Q, workers).astype(bool)

    def min_distance_batch(self, Q: ArrayLike, *, workers: int | None = None) -> NDArray[np.float64]:
        """Distance (k,) of the nearest two bodies at configurations Q (k, nq), m.

        Args:
            Q: Configurations.
            workers: Processes, as for ``in_collision_batch``.

        Raises:
            InvalidConfiguration: If a row is not a configuration of the model.
            InvalidSetting: If ``workers`` is less than one.
        """
        return self._answers(_nearest, Q, workers)

    def clear_between(self, q0: ArrayLike, q1: ArrayLike, *, resolution: float = RESOLUTION) -> bool:
        """Whether the straight joint move from q0 to q1 (nq,) is proved free of collisions over its whole length.

        See ``first_contact`` for the move; a move that it leaves undecided does not count as free.

        Args:
            q0: Where the move starts.
            q1: Where it ends.
            resolution: m; a move that brings two bodies nearer to their margin than that may count as not free.

        Raises:
            InvalidConfiguration: If q0 or q1 is not a configuration of the model.
            InvalidSetting: If the resolution is not above 0.
            UnsupportedJoint: If a joint of the model is composite.
        """
        positive("resolution", resolution)
        ends = as_configuration(self.model, q0), as_configuration(self.model, q1)
        return _is_clear(self, np.concatenate(ends), resolution)

    def first_contact(self, q0: ArrayLike, q1: ArrayLike, *, resolution: float = RESOLUTION) -> Move:
        """Where the straight joint move from q0 to q1 (nq,) first collides, or the proof that it is free.

        All joints move at once, each at constant speed (``pin.interpolate``). A joint without limits turns the shorter
        way; of two that are equally short, the one that ``Move.at`` follows. Joints with limits move straight through
        their range, those with several degrees of freedom along the shortest twist.

        Freedom from collision is proved for the whole move, not sampled: at the middle of each part of the move, bodies
        are farther apart than their margin plus the distance that they can move until its ends, which is bounded by the
        lever arms of the joints. A collision is reported only at a configuration for which ``in_collision`` is true.

        Args:
            q0: Where the move starts.
            q1: Where it ends.
            resolution: m; a part of the move in which no two bodies move farther than this is not divided further, and
                stays undecided if it is not proved free. An earlier collision than the one found can only be in such a
                part; ``Move.clear`` is where the first of them begins. A move with undecided parts and no collision is
                undecided.

        Raises:
            InvalidConfiguration: If q0 or q1 is not a configuration of the model.
            InvalidSetting: If the resolution is not above 0.
            UnsupportedJoint: If a joint of the model is composite.
        """
        positive("resolution", resolution)
        ends = np.concatenate([as_configuration(self.model, q0), as_configuration(self.model, q1)])
        return self._move(ends, *_first(self, ends, resolution))

    def clear_between_batch(
        self, Q0: ArrayLike, Q1: ArrayLike, *, resolution: float = RESOLUTION, workers: int | None = None
    ) -> NDArray[np.bool_]:
        """Whether each of k moves, from the rows of Q0 (k, nq) to those of Q1, is proved free, (k,).

        Args:
            Q0: Where the moves start.
            Q1: Where they end.
            resolution: As for ``clear_between``.
            workers: Processes, as for ``in_collision_batch``.

        Raises:
            InvalidConfiguration: If a row is not a configuration of the model, or one has more rows than the other.
            InvalidSetting: If ``workers`` is less than one, or the resolution not above 0.
            UnsupportedJoint: If a joint of the model is composite.
        """
        return self._moves(_is_clear, Q0, Q1, resolution, workers).astype(bool)

    def first_contact_batch(
        self, Q0: ArrayLike, Q1: ArrayLike, *, resolution: float = RESOLUTION, workers: int | None = None
    ) -> tuple[Move, ...]:
        """Where each of k moves, from the rows of Q0 (k, nq) to those of Q1, first collides.

        Args:
            Q0: Where the moves start.
            Q1: Where they end.
            resolution: As for ``first_contact``.
            workers: Processes, as for ``in_collision_batch``.

        Raises:
            InvalidConfiguration: If a row is not a configuration of the model, or one has more rows than the other.
            InvalidSetting: If ``workers`` is less than one, or the resolution not above 0.
            UnsupportedJoint: If a joint of the model is composite.
        """
        found = self._moves(_first, Q0, Q1, resolution, workers, width=2)
        ends = np.hstack([np.asarray(Q0, dtype=float), np.asarray(Q1, dtype=float)])
        return tuple(self._move(row, *one) for row, one in zip(ends, found.tolist(), strict=True))

    @property
    def passages(self) -> Passages:
        """The search along moves, with the current checks."""
        if self._passages is None or self._passages.checker is not self.checker:
            self._passages = Passages(self.checker)
        return self._passages

    def _move(self, ends: NDArray[np.float64], clear: float, touch: float) -> Move:
        """What is known of the move between two configurations (2 nq,), by how far it is clear and where it touches."""
        q0, q1 = np.split(ends, 2)
        way, nowhere = self.passages.screws.way(q0, q1), np.full(len(q0), math.nan)
        move = Move(MoveStatus.FREE, clear, touch, nowhere, None, q0.copy(), way, self.model)
        if not math.isnan(touch):
            q = move.at(touch)
            return replace(move, status=MoveStatus.TOUCHES, q=q, contact=self.checker.contacts(q)[0])
        return move if clear == 1.0 else replace(move, status=MoveStatus.UNDECIDED)

    def _moves(
        self,
        ask: AskMove,
        Q0: ArrayLike,
        Q1: ArrayLike,
        resolution: float,
        workers: int | None,
        width: int | None = None,
    ) -> NDArray[np.float64]:
        positive("resolution", resolution)
        starts = array("Q0", Q0, "k", self.model.nq, error=InvalidConfiguration)
        ends = array("Q1", Q1, len(starts), self.model.nq, error=InvalidConfiguration)
        for q0, q1 in zip(starts, ends, strict=True):
            self.passages.screws.way(q0, q1)  # what is wrong with one is told before the work
        return self._shared(partial(ask, resolution=resolution), np.hstack([starts, ends]), workers, width)

    def _answers(self, ask: Ask, Q: ArrayLike, workers: int | None) -> NDArray[np.float64]:
        return self._shared(ask, array("Q", Q, "k", self.model.nq, error=InvalidConfiguration), workers)

    def _shared(
        self, ask: Ask, rows: NDArray[np.float64], workers: int | None, width: int | None = None
    ) -> NDArray[np.float64]:
        if workers is not None:
            whole("workers", workers, 1)
        self.checker  # noqa: B018  # laid out once, not in every process
        return answers(self, ask, rows, workers, width)

    def _take_in(self, new: Sequence[tuple[Obstacle, int, pin.SE3]]) -> None:
        """Take in obstacles, each with the joint that carries it and where it is there: all, or none of them."""
        names = dict.fromkeys(self.names)
        for obstacle, _, _ in new:
            if obstacle.name in names:
                raise InvalidGeometry(f"there is a {obstacle.name!r} in the world already")
            names[obstacle.name] = None
        disabled, padding = dict(self.disabled), dict[Key, float]()
        for obstacle, _, _ in new:
            away = obstacle.padding if isinstance(obstacle.padding, Mapping) else {}
            for other in (*obstacle.touching, *away):
                if other not in names:
                    raise UnknownName("body", other, names)
            disabled |= {pair_of(obstacle.name, other): "Touching" for other in obstacle.touching}
            padding |= entries(obstacle.name, obstacle.padding)
        check_padding(padding, disabled)
        padding |= self.padding  # what was given to the world goes before what an obstacle brings
        bodies = {
            obstacle.name: Body(
                obstacle.name, joint, at, solid_of(obstacle.shape.geometry(), self.simplify, robot=False)
            )
            for obstacle, joint, at in new
        }
        self._others |= bodies
        self.disabled, self.padding, self._checker = disabled, padding, None

    def _pair(self, first: str, second: str) -> Pair:
        for name in (first, second):
            if name not in self.names:
                raise UnknownName("body", str(name), self.names)
        return pair_of(first, second)

    def __repr__(self) -> str:
        checked = sum(not reason for reason in self.pairs.values())
        return f"CollisionWorld({self.robot.name}: {len(self.obstacles)} obstacles, {checked} pairs checked)"


def _collides(world: CollisionWorld, q: NDArray[np.float64]) -> float:
    return world.checker.collides(q)


def _is_clear(world: CollisionWorld, ends: NDArray[np.float64], resolution: float) -> bool:
    q0, q1 = np.split(ends, 2)
    return world.passages.free(q0, world.passages.screws.way(q0, q1), resolution)


def _first(world: CollisionWorld, ends: NDArray[np.float64], resolution: float) -> Found:
    q0, q1 = np.split(ends, 2)
    return world.passages.first(q0, world.passages.screws.way(q0, q1), resolution)


def _nearest(world: CollisionWorld, q: NDArray[np.float64]) -> float:
    return world.checker.nearest(q).distance
