"""Many targets at once, on all cores: every answer is the one its target gets alone."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from functools import partial
from time import perf_counter
from typing import cast

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from pin_metaik.errors import InvalidConfiguration, InvalidSetting, InvalidTarget
from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.refine.dls import DLS, Batch
from pin_metaik.ik.result import IKResult, IKStatus
from pin_metaik.ik.solver import DEFAULT_SOLVER, IKSolver
from pin_metaik.ik.starts import FIRST, Rng, drawn
from pin_metaik.ik.target import DEFAULT_TOLERANCE, Target, TargetLike
from pin_metaik.kinematics import Chain
from pin_metaik.kinematics.pose import ORTHONORMAL

CHUNK = 256  # targets a thread takes at a time


@dataclass(frozen=True, eq=False)
class IKBatch:
    """Results of k targets, in their order; ``batch[i]`` is number i as ``solve_ik`` gives it.

    Attributes:
        q: (k, nq) configurations, inside the limits also where not solved.
        success: (k,) whether each target is met, by Pinocchio.
        status: (k,) why each search ended, as ``IKStatus``.
        position_error: (k,) m, by Pinocchio.
        orientation_error: (k,) rad, by Pinocchio.
        evaluations: (k,) forward kinematics computed.
        seconds: Time the whole batch took, s.
        chain: The chain.
        targets: What was asked.
    """

    q: NDArray[np.float64]
    success: NDArray[np.bool_]
    status: NDArray[np.object_]
    position_error: NDArray[np.float64]
    orientation_error: NDArray[np.float64]
    evaluations: NDArray[np.int64]
    seconds: float
    chain: Chain = field(repr=False)
    targets: Sequence[TargetLike] | NDArray[np.float64] = field(repr=False)

    def __len__(self) -> int:
        return len(self.q)

    def __getitem__(self, i: int) -> IKResult:
        return IKResult(
            self.q[i],
            self.status[i],
            float(self.position_error[i]),
            float(self.orientation_error[i]),
            int(self.evaluations[i]),
            self.seconds / len(self),
            IKProblem.of(self.chain, self.targets[i]),
        )

    def __iter__(self) -> Iterator[IKResult]:
        return (self[i] for i in range(len(self)))


def solve_ik_batch(
    chain: Chain,
    targets: ArrayLike | Sequence[TargetLike],
    q0: ArrayLike | None = None,
    *,
    solver: IKSolver | None = None,
    workers: int | None = None,
    rng: Rng = None,
) -> IKBatch:
    """Solve many targets, each as ``solve_ik`` would.

    Args:
        chain: The joints to move and the frames to place.
        targets: Poses (k, 4, 4) or positions (k, 3), which go through one compiled loop; or a list of any targets.
        q0: (nq,) configuration to start all from, or (k, nq), one for each; default: the chain's reference.
        solver: How to search; default ``IKSolver()``.
        workers: Threads; default: one a core. The answers do not depend on it.
        rng: Seed or generator of every random choice; ``None`` is a fixed seed.

    Raises:
        InvalidTarget: If a target is none; its number is named.
        InvalidConfiguration: If ``q0`` is not (nq,) or (k, nq), or not finite.
        InvalidSetting: If ``workers`` is less than one.
    """
    began = perf_counter()
    if workers is not None and workers < 1:
        raise InvalidSetting(f"workers is at least 1, got {workers}")
    solver = solver or DEFAULT_SOLVER
    seed = int(rng.integers(2**62)) if isinstance(rng, np.random.Generator) else rng
    array = _as_array(targets)
    asked = cast(Sequence[TargetLike], targets) if array is None else array
    k = len(asked)
    batch = IKBatch(
        _bases(chain, q0, k), np.zeros(k, bool), np.empty(k, object), np.zeros(k), np.zeros(k), np.zeros(k, int), 0.0,
        chain, asked,
    )  # fmt: skip

    def alone(i: int) -> None:
        result = solver.solve(IKProblem.of(chain, asked[i]), batch.q[i], seed)
        batch.q[i], batch.success[i], batch.status[i] = result.q, result.success, result.status
        batch.position_error[i], batch.orientation_error[i] = result.position_error, result.orientation_error
        batch.evaluations[i] = result.evaluations

    fast = solver.fast if array is not None and len(chain.frames) == 1 else None
    with ThreadPoolExecutor(workers or os.cpu_count() or 1) as pool:
        if array is not None and fast is not None:
            tasks, starts = _tasks(array), drawn(chain, seed, 0, FIRST)
            _ = chain.atlas  # made once, before the threads ask for it
            together = partial(_solve_part, batch, tasks, starts, fast, solver.first_evaluations)
            parts = pool.map(together, [slice(i, min(i + CHUNK, k)) for i in range(0, k, CHUNK)])
            left = [i for part in parts for i in part]
        else:
            left = list(range(k))
        list(pool.map(alone, left))
    return replace(batch, seconds=perf_counter() - began)


def _solve_part(
    batch: IKBatch,
    tasks: NDArray[np.float64],
    starts: NDArray[np.float64],
    dls: DLS,
    evaluations: int,
    part: slice,
) -> list[int]:
    """The first step of the automatic solver for one part of the batch; returns the numbers of the unsolved."""
    chain, bases = batch.chain, batch.q[part]
    k = len(bases)
    found = Batch(chain.x(bases), np.empty((k, chain.n)), np.empty(k, np.int64), np.empty(k, np.int64))
    dls.refine_batch(chain, tasks[part], starts, evaluations, found)
    q = chain.q(found.x, bases)
    position, orientation = _errors(chain, q, tasks[part, 0])
    inside = ((chain.limits.lower <= found.x) & (chain.limits.upper >= found.x)).all(axis=1)
    met = inside & (position <= DEFAULT_TOLERANCE) & (orientation <= DEFAULT_TOLERANCE)
    numbers = np.arange(part.start, part.stop)
    at = numbers[met]
    batch.q[at], batch.success[at], batch.status[at] = q[met], True, IKStatus.SOLVED
    batch.position_error[at], batch.orientation_error[at] = position[met], orientation[met]
    batch.evaluations[at] = found.evaluations[met]
    return [int(i) for i in numbers[~met]]


def _errors(
    chain: Chain, q: NDArray[np.float64], tasks: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Distance and angle (k,) of configurations q (k, nq) from the targets of tasks (k, 26); 0 if free."""
    model, data, frame = chain.model, chain.data, chain.frame_ids[0]
    reached = np.empty((len(q), 4, 4))
    for i, one in enumerate(q):
        pin.forwardKinematics(model, data, one)
        reached[i] = pin.updateFramePlacement(model, data, frame).homogeneous
    world = tasks[:, :9].reshape(-1, 3, 3)
    away = (world @ reached[:, :3, 3:])[..., 0] + tasks[:, 9:12]
    R = world @ reached[:, :3, :3]
    skew = 0.5 * np.stack([R[:, 2, 1] - R[:, 1, 2], R[:, 0, 2] - R[:, 2, 0], R[:, 1, 0] - R[:, 0, 1]], axis=1)
    angle = np.arctan2(np.linalg.norm(skew, axis=1), 0.5 * (np.trace(R, axis1=1, axis2=2) - 1.0))
    return np.linalg.norm(away, axis=1), np.where(np.isinf(tasks[:, 15]), 0.0, angle)


def _as_array(targets: ArrayLike | Sequence[TargetLike]) -> NDArray[np.float64] | None:
    """Poses (k, 4, 4) or positions (k, 3), checked; None for a list of other things."""
    if isinstance(targets, Sequence) and any(isinstance(one, (Target, pin.SE3)) for one in targets):
        return None
    try:
        array = np.array(targets, dtype=float)
    except (TypeError, ValueError):
        if isinstance(targets, Sequence):
            return None
        raise InvalidTarget(f"targets are poses (k, 4, 4), positions (k, 3) or a list, got {targets!r}") from None
    if array.shape[1:] not in ((4, 4), (3,)):
        if isinstance(targets, Sequence):
            return None
        raise InvalidTarget(f"targets are poses (k, 4, 4) or positions (k, 3), got shape {array.shape}")
    sound = np.isfinite(array).all(axis=tuple(range(1, array.ndim)))
    if array.ndim == 3:
        R = np.where(sound[:, None, None], array[:, :3, :3], np.eye(3))
        defect = np.abs(R.transpose(0, 2, 1) @ R - np.eye(3)).max(axis=(1, 2), initial=0.0)
        sound &= (defect <= ORTHONORMAL) & (np.linalg.det(R) > 0.0) & (array[:, 3] == [0.0, 0.0, 0.0, 1.0]).all(axis=1)
    for i in np.flatnonzero(~sound):
        try:
            Target.of(array[i])
        except InvalidTarget as error:
            raise InvalidTarget(f"target {i}: {error}") from None
    return array


def _tasks(array: NDArray[np.float64]) -> NDArray[np.float64]:
    """Tasks (k, 1, 26) of poses (k, 4, 4) or positions (k, 3) with the default tolerances."""
    whole = array.ndim == 3
    tasks = np.repeat((Target(np.eye(4)) if whole else Target.at(np.zeros(3))).task[None, None], len(array), axis=0)
    if whole:
        world = array[:, :3, :3].transpose(0, 2, 1)
        tasks[:, 0, :9] = world.reshape(-1, 9)
        tasks[:, 0, 9:12] = -(world @ array[:, :3, 3:])[..., 0]
    else:
        tasks[:, 0, 9:12] = -array
    return tasks


def _bases(chain: Chain, q0: ArrayLike | None, k: int) -> NDArray[np.float64]:
    """Configurations to start from (k, nq), inside the limits."""
    if q0 is None:
        return np.repeat(chain.reference[None], k, axis=0)
    given = np.asarray(q0, dtype=float)
    if given.ndim == 2 and given.shape == (k, chain.model.nq):
        return np.array([chain.configuration(one) for one in given]).reshape(k, chain.model.nq)
    if given.ndim == 2:
        raise InvalidConfiguration(f"q0 for {k} targets has shape ({k}, {chain.model.nq}), got {given.shape}")
    return np.repeat(chain.configuration(given)[None], k, axis=0)
