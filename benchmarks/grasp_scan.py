"""A target in a world decided by brute force, by Pinocchio, NumPy and coal alone: what verdicts are compared with.

    python benchmarks/grasp_scan.py panda --grasps 20

Plain damped least squares from hundreds of random configurations; of an arm with seven joints at every step of the
last of them, so that all of its self-motion is walked along, and between the steps where it collides least. Every
solution is looked at by coal, pair by pair (``collision_truth.py``), until one is free. Slow, and asks nothing of the
package.
"""

from __future__ import annotations

import argparse
import json
import runpy
import time
from collections import Counter
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import pinocchio as pin
from collision_truth import Truth
from numpy.typing import NDArray

import pin_metaik as mik
from pin_metaik.collision import load_scene

Floats = NDArray[np.float64]
Known: TypeAlias = dict[bytes, tuple[float, Floats]]  # clearance of solutions, and they

EXAMPLE = Path(__file__).parents[1] / "examples" / "12_screen_grasps.py"
SOLVABLE, COLLIDES, NONE = "solvable", "every solution collides", "no solution"
TOLERANCE = 1e-5  # m and rad
STARTS = 600  # random configurations of an arm of six joints
STEP = 0.01  # rad, of the seventh joint
EACH = 24  # random configurations of the other six at every step
BLOCK = 600  # descents at once; after each block a free solution ends it
STEPS, LOOK, GAIN = 80, 10, 0.5  # of one descent; it is given up unless the error halves in ten
ALIKE = 0.005  # rad; solutions as near as this to each other are looked at once
SHALLOW, BESIDE = 30, 41  # solutions that collide least are looked at again, at so many steps between the steps


@dataclass(frozen=True, eq=False)
class PlainArm:
    """Joints as screws of the world at one configuration (Murray, Li and Sastry 1994, chapter 3), many at once.

    Attributes:
        q: (nq,) that configuration.
        columns: (n,) entries of a configuration that are the joints'.
        axes: (n, 3) axes in it; of a joint that slides its direction.
        points: (n, 3) a point on each.
        turns: (n,) whether a joint turns.
        tip: (4, 4) the tip's pose in it.
        lower: (n,) limits, rad or m.
        upper: (n,) limits.
    """

    q: Floats
    columns: NDArray[np.int64]
    axes: Floats
    points: Floats
    turns: NDArray[np.bool_]
    tip: Floats
    lower: Floats
    upper: Floats

    @staticmethod
    def of(model: pin.Model, frame: str) -> PlainArm:
        """The joints between the world and a frame, each of one number."""
        q, data, number = pin.neutral(model), model.createData(), model.getFrameId(frame)
        joints = list(model.supports[model.frames[number].parentJoint])[1:]
        assert all(model.joints[j].nq == 1 for j in joints), "joints of one number each"
        columns = np.array([model.joints[j].idx_q for j in joints])
        screws = pin.computeJointJacobians(model, data, q)[:, [model.joints[j].idx_v for j in joints]].T
        pin.framesForwardKinematics(model, data, q)
        turns = np.linalg.norm(screws[:, 3:], axis=1) > 0.5
        axes = np.where(turns[:, None], screws[:, 3:], screws[:, :3])
        points = np.cross(screws[:, 3:], screws[:, :3])
        lower, upper = model.lowerPositionLimit[columns], model.upperPositionLimit[columns]
        return PlainArm(q, columns, axes, points, turns, data.oMf[number].homogeneous, lower, upper)

    def configuration(self, x: Floats) -> Floats:
        """The configuration (nq,) of joint values x (n,)."""
        q = self.q.copy()
        q[self.columns] = x
        return q

    def place(self, X: Floats) -> tuple[Floats, Floats, Floats]:
        """Rotations (k, 3, 3), positions (k, 3) and Jacobians (k, 6, n) of the tip, in world axes, at X (k, n)."""
        k, n = X.shape
        R, p = np.broadcast_to(np.eye(3), (k, 3, 3)), np.zeros((k, 3))
        axes, points = np.empty((n, k, 3)), np.empty((n, k, 3))
        for i, (axis, point, turns) in enumerate(zip(self.axes, self.points, self.turns, strict=True)):
            axes[i], points[i] = R @ axis, R @ point + p
            d = X[:, i] - self.q[self.columns[i]]
            if turns:
                K = pin.skew(axis)
                turn = np.eye(3) + np.sin(d)[:, None, None] * K + (1.0 - np.cos(d))[:, None, None] * (K @ K)
                R, p = R @ turn, p + (R @ (point - turn @ point)[..., None])[..., 0]
            else:
                p = p + d[:, None] * axes[i]
        rotation, position = R @ self.tip[:3, :3], R @ self.tip[:3, 3] + p
        J = np.empty((k, 6, n))
        for i, turns in enumerate(self.turns):
            J[:, :3, i] = np.cross(axes[i], position - points[i]) if turns else axes[i]
            J[:, 3:, i] = axes[i] if turns else 0.0
        return rotation, position, J

    def errors(self, X: Floats, pose: Floats) -> tuple[Floats, Floats]:
        """What is missing to a pose (4, 4), positions and rotation vectors (k, 6), and Jacobians."""
        rotation, position, J = self.place(X)
        left = pose[:3, :3] @ rotation.transpose(0, 2, 1)
        axis = 0.5 * np.stack(
            [left[:, 2, 1] - left[:, 1, 2], left[:, 0, 2] - left[:, 2, 0], left[:, 1, 0] - left[:, 0, 1]], 1
        )
        sine = np.linalg.norm(axis, axis=1)
        angle = np.arctan2(sine, 0.5 * (np.trace(left, axis1=1, axis2=2) - 1.0))
        turn = np.where(sine > 1e-12, angle / np.maximum(sine, 1e-12), 1.0)[:, None] * axis
        return np.concatenate([pose[:3, 3] - position, turn], axis=1), J

    def descend(self, X: Floats, pose: Floats, free: NDArray[np.bool_], near: float = TOLERANCE) -> Floats:
        """Solutions (l, n) that damped least squares come to from X (k, n), moving the ``free`` joints (n,) alone.

        They are within ``near`` (m and rad) of the pose (4, 4).

        Joints that a step would take past a limit are held there, and the step is worked out once more without them.
        """
        found, before = [], np.full(len(X), np.inf)
        for step in range(STEPS):
            e, J = self.errors(X, pose)
            size = np.linalg.norm(e, axis=1)
            there = (np.linalg.norm(e[:, :3], axis=1) < near) & (np.linalg.norm(e[:, 3:], axis=1) < near)
            found.append(X[there])
            kept = ~there
            if step % LOOK == LOOK - 1:
                kept &= size < GAIN * before
                before = size
            X, e, J, before, size = X[kept], e[kept], J[kept], before[kept], size[kept]
            if not len(X):
                break
            moving = np.broadcast_to(free, X.shape)
            damping = (1e-2 * size**2 + 1e-12)[:, None, None] * np.eye(6)
            for _ in range(2):
                A = J * moving[:, None, :]
                dx = (A.transpose(0, 2, 1) @ np.linalg.solve(A @ A.transpose(0, 2, 1) + damping, e[..., None]))[..., 0]
                beyond = ((self.lower >= X) & (dx < 0.0)) | ((self.upper <= X) & (dx > 0.0))
                moving = moving & ~beyond
            X = np.clip(X + dx * moving, self.lower, self.upper)
        return np.concatenate(found)


@dataclass(frozen=True)
class Verdict:
    """What a scan came to.

    Attributes:
        verdict: ``SOLVABLE``, ``COLLIDES`` or ``NONE``.
        solutions: How many solutions were looked at.
        clearance: Of the best of them, m; below 0 where it collides, by how much is not to be relied on.
        seconds: Processor time, s.
    """

    verdict: str
    solutions: int
    clearance: float
    seconds: float


@dataclass(frozen=True, eq=False)
class Scan:
    """Decides targets of a robot in a world."""

    arm: PlainArm
    truth: Truth

    @staticmethod
    def of(robot: mik.Robot, world: mik.CollisionWorld) -> Scan:
        """The scan of a robot's default frame; of the world only its geometry and the pairs that may touch are used."""
        return Scan(PlainArm.of(robot.model, robot.frame), Truth.of(world))

    def starts(self, rng: np.random.Generator) -> tuple[Floats, NDArray[np.bool_]]:
        """Where to descend from (k, n), in any order, and which joints may move."""
        n = len(self.arm.lower)
        free = np.ones(n, bool)
        if n <= 6:
            return rng.uniform(self.arm.lower, self.arm.upper, (STARTS, n)), free
        assert n == 7, "arms of at most seven joints"
        free[-1] = False
        low, high = self.arm.lower[-1], self.arm.upper[-1]
        grid = np.linspace(low, high, int(np.ceil((high - low) / STEP)) + 1)
        X = rng.uniform(self.arm.lower, self.arm.upper, (len(grid) * EACH, n))
        X[:, -1] = np.repeat(grid, EACH)
        return rng.permutation(X), free

    def decide(self, pose: Floats, rng: np.random.Generator) -> Verdict:
        """Whether a pose (4, 4) can be met free of collisions, only in collision, or not at all."""
        began, known = time.process_time(), Known()
        X, free = self.starts(rng)
        blocks = np.array_split(X, -(-len(X) // BLOCK))
        if not any(self._look(self.arm.descend(block, pose, free), ALIKE, known) for block in blocks):
            self._look(self.arm.descend(self.between(known.values(), free), pose, free), STEP / BESIDE, known)
        clearance = max((clearance for clearance, _ in known.values()), default=-np.inf)
        verdict = NONE if not known else SOLVABLE if clearance > 0.0 else COLLIDES
        return Verdict(verdict, len(known), clearance, time.process_time() - began)

    def _look(self, X: Floats, alike: float, known: Known) -> bool:
        """Look at solutions (l, n), one of those that are alike, until one is free; returns whether one is."""
        for x in X:
            name = np.round(x / alike).tobytes()
            if name not in known:
                known[name] = self.truth.least(self.arm.configuration(x)), x
                if known[name][0] > 0.0:
                    return True
        return False

    def between(self, known: Iterable[tuple[float, Floats]], free: NDArray[np.bool_]) -> Floats:
        """Starts (k, n) between the steps beside the solutions that collide least."""
        least = sorted(known, key=lambda one: -one[0])[:SHALLOW]
        if free.all() or not least:
            return np.empty((0, len(free)))
        X = np.repeat([x for _, x in least], BESIDE, axis=0)
        X[:, ~free] += np.tile(np.linspace(-STEP, STEP, BESIDE), len(least))[:, None]
        return np.clip(X, self.arm.lower, self.arm.upper)


def grasps(count: int, seed: int = 0) -> Floats:
    """The grasps (count, 4, 4) of the example."""
    poses: Floats = runpy.run_path(str(EXAMPLE))["grasps"](count, np.random.default_rng(seed))
    return poses


@cache
def shelf_of(robot: str) -> tuple[mik.Chain, mik.CollisionWorld]:
    """A robot before the shelf."""
    loaded = mik.load_robot(robot)
    return mik.Chain(loaded.model, loaded.frame), mik.CollisionWorld(loaded, load_scene("shelf"))


@cache
def _scan(robot: str) -> Scan:
    return Scan.of(mik.load_robot(robot), shelf_of(robot)[1])


def decide(robot: str, number: int, pose: Floats) -> Verdict:
    """The verdict on one grasp."""
    return _scan(robot).decide(pose, np.random.default_rng(number))


def verdicts(robot: str, poses: Floats, workers: int, kept: Path | None = None) -> list[Verdict]:
    """The verdicts on grasps (k, 4, 4) of the shelf; read from a file, if it has them, or written to it."""
    if kept is not None and kept.exists():
        known: dict[str, Any] = json.loads(kept.read_text(encoding="utf-8"))
        if known.get(robot, {}).get("poses") == poses.tolist():
            return [Verdict(**one) for one in known[robot]["verdicts"]]
    with ProcessPoolExecutor(workers) as pool:
        found = list(pool.map(decide, [robot] * len(poses), range(len(poses)), poses))
    if kept is not None:
        known = json.loads(kept.read_text(encoding="utf-8")) if kept.exists() else {}
        known[robot] = {"poses": poses.tolist(), "verdicts": [asdict(one) for one in found]}
        kept.write_text(json.dumps(known), encoding="utf-8")
    return found


def main() -> None:
    """Scan the example's grasps and print how many came to what."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("robots", nargs="*", default=["panda", "ur5"])
    parser.add_argument("--grasps", type=int, default=300)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--kept", type=Path, help="file that verdicts are kept in")
    given = parser.parse_args()
    for robot in given.robots:
        found = verdicts(robot, grasps(given.grasps), given.workers, given.kept)
        counts = ", ".join(f"{many} {verdict}" for verdict, many in Counter(v.verdict for v in found).most_common())
        print(f"{robot}: {counts}; {sum(v.seconds for v in found):.0f} s of processor time")


if __name__ == "__main__":
    main()
