"""Names of the branches of solutions, which stay the same from pose to pose until a singularity is crossed."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arrays import Array
from pin_metaik.ik.problem import IKProblem

NAMES = ("shoulder", "elbow", "wrist")
WHOLE = "determinant"
FLAT = 1e-9  # of its greatest size: a factor that is 0 but for rounding
SIGNS = {-1: "-", 0: "0", 1: "+"}

Signs = NDArray[np.int8]


def signs_of(problem: IKProblem, X: Array) -> Signs:
    """Signs (k, f) of what vanishes in the singularities of a problem, at coordinates X (k, n) that solve it.

    f is 3 for arms of six joints with a closed form, 1 for other problems with as many coordinates as their targets
    count axes, and 0 for all others, whose solutions are not separate.
    """
    chain, plain = problem.chain, len(problem.targets) == 1 and not problem.goals
    if not plain or problem.m != chain.n:
        return np.zeros((len(X), 0), np.int8)
    if chain.n != 6:
        values = np.array([[np.linalg.det(problem.linearize(x)[1])] for x in X]).reshape(-1, 1)
        return _signs(values, np.ones(1))
    values = np.zeros((len(X), 4))
    chain.kernels.factors(chain.block if chain.has_pose_solver else chain.bare, np.ascontiguousarray(X), values)
    size = float(np.linalg.norm([*chain.paths.joints[:, 9:12], chain.paths.tips[0, 9:]], axis=1).sum())
    if len(chain.form):
        return _signs(values[:, :3], np.array([size, size * size, 1.0]))
    return _signs(values[:, 3:], np.array([size**3]))


def on_other_branches(before: Signs, after: Signs) -> NDArray[np.bool_]:
    """Which solutions (k, f) of one problem and (l, g) of the next are on different branches: (k, l).

    None, if the problems have not the same factors, as a pose and a position have not.
    """
    if before.shape[1] != after.shape[1]:
        return np.zeros((len(before), len(after)), np.bool_)
    differ: NDArray[np.bool_] = (before[:, None] != after[None]).any(axis=2)
    return differ


def labels_of(problem: IKProblem, X: Array) -> tuple[str, ...]:
    """A name for each of the solutions X (k, n) of a problem: the factors of its singularities with their signs.

    Empty, where solutions are not separate.
    """
    return tuple(name_of(row) for row in signs_of(problem, X))


def name_of(signs: Signs) -> str:
    """The signs (f,) of one solution in words."""
    names = NAMES if len(signs) == len(NAMES) else (WHOLE,) * len(signs)
    return " ".join(f"{name} {SIGNS[int(sign)]}" for name, sign in zip(names, signs, strict=True))


def _signs(values: Array, sizes: Array) -> Signs:
    signs: Signs = np.where(np.abs(values) <= FLAT * sizes, 0.0, np.sign(values)).astype(np.int8)
    return signs
