"""The first step of the default solver: a pose or a position for one frame, through one compiled call.

``solve_ik`` and ``solve_ik_batch`` begin with it. A target that it does not decide goes on to ``IKSolver.search``,
through targets, problems and search states, which cost several times as much Python.

Of the 3.0 us that a pose for ur5 takes in a plain loop:

| step | us |
|---|---|
| the compiled call, of which the loops take 0.5 | 1.1 |
| the placement of the tip by Pinocchio | 0.6 |
| comparing it with the target | 0.4 |
| the result | 0.2 |
| a copy of the start | 0.1 to 0.2 |

What was tried: a ``pin.SE3`` of one's own costs 0.6 us to make and a relative placement 0.4, two tuples compared by
``math.dist`` 0.1; a frozen dataclass of eleven fields 0.9.
"""

from __future__ import annotations

import math
from time import perf_counter

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from pin_metaik.ik.goals.pose import DEFAULT_TOLERANCE, Target
from pin_metaik.ik.proof import Proof
from pin_metaik.ik.refine.descent import SETTLED, STIFF
from pin_metaik.ik.refine.protocol import Refinement
from pin_metaik.ik.result import IKResult, IKStatus
from pin_metaik.ik.starts import drawn
from pin_metaik.kinematics import RESTARTS, Chain
from pin_metaik.kinematics.kernel.layout import ANGLE, DESCEND, DISTANCE, DONE, EVALUATIONS, SEARCH

SOLVED, UNREACHABLE = IKStatus.SOLVED, IKStatus.UNREACHABLE
SETTLE = np.array([STIFF, SETTLED, 100.0, 100.0])  # how to come near to what is out of reach; see ``DLS.settle``
NO_STARTS = np.empty((0, 0))
AT_MIDDLE = 300.0  # evaluations, at most, for the middle of tolerances that are loose


def solve_plain(
    chain: Chain, target: object, q0: ArrayLike | None, settings: NDArray[np.float64] | None, seed: int | None
) -> IKResult | Refinement | None:
    """The result if the target is decided; the best so far if it is not; None if the pose solver cannot take it.

    ``settings`` (9,) are those of the pose solver, or None for a solver that does not begin with it. Random starts are
    drawn for the few targets that the closed form, q0 and the samples leave: to draw them takes longer than to solve
    most. The pose solver then begins again with them, and ends as if they had been there from the beginning.
    """
    began = perf_counter()
    if settings is None or not chain.has_pose_solver:
        return None
    near = aligned = DEFAULT_TOLERANCE
    asked: Target | NDArray[np.float64] | None = None
    if isinstance(target, np.ndarray) and target.dtype.char == "d" and target.ndim == 2:
        matrix = target
    elif isinstance(target, pin.SE3):
        matrix = target.homogeneous
    elif isinstance(target, Target):
        if not target.plain:
            return None
        asked, matrix = target, target.pose.homogeneous
        near, aligned = target.allowance
    elif isinstance(target, (list, tuple)) and len(target) == 1 and isinstance(target[0], (Target, pin.SE3)):
        return solve_plain(chain, target[0], q0, settings, seed)
    else:
        numbers = as_numbers(target)
        if numbers.shape == (4, 4):
            matrix = numbers
        elif numbers.shape == (3,):
            asked, matrix, aligned = numbers, np.eye(4), math.inf
            matrix[:3, 3] = numbers
        else:
            return None
    if asked is not None:
        settings = settings.copy()
        settings[DISTANCE], settings[ANGLE] = near, aligned
        if near > DEFAULT_TOLERANCE or DEFAULT_TOLERANCE < aligned < math.inf:
            settings[EVALUATIONS] = min(settings[EVALUATIONS], AT_MIDDLE)
    oriented = aligned < math.inf
    kernel = chain.pose_solver if oriented else chain.position_solver
    given = chain.reference if q0 is None else q0
    starts = kernel.starts if seed is None else NO_STARTS
    while True:
        try:
            q = given.copy() if isinstance(given, np.ndarray) else np.array(given, dtype=float)
            todo, spent, proof = DESCEND, 1, None
            if kernel.solve_directly is not None:
                todo, position, quaternion = kernel.solve_directly(kernel.block, matrix, q)
                if todo == SEARCH:
                    proof = refuted(chain, matrix, near, aligned, q)
            if todo != DONE and proof is None:
                spent, position, quaternion = kernel.solve_pose(kernel.block, kernel.rows, starts, settings, matrix, q)
                proof = Proof.REACH if spent == 0 else None
            if proof is not None:
                spent += chain.kernels.settle_pose(kernel.block, kernel.rows, SETTLE, matrix, q)
        except (TypeError, ValueError, OverflowError):  # whatever it is, the long way takes it or says what is wrong
            return None
        if spent < 0:
            return None
        place = pin.SE3ToXYZQUATtuple(chain.tip.fk(q))
        distance, chord = math.dist(place[:3], position), math.dist(place[3:], quaternion)
        if chord > 1.0:  # an orientation has two quaternions
            chord = min(chord, math.dist(place[3:], [-v for v in quaternion]))
        angle = 4.0 * math.asin(0.5 * chord) if oriented else 0.0  # of small angles exact, unlike a cosine
        met = distance <= near and angle <= aligned
        if met or proof is not None:
            status, proof = (SOLVED, None) if met else (UNREACHABLE, proof)
            parts, took = (position, quaternion) if asked is None else None, perf_counter() - began
            return IKResult(q, status, distance, angle, spent, took, chain, asked, None, None, (), proof, None, parts)
        if starts is not NO_STARTS:  # all has been tried
            return Refinement(chain.x(q), False, spent)
        starts = drawn(chain, seed, 0, RESTARTS)


def refuted(
    chain: Chain, pose: NDArray[np.float64], near: float, aligned: float, q: NDArray[np.float64]
) -> Proof | None:
    """What proves that an arm with a closed form does not reach a pose (4, 4), to within ``near`` m, ``aligned`` rad.

    If something does, q (nq,) gets the branch that is least beyond its limits, brought inside them.
    """
    decide = chain.form_proof
    branches = None if decide is None else decide.judge(pose, near, aligned)
    if branches is None or not branches.proved:
        return None
    nearest = branches.nearest()
    if nearest is not None:
        chain.coordinates.write(nearest, q)
    far = chain.kernels.is_out_of_reach(chain.pose_solver.block, near, aligned, pose)
    return Proof.REACH if far else Proof.CLOSED_FORM


def as_numbers(target: object) -> NDArray[np.float64]:
    """Lists or an array of any numbers as an array; an empty one, if they are none."""
    try:
        return np.array(target, dtype=float)
    except (TypeError, ValueError, OverflowError):
        return np.empty(0)
