"""Targets for inverse kinematics, in families: random, near the limits, singular, out of reach."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

import pin_metaik as mik

NEAR = 0.01  # of its range: how near a limit a joint is in the family near-limit
SINGULAR = 1e-3  # smallest singular value of the frame's Jacobian (m and rad alike)
BEYOND = (0.01, 0.5)  # m past the reach bound

FAMILIES = {
    "random": "Poses of configurations drawn uniformly within the limits, one turn for continuous joints.",
    "near-limit": "Poses of configurations with half of the joints within 1 % of one of their limits.",
    "singular": "Poses of configurations whose Jacobian has a singular value below 1e-3, found by Gauss-Newton steps.",
    "unreachable": (
        "Random poses pushed radially outward, 1 to 50 cm past the bound on the arm's reach that `pin_metaik` computes "
        "from its links: what is measured is that it says so, and how soon. Peers have no such answer; they spend "
        "their time."
    ),
}

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Targets:
    """Poses to reach, and where to start from.

    Attributes:
        poses: (k, 4, 4) in the world.
        starts: (k, n) random coordinates inside the limits.
    """

    poses: Floats
    starts: Floats


def targets(robot: str, chain: mik.Chain, family: str, count: int, seed: int) -> Targets:
    """Targets of a family, the same for the same robot, family, count and seed."""
    key = [seed, *hashlib.sha256(f"{robot} {family}".encode()).digest()[:8]]
    rng = np.random.default_rng(key)
    if family == "singular":
        X = _remembered(f"singular-{robot}", chain, count, seed, lambda: singular(chain, count, rng))
    elif family == "near-limit":
        X = near_limit(chain, count, rng)
    else:
        X = chain.box.sample(rng, count)
    poses = np.array([chain.placements(q)[0].homogeneous for q in chain.q(X)])
    if family == "unreachable":
        poses = pushed_out(chain, poses, rng)
    return Targets(poses, chain.box.sample(np.random.default_rng([*key, 1]), count))


def near_limit(chain: mik.Chain, count: int, rng: np.random.Generator) -> Floats:
    """Coordinates (count, n), half of the joints within 1 % of one of their limits; continuous joints have none."""
    X = chain.box.sample(rng, count)
    limited = np.flatnonzero(~chain.limits.periodic)
    chosen = rng.permuted(np.tile(limited, (count, 1)), axis=1)[:, : min(chain.n // 2, len(limited))]
    rows = np.arange(count)[:, None]
    low, span = chain.box.lower[chosen], (chain.box.upper - chain.box.lower)[chosen]
    depth = rng.uniform(0.0, NEAR, chosen.shape)
    X[rows, chosen] = low + span * np.where(rng.random(chosen.shape) < 0.5, depth, 1.0 - depth)
    return X


def pushed_out(chain: mik.Chain, poses: Floats, rng: np.random.Generator) -> Floats:
    """The poses (k, 4, 4) moved outward, away from the first axis of the arm, until past the bound on its reach."""
    reach = chain.reach(0, oriented=True)
    far = poses.copy()
    for pose in far:
        out = pin.SE3(pose).act(reach.end) - reach.anchor
        span = float(np.linalg.norm(out))
        pose[:3, 3] += out / span * (reach.most + rng.uniform(*BEYOND) - span)
    return far


def singular(chain: mik.Chain, count: int, rng: np.random.Generator) -> Floats:
    """Coordinates (count, n) where the Jacobian's smallest singular value is below 1e-3, from random starts.

    At a singularity some u has J(x)^T u = 0. With u the singular vector of the smallest value, Gauss and Newton's step
    on J(x)^T u, then u anew.
    """
    found = np.empty((0, chain.n))
    while len(found) < count:
        X = chain.box.sample(rng, max(64, 2 * (count - len(found))))
        for _ in range(30):
            J = jacobians(chain, X)  # (k, 6, n)
            U, sigma, _ = np.linalg.svd(J)
            done = sigma[:, 5] < SINGULAR
            found = np.concatenate((found, X[done]))
            X, J, u = X[~done], J[~done], U[~done, :, 5]
            if not len(X) or len(found) >= count:
                break
            r = np.einsum("kji,kj->ki", J, u)  # (k, n)
            slope = np.empty((len(X), chain.n, chain.n))  # of r, by differences
            for i in range(chain.n):
                h = np.zeros(chain.n)
                h[i] = 1e-6
                slope[:, :, i] = np.einsum("kji,kj->ki", jacobians(chain, X + h) - J, u) / 1e-6
            normal = np.swapaxes(slope, 1, 2) @ slope + 1e-6 * np.eye(chain.n)
            step = -np.linalg.solve(normal, np.einsum("kji,kj->ki", slope, r)[..., None])[..., 0]
            step *= np.minimum(1.0, 0.5 / np.maximum(np.linalg.norm(step, axis=1, keepdims=True), 1e-12))
            X = np.minimum(np.maximum(X + step, chain.box.lower), chain.box.upper)
    return found[:count]


def jacobians(chain: mik.Chain, X: Floats) -> Floats:
    """Jacobians (k, 6, n) of the chain's frame at coordinates X (k, n), linear part first, in world axes."""
    joints, wiring, _, tips = chain.paths.arrays
    R, p = np.broadcast_to(np.eye(3), (len(X), 3, 3)), np.zeros((len(X), 3))
    axes, points = [], []
    for row, (column, rotates) in zip(joints, wiring, strict=True):
        R, p = R @ row[:9].reshape(3, 3), p + R @ row[9:12]
        axes.append(R[:, :, 2])
        points.append(p)
        x = row[12] * X[:, column] + row[13]
        if rotates:
            turn = np.zeros((len(X), 3, 3))
            turn[:, 0, 0] = turn[:, 1, 1] = np.cos(x)
            turn[:, 1, 0] = np.sin(x)
            turn[:, 0, 1] = -turn[:, 1, 0]
            turn[:, 2, 2] = 1.0
            R = R @ turn
        else:
            p = p + x[:, None] * R[:, :, 2]
    tip = p + R @ tips[0, 9:]
    J = np.zeros((len(X), 6, chain.n))
    for axis, point, (column, rotates) in zip(axes, points, wiring, strict=True):
        J[:, :3, column] = np.cross(axis, tip - point) if rotates else axis
        J[:, 3:, column] = axis if rotates else 0.0
    return J


def _remembered(label: str, chain: mik.Chain, count: int, seed: int, make: Callable[[], Floats]) -> Floats:
    """What ``make`` makes, kept in the user's cache for the same arm, limits, count and seed."""
    arm = hashlib.sha256()
    for array in (*chain.paths.arrays, chain.box.lower, chain.box.upper):
        arm.update(np.ascontiguousarray(array).tobytes())
    root = os.environ.get("XDG_CACHE_HOME") or os.environ.get("LOCALAPPDATA") or Path.home() / ".cache"
    path = Path(root) / "pin_metaik" / "benchmarks" / f"{label}-{count}-seed{seed}-{arm.hexdigest()[:12]}.npy"
    if path.exists():
        return np.load(path)
    X = make()
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f"{path.name}.{os.getpid()}")
    with partial.open("wb") as file:
        np.save(file, X)
    partial.replace(path)
    return X
