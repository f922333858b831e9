"""Many targets at once, on all cores: every answer is the one its target gets alone."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from time import perf_counter
from typing import Any, TypeAlias, cast

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import array, instance
from pin_metaik.collision import CollisionWorld, Contact
from pin_metaik.errors import InvalidConfiguration, InvalidTarget
from pin_metaik.ik.goals.pose import Target, TargetLike
from pin_metaik.ik.problem import check_world
from pin_metaik.ik.result import IKResult, IKStatus
from pin_metaik.ik.solve import solve_ik
from pin_metaik.ik.solver import DEFAULT_SOLVER, IKSolver
from pin_metaik.ik.starts import drawn
from pin_metaik.ik.threads import run_parallel, slices
from pin_metaik.kinematics import RESTARTS, Chain
from pin_metaik.kinematics.kernel.layout import ANGLE, DISTANCE, WITHOUT_BRANCH
from pin_metaik.optimize.settings import whole
from pin_metaik.plain import fields_of, plain
from pin_metaik.randomness import Rng, as_seed
from pin_metaik.watching import Count, Stopped, Watch

Rows: TypeAlias = slice | NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class IKBatch:
    """Results of k targets, in their order; ``batch[i]`` is number i as ``solve_ik`` gives it.

    Attributes:
        q: (k, nq) configurations, inside the limits also where not solved.
        success: (k,) whether each target is met, by Pinocchio.
        status: (k,) why each search ended, as ``IKStatus``.
        proof: (k,) what proves that a target is out of reach, as ``Proof``; None where nothing does.
        position_error: (k,) m, by Pinocchio.
        orientation_error: (k,) rad, by Pinocchio.
        evaluations: (k,) forward kinematics computed.
        seconds: Time the whole batch took, s.
        chain: The chain.
        targets: The targets as they were given.
        world: The world in which collisions were checked, if one was given. It is not pickled, because of all its
            meshes.
        contacts: By number of the target: the bodies that collide, deepest first. Only targets whose status is
            ``IN_COLLISION`` have any.
    """

    q: NDArray[np.float64]
    success: NDArray[np.bool_]
    status: NDArray[np.object_]
    proof: NDArray[np.object_]
    position_error: NDArray[np.float64]
    orientation_error: NDArray[np.float64]
    evaluations: NDArray[np.int64]
    seconds: float
    chain: Chain = field(repr=False)
    targets: Sequence[TargetLike] | NDArray[np.float64] = field(repr=False)
    world: CollisionWorld | None = field(default=None, repr=False)
    contacts: dict[int, tuple[Contact, ...]] = field(default_factory=dict, repr=False)

    def __bool__(self) -> bool:
        """Whether every target is met."""
        return bool(self.success.all())

    def __len__(self) -> int:
        return len(self.q)

    def __getstate__(self) -> dict[str, object]:
        """Pickle without the world: kilobytes rather than megabytes."""
        return {**self.__dict__, "world": None}

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON, lists of one a target: lengths in m, angles in rad."""
        names = ("q", "success", "status", "proof", "position_error", "orientation_error", "evaluations", "seconds")
        return {**fields_of(self, *names), "collisions": plain(self.contacts)}

    def __getitem__(self, i: int) -> IKResult:
        return IKResult(
            self.q[i],
            self.status[i],
            float(self.position_error[i]),
            float(self.orientation_error[i]),
            int(self.evaluations[i]),
            self.seconds / len(self),
            self.chain.at(self.q[i]),
            self.targets[i],
            world=self.world,
            contacts=self.contacts.get(i % len(self), ()),
            proof=self.proof[i],
        )

    def __iter__(self) -> Iterator[IKResult]:
        return (self[i] for i in range(len(self)))


def solve_ik_batch(
    chain: Chain,
    targets: ArrayLike | Sequence[TargetLike],
    q0: ArrayLike | None = None,
    *,
    solver: IKSolver | None = None,
    world: CollisionWorld | None = None,
    workers: int | None = None,
    rng: Rng = None,
    watch: Watch | None = None,
) -> IKBatch:
    """Solve many targets, each as ``solve_ik`` would.

    Args:
        chain: The joints to move and the frames to place.
        targets: Poses (k, 4, 4) or positions (k, 3), which go through one compiled loop; or a list of any targets.
        q0: (nq,) configuration to start all from, or (k, nq), one for each, with the joints outside the chain and the
            locked ones; default: the chain's reference.
        solver: How to search; default ``IKSolver()``.
        world: What must not collide.
        workers: Threads; default: one a core. The answers do not depend on it.
        rng: Seed or generator of every random choice; ``None`` is a fixed seed. A generator gives the whole batch one
            seed.
        watch: Called with targets done and in all, from any of the threads, one at a time; True ends the batch: targets
            that were not decided by then have the status ``STOPPED``, and errors of NaN where nothing was tried.

    Raises:
        InvalidTarget: If a target is not a valid one; the message has its number.
        InvalidConfiguration: If ``q0`` is not (nq,) or (k, nq), or not finite.
        InvalidSetting: If ``workers`` is less than one, or the world is another model's than the chain.
    """
    began = perf_counter()
    if workers is not None:
        whole("workers", workers, 1)
    check_world(chain, world)
    solver = DEFAULT_SOLVER if solver is None else solver
    instance(IKSolver, solver=solver)
    if watch is not None:
        instance(Callable, watch=watch)
    seed = as_seed(rng)
    array = _as_array(targets)
    asked = cast(Sequence[TargetLike], targets) if array is None else array
    k = len(asked)
    bases = _bases(chain, q0, k)
    batch = IKBatch(
        bases.copy(), np.zeros(k, bool), np.full(k, IKStatus.STOPPED, object), np.full(k, None),
        np.full(k, np.nan), np.full(k, np.nan), np.zeros(k, int), 0.0, chain, asked, world,
    )  # fmt: skip

    def alone(i: int) -> None:
        try:
            result = solve_ik(chain, asked[i], bases[i], solver=solver, world=world, rng=seed)
        except InvalidTarget as error:
            raise InvalidTarget(f"target {i}: {error}") from None
        batch.q[i], batch.evaluations[i], batch.proof[i] = result.q, result.evaluations, result.proof
        batch.position_error[i], batch.orientation_error[i] = result.position_error, result.orientation_error
        if result.contacts:
            batch.contacts[i] = result.contacts
        batch.status[i], batch.success[i] = result.status, result.success  # last: a watch may end a thread anywhere
        count.add(1)

    settings = solver.kernel_settings if array is not None and chain.has_pose_solver else None
    workers = min(workers or os.cpu_count() or 1, max(k, 1))
    left: Iterable[int] = range(k)
    count = Count(watch, k)
    try:
        if array is not None and settings is not None and k:
            poses, starts = _as_poses(array), drawn(chain, seed, 0, RESTARTS)
            settings = settings.copy()
            settings[WITHOUT_BRANCH] = 0.0  # then ``alone`` decides
            if array.ndim == 2:
                settings[ANGLE] = math.inf

            def together(part: Rows) -> None:
                q, evaluations, goals = batch.q[part], batch.evaluations[part], poses[part]
                here = chain.at(q[0])
                kernel = here.pose_solver if array.ndim == 3 else here.position_solver
                chain.kernels.solve_poses(kernel.block, kernel.rows, starts, settings, goals, q, evaluations)
                batch.q[part], batch.evaluations[part] = q, evaluations
                _judge(batch, goals, settings[DISTANCE : ANGLE + 1], part)
                count.add(int(batch.success[part].sum()))

            run_parallel(together, _parts(chain, bases, workers), workers)
            left = np.flatnonzero(~batch.success).tolist()
        run_parallel(alone, left, workers)
    except Stopped:
        batch.status[~batch.success & (batch.status == IKStatus.SOLVED)] = IKStatus.STOPPED
    return replace(batch, seconds=perf_counter() - began)


def _parts(chain: Chain, bases: NDArray[np.float64], workers: int) -> list[Rows]:
    """The rows of bases (k, nq) in parts, each with the joints that the chain holds in one place."""
    if not chain.held or (bases == bases[0])[:, chain.held].all():
        return [*slices(len(bases), workers)]
    _, group = np.unique(bases[:, chain.held], axis=0, return_inverse=True)
    group = group.ravel()  # which NumPy 2.0.0 gives as a column
    order, sizes = np.argsort(group, kind="stable"), np.bincount(group)
    groups = np.split(order, np.cumsum(sizes)[:-1])
    return [rows[part] for rows in groups for part in slices(len(rows), workers)]


def _judge(batch: IKBatch, poses: NDArray[np.float64], tolerances: NDArray[np.float64], part: Rows) -> None:
    """Let Pinocchio judge one part of the batch."""
    chain, q = batch.chain, batch.q[part]
    errors = np.empty((len(q), 2))
    chain.kernels.distances(poses, chain.tip.fk_batch(q), errors)
    position, orientation = errors.T
    if tolerances[1] == math.inf:
        orientation[:] = 0.0
    batch.position_error[part], batch.orientation_error[part] = position, orientation
    met = (batch.evaluations[part] >= 0) & (position <= tolerances[0]) & (orientation <= tolerances[1])
    if batch.world is not None:
        met[met] = [not batch.world.checker.collides(one) for one in q[met]]
    batch.status[part] = IKStatus.SOLVED
    batch.success[part] = met


def _as_array(targets: ArrayLike | Sequence[TargetLike]) -> NDArray[np.float64] | None:
    """Poses (k, 4, 4) or positions (k, 3); None for a list of other things."""
    if isinstance(targets, Sequence) and any(isinstance(one, (Target, pin.SE3)) for one in targets):
        return None
    try:
        array = np.array(targets, dtype=float)
    except (TypeError, ValueError, OverflowError):
        if isinstance(targets, Sequence):
            return None
        raise InvalidTarget(f"targets are poses (k, 4, 4), positions (k, 3) or a list, got {targets!r}") from None
    if array.shape[1:] not in ((4, 4), (3,)):
        if isinstance(targets, Sequence):
            return None
        raise InvalidTarget(f"targets are poses (k, 4, 4) or positions (k, 3), got shape {array.shape}")
    return array


def _as_poses(array: NDArray[np.float64]) -> NDArray[np.float64]:
    """Poses (k, 4, 4); of positions (k, 3) with no rotation."""
    if array.ndim == 3:
        return np.ascontiguousarray(array)
    poses = np.repeat(np.eye(4)[None], len(array), axis=0)
    poses[:, :3, 3] = array
    return poses


def _bases(chain: Chain, q0: ArrayLike | None, k: int) -> NDArray[np.float64]:
    """Configurations to start from (k, nq), inside the limits."""
    if q0 is None:
        return np.repeat(chain.reference[None], k, axis=0)
    given = array("q0", q0, "...", chain.model.nq, error=InvalidConfiguration)
    if given.ndim == 2 and given.shape == (k, chain.model.nq):
        return chain.inside(given)
    if given.ndim == 2:
        raise InvalidConfiguration(f"q0 for {k} targets has shape ({k}, {chain.model.nq}), got {given.shape}")
    return np.repeat(chain.configuration(given)[None], k, axis=0)
