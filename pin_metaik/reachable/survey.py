"""Making a reachability map part by part, on all cores or a cluster, with resumption after an interruption."""

from __future__ import annotations

import hashlib
import pickle
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import lru_cache
from pathlib import Path
from time import perf_counter

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import array, checked
from pin_metaik.collision import CollisionWorld
from pin_metaik.dexterity import manipulability
from pin_metaik.errors import InvalidSetting, InvalidTarget
from pin_metaik.folder_lock import locked
from pin_metaik.ik import IKBatch, IKSolver, Target, solve_ik_batch
from pin_metaik.ik.problem import IKProblem, check_world
from pin_metaik.kinematics import Chain
from pin_metaik.optimize.settings import one_of
from pin_metaik.output import writable
from pin_metaik.randomness import Rng, as_seed
from pin_metaik.reachable.files import STATUSES
from pin_metaik.reachable.grid import Grid, spread_rotations
from pin_metaik.reachable.kept import Kept
from pin_metaik.reachable.result import Reachability
from pin_metaik.watching import Progress, Watch, ended, tell
from pin_metaik.workers import Backend, check_jobs, need_joblib, worked

POSES = 512  # of a part: fractions of a second, or seconds where most are hard
KEPT = 4  # questions that a worker remembers
RESULT = "reachability.npz"

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Question:
    """What is asked of every pose.

    Attributes:
        chain: The chain.
        orientations: (m, 3, 3); (0, 3, 3): positions alone.
        q0: (nq,) where every search starts.
        solver: How to search; None: the default.
        world: What must not collide.
        seed: Of every search.
    """

    chain: Chain
    orientations: Floats
    q0: Floats
    solver: IKSolver | None
    world: CollisionWorld | None
    seed: int | None

    def digest(self, positions: Floats) -> str:
        """What decides the answers: the same for the same question, in any process."""
        chain, world = self.chain, self.world
        said: list[object] = [chain.frames, chain.names, chain.held, self.seed, _described(self.solver)]
        content = hashlib.sha256(chain.model.saveToString().encode())
        for numbers in (chain.limits.lower, chain.limits.upper, self.q0, positions, self.orientations):
            content.update(numbers.tobytes())
        if world is not None:
            said += [world.margin, sorted(map(repr, world.padding.items())), world.simplify, world.exact]
            said += [sorted(world.disabled), [frame for _, frame in world.grasped]]
            for obstacle in (*world.obstacles, *(held for held, _ in world.grasped)):
                said.append(obstacle.name)
                content.update(pin.SE3(obstacle.pose).homogeneous.tobytes() + pickle.dumps(obstacle.shape))
        content.update(repr(said).encode())
        return content.hexdigest()

    def answer(self, positions: Floats, workers: int | None) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
        """Status and manipulability (c, m) at positions (c, 3)."""
        m = max(1, len(self.orientations))
        poses = np.repeat(np.eye(4)[None], len(positions) * m, axis=0)
        poses[:, :3, 3] = np.repeat(positions, m, axis=0)
        if len(self.orientations):
            poses[:, :3, :3] = np.tile(self.orientations, (len(positions), 1, 1))
        asked = poses if len(self.orientations) else np.ascontiguousarray(positions)
        batch = solve_ik_batch(
            self.chain, asked, self.q0, solver=self.solver, world=self.world, workers=workers, rng=self.seed
        )
        status = np.array([STATUSES.index(one) for one in batch.status], dtype=np.uint8)
        return status.reshape(-1, m), self._dexterity(batch).reshape(-1, m)

    def _dexterity(self, batch: IKBatch) -> NDArray[np.float32]:
        """Manipulability (k,) of the solutions of a batch, NaN where there is none."""
        found = np.full(len(batch), np.nan, dtype=np.float32)
        chain = self.chain.at(self.q0)
        target = Target(np.eye(4)) if len(self.orientations) else Target.at(np.zeros(3))
        problem = IKProblem.of(chain, target)  # wherever the target is, a Jacobian is only turned by that
        X = chain.x(batch.q[batch.success])
        if len(X):
            found[batch.success] = manipulability(np.array([problem.linearize(x)[1].T for x in X]))
        return found


@dataclass(frozen=True, eq=False)
class Part:
    """Some of the positions.

    Attributes:
        number: Of the part.
        start: Number of its first position.
        positions: (c, 3) m.
    """

    number: int
    start: int
    positions: Floats

    @property
    def rows(self) -> slice:
        """Its rows of the map."""
        return slice(self.start, self.start + len(self.positions))


@dataclass(frozen=True, eq=False)
class Handed:
    """A part as a worker gets it, with the question, which is pickled once for all of them."""

    part: Part
    question: bytes

    def run(self) -> tuple[Part, NDArray[np.uint8], NDArray[np.float32]]:
        """The part, its status and manipulability (c, m)."""
        return self.part, *_question(self.question).answer(self.part.positions, 1)


def _described(solver: IKSolver | None) -> str:
    """A solver in words that are the same in every process; objects of one's own by their class."""
    if solver is None:
        return ""
    parts = ((f.name, getattr(solver, f.name)) for f in fields(solver) if f.init)
    plain = (str, int, float, bool, type(None))
    return repr([(name, one if isinstance(one, plain) or is_dataclass(one) else type(one)) for name, one in parts])


@lru_cache(maxsize=KEPT)
def _question(pickled: bytes) -> Question:
    question: Question = pickle.loads(pickled)
    return question


@checked
def reachability(
    chain: Chain,
    grid: Grid | ArrayLike,
    orientations: int | ArrayLike | None = None,
    *,
    q0: ArrayLike | None = None,
    solver: IKSolver | None = None,
    world: CollisionWorld | None = None,
    jobs: int | None = None,
    backend: Backend = "loky",
    scheduler: str | None = None,
    folder: Path | None = None,
    rng: Rng = None,
    watch: Watch | None = None,
) -> Reachability:
    """Map which positions a chain reaches in which orientations, and how well it can move there.

    Most unreachable poses are proved unreachable, in microseconds to milliseconds; the map distinguishes them from
    poses that were only not found. It does not depend on ``jobs``, the backend or interruptions.

    Args:
        chain: The joints to move and the frame to place, one.
        grid: Positions in the world: a ``Grid``, or (k, 3) m.
        orientations: Of the frame in the world: (m, 3, 3), or how many to spread evenly over all rotations; ``None``:
            positions alone, at any orientation.
        q0: (nq,) configuration every search starts from; default: the chain's reference.
        solver: How to search; default ``IKSolver()``. With ``select="manipulability"`` the map has the best
            manipulability of each pose, which takes many times as long, else that of the solution found.
        world: What must not collide.
        jobs: Number of processes; -1: one for each core; ``None``: threads of this process, one for each core, which is
            quickest without a world. Processes and other backends need the extra ``compare``.
        backend: Of joblib: ``"loky"`` for processes on this machine, ``"dask"`` for a Dask cluster (the extra
            ``cluster``), all of whose workers are used.
        scheduler: Address of the Dask scheduler, e.g. ``"tcp://node1:8786"``.
        folder: Folder in which parts of the map are stored as soon as they are done, and ``reachability.npz`` at the
            end; the same call resumes from there. Default: nothing is stored.
        rng: Seed or generator; ``None`` is a fixed seed.
        watch: Called after every part with the poses done and in all; returning True ends the work, and the remaining
            poses are "not looked at".

    Raises:
        InvalidSetting: If the chain has several frames, there are no positions or orientations, the world is another
            model's, ``jobs`` is 0, the scheduler cannot be reached, or the folder holds another map.
        InvalidConfiguration: If ``q0`` is not a configuration of the model.
        MissingExtra: If joblib or distributed is needed and not installed.
        CannotWrite: If the folder cannot be made or written into.
        Interrupted: Ctrl-C; its ``result`` is the map so far.
    """
    began = perf_counter()
    check_world(chain, world)
    one_of("backend", backend, Backend)
    if len(chain.frames) > 1:
        raise InvalidSetting(f"a map is of one frame, this chain places {', '.join(chain.frames)}")
    positions = grid.positions if isinstance(grid, Grid) else array("grid", grid, "k", 3)
    if not len(positions):
        raise InvalidSetting("a map has at least one position, got none")
    if jobs is not None or backend == "dask":
        jobs = 1 if jobs is None else jobs
        check_jobs(jobs)
        need_joblib("a map made by several processes")
    turns, base = _rotations(orientations), chain.reference if q0 is None else chain.configuration(q0)
    question = Question(chain, turns, base, solver, world, as_seed(rng))
    found = _blank(positions, turns, grid.shape if isinstance(grid, Grid) else (len(positions), 1, 1))
    with ExitStack() as held:
        kept = None
        if folder is not None:
            writable(folder, folder=True).mkdir(parents=True, exist_ok=True)
            held.enter_context(locked(folder, "map"))
            kept = Kept(folder, question.digest(positions))
        try:
            for part, status, dexterity in _answers(_left(found, kept), question, jobs, backend, scheduler):
                found.status[part.rows], found.manipulability[part.rows] = status, dexterity
                if kept is not None:
                    kept.write(part.number, (status, dexterity))
                tell(watch, Progress(int((found.status > 0).sum()), found.status.size))
        except KeyboardInterrupt as stop:
            return ended(stop, replace(found, seconds=perf_counter() - began))
        found = replace(found, seconds=perf_counter() - began)
        if folder is not None:
            found.save(folder / RESULT)
    return found


def _blank(positions: Floats, turns: Floats, shape: tuple[int, int, int]) -> Reachability:
    """A map of which nothing was looked at."""
    size = len(positions), max(1, len(turns))
    return Reachability(positions, turns, np.zeros(size, np.uint8), np.full(size, np.nan, np.float32), shape)


def _left(found: Reachability, kept: Kept | None) -> list[Part]:
    """The parts that are still to be answered; what was kept of others is written into the map."""
    k, m = found.status.shape
    size, left = max(1, POSES // m), []
    for number, start in enumerate(range(0, k, size)):
        part = Part(number, start, found.positions[start : start + size])
        known = None if kept is None else kept.read(number, found.status[part.rows].shape)
        if known is None:
            left.append(part)
        else:
            found.status[part.rows], found.manipulability[part.rows] = known
    return left


def _answers(
    parts: list[Part], question: Question, jobs: int | None, backend: Backend, scheduler: str | None
) -> Iterator[tuple[Part, NDArray[np.uint8], NDArray[np.float32]]]:
    """Parts with their status and manipulability (c, m), as they are done."""
    if jobs is None:
        return ((part, *question.answer(part.positions, None)) for part in parts)
    pickled = pickle.dumps(question)
    return worked([Handed(part, pickled) for part in parts], jobs, backend, scheduler)


def _rotations(orientations: int | ArrayLike | None) -> Floats:
    """Orientations (m, 3, 3) somebody gave.

    Raises:
        InvalidSetting: They are none, or not rotations.
    """
    if orientations is None:
        return np.empty((0, 3, 3))
    if isinstance(orientations, int | np.integer) and not isinstance(orientations, bool):
        return spread_rotations(int(orientations))
    given = np.ascontiguousarray(array("orientations", orientations, "...", 3, 3))
    given = given[None] if given.ndim == 2 else given
    if given.ndim != 3 or not len(given):
        raise InvalidSetting(f"orientations are rotations (m, 3, 3), at least one, got shape {given.shape}")
    for k, turn in enumerate(given):
        try:
            Target.facing(turn)
        except InvalidTarget as error:
            raise InvalidSetting(f"orientation {k}: {error}") from None
    return given
