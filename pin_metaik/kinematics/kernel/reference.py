"""The descent once more in Pinocchio and NumPy: to be read, and for tests that the compiled loops do the same.

For one frame and a whole pose, from given starts: what ``multistart.search`` does without a table of samples.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

import numpy as np
import pinocchio as pin

from pin_metaik.kinematics.kernel.descent import DAMPING_FLOOR, EXACT, PATIENCE, POLISH
from pin_metaik.kinematics.kernel.layout import Floats
from pin_metaik.kinematics.kernel.limited_step import limited_step


@dataclass(frozen=True)
class Problem:
    """A pose for a frame.

    Attributes:
        model: Pinocchio's model.
        frame: Id of the frame.
        goal: World pose it shall reach.
        q: The configuration (nq,) at coordinates (n,).
        columns: (n,) columns of Pinocchio's Jacobian that belong to the coordinates.
        lower: (n,) limits of the coordinates.
        upper: (n,) likewise.
        tolerance: m and rad.
        data: Pinocchio's scratch.
    """

    model: pin.Model
    frame: int
    goal: pin.SE3
    q: Callable[[Floats], Floats]
    columns: list[int]
    lower: Floats
    upper: Floats
    tolerance: float = 1e-5
    data: pin.Data = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "data", self.model.createData())


def residual(problem: Problem, x: Floats) -> tuple[Floats, Floats]:
    """Translation and rotation vector r (6,) of T_goal^-1 T_frame at x (n,), and J (6, n): dr/dx near the goal.

    J is the Jacobian of the frame in the goal's axes. Its rotation rows are angular velocity, not d log(R).
    """
    model, data, frame, to_goal = problem.model, problem.data, problem.frame, problem.goal.rotation.T
    J = pin.computeFrameJacobian(model, data, problem.q(x), frame, pin.LOCAL_WORLD_ALIGNED)[:, problem.columns]
    error = problem.goal.actInv(pin.updateFramePlacement(model, data, frame))
    return np.concatenate([error.translation, pin.log3(error.rotation)]), np.vstack([to_goal @ J[:3], to_goal @ J[3:]])


def descend(
    problem: Problem, start: Floats, evaluations: int, damping: float, progress: float
) -> tuple[Floats, int, bool]:
    """Descend from one start (n,): the best coordinates (n,), evaluations spent, whether the tolerances are met.

    Once they are, a few more steps are taken while each gains a decade. A start is given up unless ``PATIENCE`` steps
    bring the squared error below the share ``progress``.
    """
    x = best = np.clip(start, problem.lower, problem.upper)
    least = mark = np.inf
    found, polish = False, POLISH
    for i in range(evaluations):
        r, J = residual(problem, x)
        square = float(r @ r)
        met = bool(max(np.linalg.norm(r[:3]), np.linalg.norm(r[3:])) <= 0.999 * problem.tolerance)
        if found and not (met and square < 0.01 * least):
            return best, i + 1, True
        if met or square < least:
            best, least = x, square
        if met:
            polish = polish - 1 if found else POLISH
            found = True
            if polish == 0 or square < EXACT:
                return best, i + 1, True
        elif i % PATIENCE == 0:
            if square > progress * mark:
                return best, i + 1, False
            mark = square
        x = limited_step(x, r, J, problem.lower, problem.upper, damping * square + DAMPING_FLOOR)
    return best, evaluations, found


def solve(
    problem: Problem,
    starts: Iterable[Floats],
    evaluations: int,
    damping: float = 0.005,
    progress: float = 0.49,
    per_start: int = 100,
) -> tuple[Floats | None, int]:
    """Coordinates (n,) that meet the tolerances, from the first of the starts that leads there; evaluations spent."""
    spent = 0
    for start in starts:
        x, steps, met = descend(problem, start, min(per_start, evaluations - spent), damping, progress)
        spent += steps
        if met:
            return x, spent
    return None, spent
