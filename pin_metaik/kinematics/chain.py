"""A chain: the joints of a Pinocchio model that move one or several frames, and their coordinates."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import cached_property, lru_cache
from threading import Lock
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import array, checked, shown
from pin_metaik.errors import FixedFrame, InvalidConfiguration, InvalidSetting, InvalidTarget
from pin_metaik.kinematics.closed_form import NOMINAL, closed_form
from pin_metaik.kinematics.frame_fk import FrameFK, PinocchioData
from pin_metaik.kinematics.joints import Parts, leader_of, parts_of, velocities
from pin_metaik.kinematics.kernel.layout import LEAF, REACH, Entries, Floats, Ints, Packed, Samples, pack
from pin_metaik.kinematics.limits import Limits
from pin_metaik.kinematics.model import (
    HasModel,
    as_configuration,
    check_turns,
    coordinates_of,
    entries_of,
    frame_id,
    joint_id,
    limits_of,
    model_of,
    names_of,
    neutral_inside,
)
from pin_metaik.kinematics.own_limits import with_own
from pin_metaik.kinematics.paths import base_moves, chain_arrays
from pin_metaik.kinematics.proofs.arm import WHOLE, Free, ProofArm, proof_arm
from pin_metaik.kinematics.proofs.boxes import TINY, Boxes
from pin_metaik.kinematics.proofs.closed_forms import ClosedFormProof
from pin_metaik.kinematics.reach import Reach, reach_of
from pin_metaik.kinematics.roots.six_joints import Configurations, SixJoints, six_joints
from pin_metaik.kinematics.sample_table import SEED, SampleTable, build_table, no_samples
from pin_metaik.optimize import Box
from pin_metaik.optimize.settings import few
from pin_metaik.randomness import DEFAULT_SEED, as_generator
from pin_metaik.robots.pickling import reduce_model

if TYPE_CHECKING:
    from pin_metaik.kinematics.kernel.entry import Kernels

RESTARTS = 256  # random starts of the pose solver
REMEMBERED = 16  # sets of samples kept, and chains whose held joints are elsewhere
REMADE = 16  # chains kept that came out of pickles


Solved: TypeAlias = tuple[int, tuple[float, float, float], tuple[float, float, float, float]]


class PoseSolver(NamedTuple):
    """The compiled pose solver of a chain: its loops, and what they take of the chain; see ``kernel.pose_solver``.

    Attributes:
        block: The chain as ``pack`` has it.
        rows: (3, 2) those of a position alone; None for whole poses.
        starts: (RESTARTS, n) drawn with the default seed.
        solve_directly: By closed form only; None without one.
        solve_pose: By all means.
    """

    block: Floats
    rows: Ints | None
    starts: Floats
    solve_directly: Callable[[Floats, Floats, Floats], Solved] | None
    solve_pose: Callable[[Floats, Ints | None, Floats, Floats, Floats, Floats], Solved]


@checked
class Chain:
    """The joints that move one or several frames of a ``pin.Model``, as n coordinates with limits.

    A coordinate is a revolute, prismatic, continuous or helical joint, or one degree of freedom of a joint with
    several: a floating base is ``root_joint.x``, ``.y``, ``.z``, ``.yaw``, ``.pitch`` and ``.roll``. Mimic joints
    follow theirs; all other joints are held. ``paths``, ``poses``, ``reach``, ``sample_table`` and ``branches`` are
    valid with the held joints at ``reference``; ``at(q)`` is the same chain with the held joints at q, which is the one
    that solvers use. The model is never written to.

    Attributes:
        model: The model.
        frames: Names of the T frames.
        names: Names of the n coordinates: that of the joint and, if it has several, of its degree of freedom.
        limits: Their limits.
        reference: (nq,) the configuration that joints outside the chain are held at.
        held: Indices into q of joints that move the frames but are not coordinates, because they are locked or follow a
            locked joint; usually empty.
        has_pose_solver: Whether ``pose_solver`` exists: it does for a chain with one frame and at least one joint that
            can move.
        movers: Ids of all joints of the model that the coordinates move, mimic joints included.
        paths: The joints from the base to each frame, as arrays.
        kernels: The compiled functions, which take the chain as its ``block``.
        tip: Pinocchio's placement of the first frame.
    """

    def __init__(
        self,
        model: pin.Model | HasModel,
        frame: str | Iterable[str],
        *,
        locked: Iterable[str] = (),
        limits: Mapping[str, tuple[float, float]] | None = None,
        reference: ArrayLike | None = None,
    ) -> None:
        """Find the joints that move ``frame``.

        Args:
            model: Any Pinocchio model, or a robot that has one: a ``Robot``, or Pinocchio's ``RobotWrapper``.
            frame: A frame's name, or several that are to be placed at once.
            locked: Joints on the way that shall stay where they are; of one that mimics another, the other is locked.
            limits: Ranges (lower, upper) in rad or m that replace the model's, by joint name; those of a joint that
                mimics one of the chain bind the one it mimics.
            reference: (nq,) configuration of the joints that are not moved, unless a solver is given ``q0``; also where
                searches without ``q0`` start, inside the limits. Default: neutral, inside the limits.

        Raises:
            FrameNotFound: If the model has no such frame.
            FixedFrame: If no joint is left that moves it.
            UnsupportedJoint: If a joint on the way is not made of turns and slides about fixed axes (lock it).
            UnknownName: If a locked joint does not exist.
            InvalidBounds: If limits are crossed or NaN, or those of joints that move together leave no room.
            InvalidConfiguration: If ``reference`` is not a configuration of the model.
            InvalidSetting: If ``model`` is no robot, or no frame is named.
        """
        self.model = model = model_of(model)
        self._made_from = (model, frame, tuple(locked), dict(limits or {}))
        self.frames = (frame,) if isinstance(frame, str) else tuple(frame)
        if not self.frames:
            raise InvalidSetting("name at least one frame for the chain to place, got none")
        self.frame_ids = tuple(frame_id(model, name) for name in self.frames)

        held = {leader_of(model, joint_id(model, name)) for name in locked}
        on_path = {j for f in self.frame_ids for j in list(model.supports[model.frames[f].parentJoint])[1:]}
        parts = {j: parts_of(model, j) for j in sorted(on_path - held) if leader_of(model, j) not in held}
        motions = {j: part.motions for j, part in parts.items()}
        drivers = sorted({leader_of(model, j) for j in motions}, key=lambda j: int(model.joints[j].idx_v))
        parts |= {j: parts_of(model, j) for j in drivers if j not in parts}
        for name, f in zip(self.frames, self.frame_ids, strict=True):
            if not motions.keys() & set(model.supports[model.frames[f].parentJoint]):
                raise FixedFrame(
                    f"no joint moves frame {name!r}" + (f" while {sorted(locked)} are locked" if held else "")
                )

        self.names = names_of(model, drivers, parts)
        self.coordinates = coordinates_of(model, drivers, parts)
        self.movers = frozenset(j for j in range(1, model.njoints) if leader_of(model, j) in drivers)
        self.limits = self._limits(parts, drivers, dict(limits or {}))
        self._held_joints = sorted({leader_of(model, j) for j in on_path - motions.keys()})
        self._held = entries_of(model, self._held_joints)
        self.held = tuple(self._held.tolist())
        self._motions = motions
        plain, entries = self.coordinates.plain, self.coordinates.plain_q
        self._least, self._most = np.full(model.nq, -np.inf), np.full(model.nq, np.inf)
        self._least[entries], self._most[entries] = self.limits.lower[plain], self.limits.upper[plain]
        self.has_pose_solver = len(self.frames) == 1 and not self.limits.rigid and self.coordinates.single
        self.kernels = _kernels()
        self._own = PinocchioData(model)
        self.tip = FrameFK(model, self.frame_ids[0])
        self._samples: dict[tuple[int, tuple[int, ...]], NDArray[np.float64]] = {}
        self._original, self._elsewhere, self._lock = self, dict[bytes, Chain](), Lock()
        self._hold(self.configuration(neutral_inside(model) if reference is None else reference))

    def _limits(self, parts: dict[int, Parts], drivers: list[int], given: dict[str, tuple[float, float]]) -> Limits:
        """Limits of the coordinates, with those of the caller for them or for joints that follow them."""
        model = self.model
        followers = self.movers.difference(drivers)
        alike = {
            j for j in followers if j in parts and [(m.rotates, m.scale) for m in parts[j].motions] == [(True, 1.0)]
        }
        mimicked = {leader_of(model, j) for j in followers - alike}
        own = {name: span for name, span in given.items() if name not in {model.names[j] for j in followers}}
        limits = with_own(limits_of(model, drivers, parts, mimicked), own)
        for j in followers:
            if model.names[j] in given:
                mimic = model.joints[j].extract()
                leader = model.names[leader_of(model, j)]
                line = float(mimic.scaling), float(mimic.offset)
                limits = limits.bound(leader, line, model.names[j], given[model.names[j]])
        return limits

    def _hold(self, reference: NDArray[np.float64]) -> None:
        """Fold the held joints into the way to the frames, where ``reference`` (nq,) has them."""
        check_turns(self.model, self._held_joints, reference)
        self.reference = reference
        self.paths = chain_arrays(
            self.model, self.data, self.frame_ids, self.coordinates.columns, self._motions, reference
        )
        self._moves = None if self is self._original else base_moves(self._original.paths, self.paths)
        self._reaches: dict[tuple[int, bool], Reach] = {}
        self._proof_arms: dict[tuple[int, Free], ProofArm | None] = {}

    def at(self, q: ArrayLike) -> Chain:
        """The same chain with its held joints as in q (nq,); itself, if they are already so.

        The last few of these chains are cached.

        Raises:
            InvalidConfiguration: If q is not a configuration of the model.
        """
        if not self.held:
            return self
        entries = as_configuration(self.model, q)[self._held]
        for chain in (self, self._original):
            if np.array_equal(entries, chain.reference[self._held]):
                return chain
        key = entries.tobytes()
        with self._lock:
            kept = self._elsewhere
            found = kept.pop(key) if key in kept else self._original._moved(entries)
            kept[key] = found  # the last one used comes last
            if len(kept) > REMEMBERED:
                del kept[next(iter(kept))]
        return found

    def _moved(self, entries: NDArray[np.float64]) -> Chain:
        """This chain with its held joints at other entries (h,); what depends on them is worked out when asked for."""
        chain, kind = object.__new__(type(self)), type(self)
        own = {name for name in vars(self) if not isinstance(getattr(kind, name, None), cached_property)}
        chain.__dict__ |= {name: vars(self)[name] for name in own}
        reference = self.reference.copy()
        reference[self._held] = entries
        chain._hold(reference)
        return chain

    @property
    def data(self) -> pin.Data:
        """A ``pin.Data`` of this model for the calling thread."""
        return self._own.data

    def __reduce__(self) -> tuple[object, ...]:
        """Pickle by what the chain was made from, kilobytes; equal pickles are one chain where they are read.

        Raises:
            InvalidModel: If the model cannot be pickled; see ``pin_metaik.robots.pickling``.
        """
        return _remade, self._recipe

    @cached_property
    def _recipe(self) -> tuple[object, ...]:
        """What ``_remade`` takes: plain values, to be compared."""
        model, _, locked, limits = self._made_from
        ranges = tuple((name, float(lower), float(upper)) for name, (lower, upper) in limits.items())
        return *reduce_model(model), self.frames, locked, ranges, tuple(self.reference.tolist())

    @property
    def n(self) -> int:
        """Number of coordinates."""
        return len(self.names)

    def q(self, x: ArrayLike, q0: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """Configurations (..., nq) at coordinates x (..., n); other joints stay as in ``q0`` (default: reference)."""
        coordinates = array("x", x, "...", self.n, error=InvalidConfiguration, finite=False)
        q = np.empty((*coordinates.shape[:-1], self.model.nq))
        q[...] = self.reference if q0 is None else self._like("q0", q0, q.shape)
        self.coordinates.write(coordinates, q)
        return q

    def x(self, q: ArrayLike) -> NDArray[np.float64]:
        """Coordinates (..., n) of configurations q (..., nq); continuous joints as an angle in (-pi, pi]."""
        return self.coordinates.read(self._like("q", q))

    def unwrapped(self, Q: ArrayLike) -> NDArray[np.float64]:
        """Coordinates (k, n) of a sequence of configurations Q (k, nq); angles of continuous joints are unwrapped."""
        x, periodic = self.x(array("Q", Q, "k", self.model.nq, error=InvalidConfiguration)), self.limits.periodic
        x[:, periodic] = np.unwrap(x[:, periodic], axis=0)
        return x

    def configuration(self, q: ArrayLike) -> NDArray[np.float64]:
        """A configuration (nq,) as given, checked, and with every joint moved inside its limits.

        Raises:
            InvalidConfiguration: If its length is not nq, an entry is not finite, or a quaternion has not length 1.
        """
        inside = np.minimum(np.maximum(as_configuration(self.model, q), self._least), self._most)
        if not self.coordinates.single:
            check_turns(self.model, sorted(self.coordinates.columns), inside)
            self.coordinates.write(self.limits.clip(self.coordinates.read(inside)), inside)
        return inside

    def tangent(self, x: ArrayLike) -> NDArray[np.float64]:
        """(nv, n) derivative of Pinocchio's velocity v by the velocities of the coordinates, at x (n,)."""
        x = array("x", x, self.n, error=InvalidConfiguration)
        constant, varying = self._tangents
        T = constant.copy()
        for kind, rows, columns in varying:
            T[rows, columns] = velocities(kind, x[columns])
        return T

    @cached_property
    def _tangents(self) -> tuple[NDArray[np.float64], list[tuple[pin.JointModel, slice, slice]]]:
        """(nv, n) the part of ``tangent`` that does not depend on x, and the joints with several coordinates."""
        constant, varying = np.zeros((self.model.nv, self.n)), []
        for joint, column in self.coordinates.columns.items():
            kind = self.model.joints[joint]
            if kind.nv == 1:
                constant[kind.idx_v, column] = 1.0
            else:
                varying.append((kind, slice(kind.idx_v, kind.idx_v + kind.nv), slice(column, column + kind.nv)))
        return constant, varying

    def keeps_limits(self, q: NDArray[np.float64]) -> bool:
        """Whether q (nq,) is inside the limits; angles stored as cosine and sine or quaternion to within 1e-12 rad."""
        x, rounding = self.coordinates.read(self._like("q", q, (self.model.nq,))), self.coordinates.rounding
        if rounding is None:
            return self.limits.contains(x)
        limits = self.limits
        return bool(((limits.lower - rounding <= x) & (x <= limits.upper + rounding)).all())

    def inside(self, q: NDArray[np.float64]) -> NDArray[np.float64]:
        """q (..., nq) clipped to the limits; angles stored as cosine and sine, and quaternions, are left unchanged."""
        return np.minimum(np.maximum(self._like("q", q), self._least), self._most)

    def _like(self, name: str, q: ArrayLike, shape: tuple[int, ...] | None = None) -> NDArray[np.float64]:
        """Configurations (..., nq) of the caller, checked; with a shape, of that shape, or one (nq,) for all."""
        given = array(name, q, "...", self.model.nq, error=InvalidConfiguration, finite=False)
        return given if shape is None or given.ndim == 1 else array(name, given, *shape, error=InvalidConfiguration)

    @cached_property
    def box(self) -> Box:
        """The finite box to search in: the limits, or one turn for joints that have none.

        Raises:
            InvalidBounds: If a sliding joint has no finite limits.
        """
        return self.limits.box()

    @cached_property
    def sample_table(self) -> SampleTable:
        """Sampled configurations to look up starts by pose; made on first use in about 5 ms, always the same.

        Where held joints only move the chain as a whole, being before its first joint, the same table is transformed.
        """
        if self._moves is not None:
            return self._original.sample_table.moved(self._moves)
        X = self.limits.one_turn().box().sample(np.random.default_rng(SEED), LEAF * LEAF)
        return build_table(X, self.poses(X), self._gains)

    @cached_property
    def form(self) -> NDArray[np.float64]:
        """The parameters of the arm's closed form; no rows, if it has none."""
        return closed_form(self.paths)

    @cached_property
    def form_proof(self) -> ClosedFormProof | None:
        """The decision by the arm's closed form whether it reaches a pose; None if it has no closed form."""
        return ClosedFormProof.of(self.form, self.paths, self.limits) if len(self.form) else None

    @cached_property
    def nominal_proof(self) -> ClosedFormProof | None:
        """The same by the closed form of the nominal arm, from which this (calibrated) arm differs a little."""
        if len(self.form):
            return self.form_proof
        nominal = closed_form(self.paths, NOMINAL)
        return ClosedFormProof.of(nominal, self.paths, self.limits) if len(nominal) else None

    @cached_property
    def _six_joints(self) -> SixJoints | None:
        """What finds all configurations for a pose, real and complex; made on first use, in about 0.1 s."""
        return six_joints(self.paths)

    def _configurations(self, pose: NDArray[np.float64], most: int) -> Configurations | None:
        """All configurations for a world pose (4, 4) of the frame; None, if this is no chain of six of one frame.

        They are those that ``most`` evaluations find.
        """
        if self._moves is not None:
            return self._original._configurations(np.linalg.inv(self._moves[0]) @ pose, most)
        return None if self._six_joints is None else self._six_joints.at(pose, most)

    def _boxes(
        self,
        tip: int,
        pose: NDArray[np.float64],
        near: float,
        aligned: float,
        free: Free = WHOLE,
        *,
        least: float = TINY,
        shrink: bool = False,
        begin: NDArray[np.float64] | None = None,
    ) -> Boxes | None:
        """All configurations inside the limits, to be excluded for a target; None, where they have no bounds.

        Args:
            tip: Number of the frame.
            pose: (4, 4) its world pose.
            near: How far (m) from it the frame may be; ``inf``: anywhere.
            aligned: By how much (rad) it may be turned about axes that are not free.
            free: Which turns about the frame's own axes x, y and z are free.
            least: Half width (rad or m) below which a box is kept instead of split.
            shrink: Whether boxes are shrunk around solutions; without, those kept tell nothing of a wrist's joints.
            begin: (b, 2 n) centres and half widths of boxes outside of which there is known to be no solution.
        """
        if self._moves is not None:
            moved = np.linalg.inv(self._moves[tip]) @ pose
            return self._original._boxes(tip, moved, near, aligned, free, least=least, shrink=shrink, begin=begin)
        if (tip, free) not in self._proof_arms:
            self._proof_arms[tip, free] = proof_arm(self.paths, self.limits, tip, free)
        arm = self._proof_arms[tip, free]
        return None if arm is None else Boxes(arm.shrinking if shrink else arm, pose, near, aligned, least, begin)

    def branches(self, pose: NDArray[np.float64], x0: NDArray[np.float64]) -> NDArray[np.float64]:
        """Coordinates (b, n) of the branches of the arm's closed form for a pose (4, 4), the branch of x0 (n,) first.

        A joint that a singularity leaves undetermined keeps its value in x0. Empty, (0, n), without a closed form.
        """
        pose, x0 = array("pose", pose, 4, 4, error=InvalidTarget), array("x0", x0, self.n, error=InvalidConfiguration)
        out = np.empty((8, self.n))
        if not len(self.form):
            return out[:0]
        return out[: self.kernels.all_branches(self.form, self.paths.wiring, *self.limits.arrays, pose, x0, out)]

    def _gains(self, X: NDArray[np.float64]) -> NDArray[np.float32]:
        """Gains (k, n, 6) for the sample table at coordinates X (k, n); zero for a chain with several frames."""
        gains = np.zeros((*X.shape, 6), np.float32)
        if len(self.frames) == 1:
            self.kernels.gains_of(self.bare, X, gains)
        return gains

    @cached_property
    def bare(self) -> Floats:
        """The chain as one array for the compiled functions, without samples; see ``kernel.layout``."""
        return self._packed(np.zeros(REACH), np.zeros((0, 3)), no_samples(self.n, len(self.frames)))

    @cached_property
    def block(self) -> Floats:
        """The same with the sample table and, for one frame, the bounds of its reach and its closed form."""
        samples = self.sample_table.samples  # first of all: it says so where a joint has no limits
        reach = self.reach(0, oriented=True).array if self.has_pose_solver else np.zeros(REACH)
        return self._packed(reach, self.form, samples)

    def _packed(self, reach: Floats, form: Floats, samples: Samples) -> Floats:
        entries = Entries(self._least, self._most, self.coordinates.places)
        return pack(Packed(self.paths.arrays, self.limits.arrays, entries, reach, form), samples)

    @cached_property
    def pose_solver(self) -> PoseSolver:
        """The compiled solver for whole poses of a chain with one frame."""
        return self._solver(self.block, oriented=True)

    @cached_property
    def position_solver(self) -> PoseSolver:
        """The compiled solver for positions at any orientation."""
        samples = self.sample_table.samples
        block = self._packed(self.reach(0, oriented=False).array, self.form, samples)
        return self._solver(block, oriented=False)

    def _solver(self, block: Floats, oriented: bool) -> PoseSolver:
        kernels = self.kernels
        return PoseSolver(
            block,
            None if oriented else kernels.POSITION,
            self.sample(RESTARTS, (DEFAULT_SEED, 0)),
            kernels.compiled(kernels.solve_directly) if oriented and len(self.form) else None,
            kernels.compiled(kernels.solve_pose, oriented),
        )

    def sample(self, count: int, seed: tuple[int, ...]) -> NDArray[np.float64]:
        """Coordinates (count, n) drawn uniformly from the box; read-only, as equal seeds share one array."""
        try:
            return self._samples[count, seed]
        except (KeyError, TypeError):  # not drawn yet, or no such thing
            few("count", count, 0)
            count = int(count)
            if not isinstance(seed, tuple) or not all(isinstance(one, (int, np.integer)) for one in seed):
                given = seed[0] if isinstance(seed, tuple) and seed else seed
                raise InvalidSetting(
                    f"rng is a seed of at least 0, a numpy Generator or None, got {shown(given)}"
                ) from None
            if len(self._samples) == REMEMBERED:
                self._samples.clear()
            self._samples[count, seed] = X = self.box.sample(as_generator(seed), count)
            return X

    def reach(self, tip: int, oriented: bool) -> Reach:
        """Bounds on how far frame number ``tip`` reaches, for targets with or without a full orientation."""
        if type(tip) is not int or not 0 <= tip < len(self.frames) or not isinstance(oriented, bool):
            raise InvalidSetting(f"tip is 0 to {len(self.frames) - 1} and oriented a flag, got {tip!r}, {oriented!r}")
        if (tip, oriented) not in self._reaches:
            self._reaches[tip, oriented] = (
                reach_of(self.paths, self.limits, tip, oriented)
                if self._moves is None
                else self._original.reach(tip, oriented).moved(self._moves[tip])
            )
        return self._reaches[tip, oriented]

    def placements(self, q: NDArray[np.float64]) -> list[pin.SE3]:
        """World placement of each frame at configuration q (nq,), by Pinocchio."""
        return self._placed(as_configuration(self.model, q))

    def _placed(self, q: NDArray[np.float64]) -> list[pin.SE3]:
        """The same, of a configuration that was looked at already."""
        pin.forwardKinematics(self.model, self.data, q)
        return [pin.SE3(pin.updateFramePlacement(self.model, self.data, f)) for f in self.frame_ids]

    def poses(self, X: ArrayLike) -> NDArray[np.float64]:
        """World poses (k, T, 4, 4) of the T frames at coordinates X (k, n), by compiled code.

        Held joints have their values of ``reference``; for those of another configuration use
        ``chain.at(q0).poses(X)``.
        """
        population = np.atleast_2d(array("X", X, "...", self.n, error=InvalidConfiguration, finite=False))
        population = population.reshape(-1, self.n)
        flat = np.empty((len(population), len(self.frames), 12))
        self.kernels.poses(self.bare, population, flat)
        poses = np.zeros((*flat.shape[:2], 4, 4))
        poses[..., :3, :3] = flat[..., :9].reshape(*flat.shape[:2], 3, 3)
        poses[..., :3, 3] = flat[..., 9:]
        poses[..., 3, 3] = 1.0
        return poses

    def __repr__(self) -> str:
        return f"Chain({self.model.name}: {', '.join(self.frames)}; {self.n} joints: {', '.join(self.names)})"


@lru_cache(maxsize=REMADE)
def _remade(
    make: Callable[..., pin.Model],
    parts: tuple[Any, ...],
    frames: tuple[str, ...],
    locked: tuple[str, ...],
    limits: tuple[tuple[str, float, float], ...],
    reference: tuple[float, ...],
) -> Chain:
    """A chain from its pickle. The last few are kept: a thousand results, or calls of a worker, share one."""
    ranges = {name: (lower, upper) for name, lower, upper in limits}
    return Chain(make(*parts), frames, locked=locked, limits=ranges, reference=reference)


def _kernels() -> type[Kernels]:
    """The compiled loops, imported late: what compiles them takes 0.4 s to import."""
    from pin_metaik.kinematics.kernel.entry import Kernels

    return Kernels
