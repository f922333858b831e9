"""Targets for inverse kinematics, in families: random, near the limits, singular, out of reach."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import pin_metaik as mik
from pin_metaik.compare.cases.just_out_of_reach import pushed_out
from pin_metaik.compare.cases.near_limit import near_limit
from pin_metaik.compare.cases.singular import singular

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
        poses = pushed_out(chain, poses, rng, BEYOND)
    return Targets(poses, chain.box.sample(np.random.default_rng([*key, 1]), count))


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
