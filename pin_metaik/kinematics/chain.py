"""A chain: the joints of a Pinocchio model that move one or several frames, and their coordinates."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import cached_property
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from pin_metaik.errors import FixedFrame
from pin_metaik.kinematics.atlas import LEAF, SEED, Atlas, chart
from pin_metaik.kinematics.closed_form import closed_form
from pin_metaik.kinematics.model import as_configuration, coordinates_of, entry_limits, frame_id, joint_id, limits_of
from pin_metaik.kinematics.own_limits import with_own
from pin_metaik.kinematics.paths import lay_paths, motion_of
from pin_metaik.kinematics.placing import Placing, Scratch
from pin_metaik.kinematics.reach import Reach, reach_of
from pin_metaik.optimize import Box
from pin_metaik.randomness import DEFAULT_SEED, as_generator

LANE = 256  # random starts of the fast lane
REMEMBERED = 16  # sets of samples kept


class Lane(NamedTuple):
    """The fast lane of a chain: compiled loops, and what they need of it.

    Attributes:
        block: The chain as ``pack`` has it.
        rows: ``POSITION``, or None for whole poses.
        starts: (LANE, n) drawn with the default seed.
        solve_directly: Of ``direct``; None without a closed form.
        solve_pose: Of ``lane``.
    """

    block: NDArray[np.float64]
    rows: NDArray[np.int64] | None
    starts: NDArray[np.float64]
    solve_directly: Callable[..., Any] | None
    solve_pose: Callable[..., Any]


class Chain:
    """The joints on the way to one or several frames of a ``pin.Model``, as n coordinates with limits.

    A coordinate is a revolute, prismatic or continuous joint; joints that mimic another follow it; everything else is
    held where ``reference`` has it. The model is only read, never written to.

    Attributes:
        model: The model.
        frames: Names of the T frames.
        names: Names of the n joints, one a coordinate.
        limits: Their limits.
        reference: (nq,) the configuration that joints outside the chain are held at.
        paths: The arrays the compiled loops take.
        kernels: The compiled loops.
        tip: Pinocchio's placement of the first frame.
    """

    def __init__(
        self,
        model: pin.Model,
        frame: str | Iterable[str],
        *,
        locked: Iterable[str] = (),
        limits: Mapping[str, tuple[float, float]] | None = None,
        reference: ArrayLike | None = None,
    ) -> None:
        """Find the joints that move ``frame``.

        Args:
            model: Any Pinocchio model.
            frame: A frame's name, or several that are to be placed at once.
            locked: Joints on the way that shall stay where ``reference`` has them.
            limits: Ranges (lower, upper) in rad or m that replace the model's, by joint name.
            reference: (nq,) configuration of the joints that are not moved; default: neutral, inside the limits.

        Raises:
            FrameNotFound: If the model has no such frame.
            FixedFrame: If no joint is left that moves it.
            UnsupportedJoint: If a joint on the way has several degrees of freedom (lock it), or no single axis.
            UnknownName: If a locked joint does not exist.
            InvalidBounds: If limits are crossed or NaN.
            InvalidConfiguration: If ``reference`` is not a configuration of the model.
        """
        self._made_from = (model, frame, tuple(locked), dict(limits or {}), reference)
        self.model = model
        self.frames = (frame,) if isinstance(frame, str) else tuple(frame)
        self.frame_ids = tuple(frame_id(model, name) for name in self.frames)
        self._least, self._most = entry_limits(model)
        self.reference = self.configuration(pin.neutral(model) if reference is None else reference)

        held = {joint_id(model, name) for name in locked}
        on_path = {j for f in self.frame_ids for j in list(model.supports[model.frames[f].parentJoint])[1:]}
        motions = {j: motion_of(model, j) for j in sorted(on_path - held)}
        motions = {j: motion for j, motion in motions.items() if motion.driver not in held}
        drivers = sorted({motion.driver for motion in motions.values()}, key=lambda j: int(model.joints[j].idx_v))
        for name, f in zip(self.frames, self.frame_ids, strict=True):
            if not motions.keys() & set(model.supports[model.frames[f].parentJoint]):
                raise FixedFrame(
                    f"no joint moves frame {name!r}" + (f" while {sorted(locked)} are locked" if held else "")
                )

        self.names = tuple(model.names[j] for j in drivers)
        self.coordinates = coordinates_of(model, drivers)
        mimicked = {motion.driver for motion in motions.values() if motion.scale != 1.0}
        self.limits = with_own(limits_of(model, drivers, self.names, mimicked), limits or {})
        plain, entries = self.coordinates.plain, self.coordinates.plain_q
        self._least[entries], self._most[entries] = self.limits.lower[plain], self.limits.upper[plain]
        self.paths = lay_paths(model, self.frame_ids, {j: c for c, j in enumerate(drivers)}, motions, self.reference)
        self.kernels = _kernels()
        self._own = Scratch(model)
        self.tip = Placing(model, self.frame_ids[0])
        self._samples: dict[tuple[int, tuple[int, ...]], NDArray[np.float64]] = {}
        self._reaches: dict[tuple[int, bool], Reach] = {}

    @property
    def data(self) -> pin.Data:
        """Pinocchio's scratch for this model, one a thread."""
        return self._own.data

    def __reduce__(self) -> tuple[object, ...]:
        """Pickle by what the chain was made from."""
        return _remade, self._made_from

    @property
    def n(self) -> int:
        """Number of coordinates."""
        return len(self.names)

    def q(self, x: ArrayLike, q0: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """Configurations (..., nq) at coordinates x (..., n); other joints stay as in ``q0`` (default: reference)."""
        coordinates = np.asarray(x, dtype=float)
        q = np.empty((*coordinates.shape[:-1], self.model.nq))
        q[...] = self.reference if q0 is None else q0
        self.coordinates.write(coordinates, q)
        return q

    def x(self, q: ArrayLike) -> NDArray[np.float64]:
        """Coordinates (..., n) of configurations q (..., nq); continuous joints as an angle in (-pi, pi]."""
        return self.coordinates.read(np.asarray(q, dtype=float))

    def configuration(self, q: ArrayLike) -> NDArray[np.float64]:
        """A configuration (nq,) somebody gave: checked, and with every joint brought inside its limits.

        Raises:
            InvalidConfiguration: If its length is not nq or an entry is not finite.
        """
        return self.inside(as_configuration(self.model, q))

    def inside(self, q: NDArray[np.float64]) -> NDArray[np.float64]:
        """The nearest configurations inside the limits to q (..., nq); pairs and quaternions are left alone."""
        return np.minimum(np.maximum(q, self._least), self._most)

    @cached_property
    def box(self) -> Box:
        """The finite box to search in: the limits, or one turn for joints that have none.

        Raises:
            InvalidBounds: If a sliding joint has no finite limits.
        """
        return self.limits.box()

    @cached_property
    def atlas(self) -> Atlas:
        """Sampled configurations to look a pose up in; made on first use, in about 5 ms, always the same."""
        X = self.limits.one_turn().box().sample(np.random.default_rng(SEED), LEAF * LEAF)
        return chart(X, self.poses(X), self._gains)

    @cached_property
    def form(self) -> NDArray[np.float64]:
        """What the arm's closed form needs to know of it; no rows, if it has none."""
        return closed_form(self.paths)

    def branches(self, pose: NDArray[np.float64], x0: NDArray[np.float64]) -> NDArray[np.float64]:
        """Coordinates (b, n) that an arm's closed form has for a pose (4, 4), the branch that x0 (n,) is on first.

        Where a joint does not matter, in a singularity, it stays as in x0. Without a closed form there are none.
        """
        out = np.empty((8, self.n))
        if not len(self.form):
            return out[:0]
        return out[: self.kernels.all_branches(self.form, self.paths.wiring, *self.limits.arrays, pose, x0, out)]

    def _gains(self, X: NDArray[np.float64]) -> NDArray[np.float32]:
        """Gains (k, n, 6) for the atlas at coordinates X (k, n); zero for a chain with several frames."""
        gains = np.zeros((*X.shape, 6), np.float32)
        if len(self.frames) == 1:
            self.kernels.gains_of(*self.paths.arrays, X, gains)
        return gains

    @cached_property
    def pose_lane(self) -> Lane:
        """The fast lane of a chain with one frame, for whole poses."""
        return self._lane(oriented=True)

    @cached_property
    def position_lane(self) -> Lane:
        """The same for positions at any orientation."""
        return self._lane(oriented=False)

    def _lane(self, oriented: bool) -> Lane:
        kernels = self.kernels
        joints = [self.model.joints[int(j)] for j in self.coordinates.joints]
        places = np.array([(joint.idx_q, joint.nq == 2) for joint in joints], dtype=np.int64)
        block = kernels.pack(
            self.paths.arrays,
            self.limits.arrays,
            self.atlas.arrays,
            (self._least, self._most, places),
            self.reach(0, oriented).array,
            self.form,
        )
        return Lane(
            block,
            None if oriented else kernels.POSITION,
            self.sample(LANE, (DEFAULT_SEED, 0)),
            kernels.solve_directly.compiled() if oriented and len(self.form) else None,
            kernels.solve_pose.compiled(oriented),
        )

    def sample(self, count: int, seed: tuple[int, ...]) -> NDArray[np.float64]:
        """Coordinates (count, n) drawn uniformly from the box; one array for a seed, so not to be written to."""
        try:
            return self._samples[count, seed]
        except KeyError:
            if len(self._samples) == REMEMBERED:
                self._samples.clear()
            self._samples[count, seed] = X = self.box.sample(as_generator(seed), count)
            return X

    def reach(self, tip: int, oriented: bool) -> Reach:
        """Bounds on how far tip number ``tip`` gets, for targets with or without a full orientation."""
        if (tip, oriented) not in self._reaches:
            self._reaches[tip, oriented] = reach_of(self.paths, self.limits, tip, oriented)
        return self._reaches[tip, oriented]

    def placements(self, q: NDArray[np.float64]) -> list[pin.SE3]:
        """World placement of each frame at configuration q (nq,), by Pinocchio."""
        pin.forwardKinematics(self.model, self.data, q)
        return [pin.SE3(pin.updateFramePlacement(self.model, self.data, f)) for f in self.frame_ids]

    def poses(self, X: ArrayLike) -> NDArray[np.float64]:
        """World poses (k, T, 4, 4) of the T frames at the coordinates X (k, n), by the compiled loop."""
        population = np.ascontiguousarray(np.atleast_2d(np.asarray(X, dtype=float)))
        flat = np.empty((len(population), len(self.frames), 12))
        self.kernels.poses(*self.paths.arrays, population, flat)
        poses = np.zeros((*flat.shape[:2], 4, 4))
        poses[..., :3, :3] = flat[..., :9].reshape(*flat.shape[:2], 3, 3)
        poses[..., :3, 3] = flat[..., 9:]
        poses[..., 3, 3] = 1.0
        return poses

    def __repr__(self) -> str:
        return f"Chain({self.model.name}: {', '.join(self.frames)}; {self.n} joints: {', '.join(self.names)})"


def _remade(
    model: pin.Model,
    frame: str | Iterable[str],
    locked: tuple[str, ...],
    limits: dict[str, tuple[float, float]],
    reference: ArrayLike | None,
) -> Chain:
    return Chain(model, frame, locked=locked, limits=limits, reference=reference)


def _kernels() -> ModuleType:
    """The compiled loops, imported late: what compiles them takes 0.4 s to import."""
    from pin_metaik.kinematics import loops

    return loops
