"""Proofs by an arm's closed form: which of its branches may hold a configuration, and what is wrong with the others."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from pin_metaik.kinematics.kernel.layout import O1, O5_TIP, ROUNDING
from pin_metaik.kinematics.limits import Limits
from pin_metaik.kinematics.paths import ChainArrays
from pin_metaik.kinematics.proofs.deviation import deviation, ideal

Floats = NDArray[np.float64]
Place: TypeAlias = tuple[tuple[float, float, float], tuple[float, float, float, float]]
BRANCHES, TURN = 8, 2.0 * math.pi
POSSIBLE, SHOULDER, WRIST, ELBOW, LIMIT = range(5)  # as the compiled loop numbers what is wrong with a branch


@dataclass(frozen=True, eq=False)
class Branches:
    """What a closed form says of the configurations that reach a pose within its tolerances.

    Attributes:
        angles: (8, 6) coordinates of each branch that is real, rad.
        radii: (8, 6) how far the true ones may be from them, rad.
        faults: (8, 3) what is wrong with a branch, the coordinate beyond its limit or -1, and by how much: m, rad, or
            for the wrist the sine of an angle.
        columns: (6,) the coordinate of each joint, from the base on.
        limits: Of the coordinates.
    """

    angles: Floats
    radii: Floats
    faults: Floats
    columns: NDArray[np.int64]
    limits: Limits

    @property
    def possible(self) -> NDArray[np.int64]:
        """Numbers of the branches that may hold a configuration."""
        return np.flatnonzero(self.faults[:, 0] == POSSIBLE)

    @property
    def proved(self) -> bool:
        """Whether it is proved that no configuration inside the limits reaches the pose."""
        return not len(self.possible)

    @property
    def boxes(self) -> Floats:
        """(b, 12) coordinates of the branches that may hold a configuration, and how far the true ones may be off."""
        angles, radii = self.angles[self.possible], self.radii[self.possible]
        turns = np.ceil((self.limits.lower - ROUNDING - radii - angles) / TURN)  # to the first copy that is not below
        bound = np.isfinite(self.limits.lower) & (radii < np.pi)
        return np.hstack([angles + TURN * np.where(bound, turns, 0.0), radii])

    @property
    def pieces(self) -> Floats:
        """(b, 12) boxes that hold all configurations inside the limits: those of the branches, cut at the limits.

        An angle within its radius may be inside the limits at both of their ends; then there is a box for each.
        """
        found: list[list[tuple[float, float]]] = []
        for number in self.possible:
            spans = [self._spans(c, float(self.angles[number, c]), float(self.radii[number, c])) for c in range(6)]
            found += [list(way) for way in product(*spans)]
        ends = np.array(found).reshape(-1, 6, 2)
        return np.hstack([ends.mean(axis=2), 0.5 * (ends[:, :, 1] - ends[:, :, 0])])

    def _spans(self, c: int, angle: float, radius: float) -> list[tuple[float, float]]:
        """The parts of a range that an angle and its copies may lie in, those that are the same but for turns once."""
        lower, upper = float(self.limits.lower[c]), float(self.limits.upper[c])
        if radius >= math.pi:
            least = lower if math.isfinite(lower) else upper - TURN if math.isfinite(upper) else -math.pi
            return [(least, min(upper, least + TURN))]
        if not math.isfinite(lower) or not math.isfinite(upper):
            return [(angle - radius, angle + radius)]
        first = math.ceil((lower - ROUNDING - radius - angle) / TURN)
        last = math.floor((upper + ROUNDING + radius - angle) / TURN)
        ends = [(angle + TURN * k - radius, angle + TURN * k + radius) for k in range(first, last + 1)]
        whole = [(low, high) for low, high in ends if low >= lower and high <= upper]
        return whole[:1] or [(min(max(low, lower), upper), max(min(high, upper), lower)) for low, high in ends]

    def nearest(self) -> Floats | None:
        """Coordinates (6,) of the branch least beyond a limit, brought inside the limits; None, if none is real."""
        beyond = self.faults[:, 0] == LIMIT
        if not beyond.any():
            return None
        x = self.angles[np.argmin(np.where(beyond, self.faults[:, 2], np.inf))]
        ways = zip(x.tolist(), self.limits.lower.tolist(), self.limits.upper.tolist(), strict=True)
        return np.array([min(max(_copy(*way)[0], way[1]), way[2]) for way in ways])

    def why(self) -> str:
        """What keeps the arm from the pose, on the branch that comes nearest to it."""
        names, limits = self.limits.names, self.limits
        real = self.faults[:, 0] == LIMIT
        if real.any():
            number = int(np.argmin(np.where(real, self.faults[:, 2], np.inf)))
            _, column, over = self.faults[number]
            c = int(column)
            angle, side = _copy(float(self.angles[number, c]), float(limits.lower[c]), float(limits.upper[c]))
            return (
                f"{real.sum()} of its {BRANCHES} closed-form branches are real; the nearest needs {names[c]} at "
                f"{angle:.4g} rad, {over:.2g} rad beyond its limit {side:.4g}"
            )
        step = np.argmin(np.where(self.faults[:, 0] == WRIST, np.inf, self.faults[:, 2]))
        if self.faults[step, 0] == SHOULDER:
            return f"the wrist would be {self.faults[step, 2]:.2g} m too near to the axis of {names[self.columns[0]]}"
        if self.faults[step, 0] == ELBOW:
            upper, fore = names[self.columns[1]], names[self.columns[2]]
            return f"the links after {upper} and {fore} miss the wrist by {self.faults[step, 2]:.2g} m"
        return f"no angle of {names[self.columns[4]]} turns the last axis as this orientation asks"


@dataclass(frozen=True, eq=False)
class ClosedFormProof:
    """Decides whether an arm with a closed form reaches a pose.

    Attributes:
        form: (16, 3) the closed form, its parallel axes parallel to the last digit.
        wiring: (6, 2) of the arm's joints.
        limits: Of its coordinates.
        deviation: (2,) how far (m) the arm's tip may be from the closed form's, and by how much turned (rad).
    """

    form: Floats
    wiring: NDArray[np.int64]
    limits: Limits
    deviation: Floats

    @staticmethod
    def of(form: Floats, paths: ChainArrays, limits: Limits) -> ClosedFormProof:
        """The proof for an arm's closed form, with how far the arm is from it."""
        exact = ideal(form)
        near, aligned = deviation(paths, exact)
        size = float(np.linalg.norm(exact[O1 : O5_TIP + 1], axis=1).sum())
        off = np.array([near + ROUNDING * (1.0 + size), aligned + ROUNDING])
        return ClosedFormProof(exact, paths.wiring, limits, off)

    def judge(self, pose: Floats, near: float, aligned: float) -> Branches:
        """Which branches may hold a configuration whose tip is within ``near`` (m) and ``aligned`` (rad) of a pose."""
        from pin_metaik.kinematics.proofs.branch_balls import judge_pose

        angles, radii, faults = np.zeros((BRANCHES, 6)), np.zeros((BRANCHES, 6)), np.empty((BRANCHES, 3))
        how = self.form, self.deviation, self.wiring, *self.limits.arrays
        judge_pose(*how, pose, near, aligned, angles, radii, faults)
        columns = self.wiring[:, 0]
        return Branches(angles[:, columns.argsort()], radii[:, columns.argsort()], faults, columns, self.limits)

    @cached_property
    def _every(self) -> Callable[..., tuple[int, int, *Place]]:
        from pin_metaik.kinematics.proofs.every_branch import every_branch

        return every_branch.compiled()  # type: ignore[attr-defined,no-any-return]  # ``jit`` puts it there

    def every(self, block: Floats, pose: Floats, apart: float, q: Floats, out: Floats) -> tuple[int, int, *Place]:
        """All configurations for a pose, in one compiled call; see ``every_branch``, which has the arguments."""
        return self._every(block, self.form, self.deviation, pose, apart, q, out)


def _copy(angle: float, lower: float, upper: float) -> tuple[float, float]:
    """The copy of an angle by whole turns that is nearest to a range, and the side of it that is nearest to that."""
    if lower == -math.inf:
        return angle, upper
    above = angle + TURN * math.ceil((lower - angle) / TURN)
    return (above, upper) if above - upper <= lower - (above - TURN) else (above - TURN, lower)
