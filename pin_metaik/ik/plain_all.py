"""All solutions of a whole pose for one frame, by a compiled call or two where no search is needed.

``solve_ik_all`` begins with it. What it leaves open goes on to ``collect``, through targets, problems and search
states, which cost ten times as much Python as the solutions of an arm with a closed form take.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from pin_metaik.arrays import Array
from pin_metaik.ik.goals.pose import DEFAULT_TOLERANCE, Target
from pin_metaik.ik.plain_pose import as_numbers
from pin_metaik.ik.proof import Proof
from pin_metaik.ik.refine.descent import Descent
from pin_metaik.ik.result import Parts
from pin_metaik.kinematics import Chain
from pin_metaik.kinematics.roots.real import FOR_ROOTS

ROOM = 0.1  # of the distance between distinct solutions: tolerances that may move a solution so far
FORM, ROOTS = 8, 64  # solutions at most by a closed form, and by the roots of six joints
ENOUGH = 10_000  # evaluations: more than descents from all roots take


@dataclass(frozen=True, eq=False, slots=True)
class PlainSet:
    """All solutions of a plain pose.

    Attributes:
        q: (s, nq) configurations that Pinocchio accepts, the nearest to the start first.
        complete: What proves that these are all.
        evaluations: Forward kinematics computed.
        given: The target, or its position and quaternion.
    """

    q: Array
    complete: Proof | None
    evaluations: int
    given: Target | Parts


def all_of_plain(
    chain: Chain, target: object, q0: ArrayLike | None, descent: Descent, apart: float, certify: bool
) -> PlainSet | None:
    """All solutions of a whole pose of a chain's only frame; None if this takes a search, or is no such target.

    Args:
        chain: The chain, its held joints where q0 has them.
        target: Whatever somebody asks for.
        q0: (nq,) configuration that solutions are ordered by, and that has other joints.
        descent: What descends to a solution; if it is not compiled, this takes a search.
        apart: rad or m by which some coordinate of two solutions must differ.
        certify: Whether a search may prove that they are all, where counting does not.
    """
    settings = descent.settings(ENOUGH)
    if settings is None or not chain.has_pose_solver or chain.n != 6:
        return None
    near = aligned = DEFAULT_TOLERANCE
    given: Target | None = None
    if isinstance(target, np.ndarray) and target.dtype.char == "d" and target.ndim == 2:
        matrix = target
    elif isinstance(target, pin.SE3):
        matrix = target.homogeneous
    elif isinstance(target, Target):
        if not target.plain:
            return None
        given, matrix = target, target.pose.homogeneous
        near, aligned = target.allowance
    else:
        matrix = as_numbers(target)
    if matrix.shape != (4, 4) or max(near, aligned) > ROOM * apart:
        return None
    try:
        q = np.array(chain.reference if q0 is None else q0, dtype=float)
        found = (_by_form if len(chain.form) else _by_roots)(chain, matrix, near, aligned, settings, apart, certify, q)
    except (TypeError, ValueError, OverflowError):  # whatever it is, the long way takes it or says what is wrong
        return None
    if found is None:
        return None
    Q, complete, spent, parts = found
    errors, targets = np.empty((len(Q), 2)), np.empty((len(Q), 4, 4))
    targets[:] = matrix
    chain.kernels.distances(targets, chain.tip.fk_batch(Q), errors)
    good = [distance <= near and angle <= aligned for distance, angle in errors.tolist()]
    return PlainSet(Q if all(good) else Q[good], complete, spent, parts if given is None else given)


Found: TypeAlias = tuple[Array, Proof | None, int, Parts] | None


def _by_form(
    chain: Chain, pose: Array, near: float, aligned: float, settings: Array, apart: float, certify: bool, q: Array
) -> Found:
    """The branches of a closed form, where these are proved to be all."""
    proof = chain.form_proof
    assert proof is not None
    out = np.empty((FORM, len(q)))
    count, spent, position, turn = proof.every(chain.block, pose, apart, q, out)
    return None if count <= 0 else (out[:count], Proof.CLOSED_FORM, spent, (position, turn))


def _by_roots(
    chain: Chain, pose: Array, near: float, aligned: float, settings: Array, apart: float, certify: bool, q: Array
) -> Found:
    """The roots of six joints, where there are as many as at any pose, and proved to be all if that is asked for."""
    six = chain._six_joints
    if six is None or (certify and six.degree != six.bound):
        return None
    every = chain._configurations(pose, FOR_ROOTS)
    if every is None or not every.all or (certify and not every.proved):
        return None
    out = np.empty((ROOTS, len(q)))
    count, met, spent, position, turn = every.settle(
        chain.bare, chain.limits, settings, near, aligned, pose, apart=apart, q=q, out=out
    )
    proved = every.proved and met
    if count <= 0 or (certify and not proved):
        return None
    return out[:count], Proof.COUNT if proved else None, every.evaluations + spent, (position, turn)
