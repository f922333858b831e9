"""The fast lane of the default solver: a pose or a position for one frame, through one compiled call.

``solve_ik`` and ``solve_ik_batch`` both take it. It is the first step of ``IKSolver()``; what that does not solve goes
on the long way, through targets, problems and ledgers, which cost three times as much Python.
"""

from __future__ import annotations

import math
from time import perf_counter

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from pin_metaik.ik.refine.dls import DLS, PROGRESS
from pin_metaik.ik.refine.protocol import Refinement
from pin_metaik.ik.result import IKResult, IKStatus
from pin_metaik.ik.solver import IKSolver
from pin_metaik.ik.starts import LANE, drawn
from pin_metaik.ik.target import DEFAULT_TOLERANCE, Target
from pin_metaik.kinematics import Chain
from pin_metaik.randomness import Rng

LAST_ROW = [0.0, 0.0, 0.0, 1.0]


def run_lane(
    chain: Chain,
    solver: IKSolver,
    dls: DLS,
    starts: NDArray[np.float64],
    tolerances: tuple[float, float],
    targets: NDArray[np.float64],
    q0: NDArray[np.float64],
    q: NDArray[np.float64],
) -> NDArray[np.int64]:
    """Solve poses (k, 4, 4) from q0 (k, nq) into q (k, nq); returns (k, 2): evaluations, and how each ended.

    The loop writes nothing into q that is outside the limits; how near q is remains for Pinocchio to say.
    """
    ended = np.empty((len(q), 2), np.int64)
    kernels, oriented = chain.kernels, tolerances[1] < math.inf
    kernels.solve_poses.compiled(oriented)(
        *chain.lane(oriented),
        None if oriented else kernels.POSITION,
        starts,
        dls.damping,
        PROGRESS,
        dls.iterations,
        solver.first_evaluations,
        *tolerances,
        targets,
        q0,
        q,
        ended,
    )
    return ended


def solve_fast(
    chain: Chain, target: object, q0: ArrayLike | None, solver: IKSolver, rng: Rng
) -> IKResult | Refinement | None:
    """The result; where the first starts do not solve it, what they came to; None for what the lane cannot take."""
    began = perf_counter()
    dls = solver.fast
    if dls is None or len(chain.frames) > 1:
        return None
    tolerances = DEFAULT_TOLERANCE, DEFAULT_TOLERANCE
    if isinstance(target, pin.SE3):
        goal = pin.SE3(target)
    elif isinstance(target, np.ndarray) and target.shape == (4, 4) and target.dtype.kind == "f":
        goal = pin.SE3(target)
        if target[3].tolist() != LAST_ROW:
            return None
    elif isinstance(target, Target) and target.plain:
        goal, tolerances = target.pose, target.allowance
    else:
        return None
    try:
        start = chain.reference if q0 is None else np.ascontiguousarray(q0, dtype=float)
    except (TypeError, ValueError):
        return None
    if start.shape != chain.reference.shape:
        return None
    q = np.empty((1, len(start)))
    starts = drawn(chain, rng, 0, LANE)
    ended = run_lane(
        chain, solver, dls, starts, tolerances, np.ascontiguousarray(goal.homogeneous)[None], start[None], q
    )
    spent, end = ended[0].tolist()
    if end not in (chain.kernels.SOLVED, chain.kernels.UNSOLVED):
        return None
    position, orientation = errors(chain, goal, q[0], tolerances)
    if position > tolerances[0] or orientation > tolerances[1]:
        return Refinement(chain.x(q[0]), False, spent)
    return IKResult(
        q[0],
        IKStatus.SOLVED,
        position,
        orientation,
        spent,
        perf_counter() - began,
        chain,
        target if isinstance(target, Target) else goal,
    )


def errors(chain: Chain, goal: pin.SE3, q: NDArray[np.float64], tolerances: tuple[float, float]) -> tuple[float, float]:
    """Distance (m) and angle (rad; 0 where free) of the chain's frame from a goal at q (nq,), by Pinocchio."""
    error = goal.actInv(chain.place(chain.data, q))
    x, y, z, i, j, k, w = pin.SE3ToXYZQUATtuple(error)  # as exact as log3, at a quarter of the time
    angle = 2.0 * math.atan2(math.sqrt(i * i + j * j + k * k), abs(w))
    return math.sqrt(x * x + y * y + z * z), 0.0 if tolerances[1] == math.inf else angle
