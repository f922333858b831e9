"""Pushing a configuration out of collision while it holds its target: quadratic programs with rows for distances."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.collision import CollisionWorld
from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.refine.protocol import Refinement
from pin_metaik.ik.refine.qp_solvers import quickest, row_qp

ROWS = 12  # the nearest pairs; others cannot come into contact in one step
NO_TURN, NO_TORQUE = np.eye(3), np.zeros(3)
TOLERANCE = 1e-6  # of iterative QP solvers


@dataclass(frozen=True)
class Push:
    """Steps that minimise |J dx + r|^2 + damping |dx|^2 + stiffness s^2, the distances of near pairs being kept.

    For each pair of bodies at distance d along the normal n, from the one to the other, the row is that of a velocity
    damper (Faverjon and Tournassoud 1987): n' (J_2 - J_1) dx + s >= gain (safe - d). So far pairs may approach, near
    ones only slowly, and overlapping ones must part. s >= 0 is a penalised slack: the program gives up the target for a
    while before it keeps an overlap. Distances are those of the simplified solids.

    Attributes:
        iterations: Steps at most.
        largest: The most that any coordinate moves in one step, rad or m.
        room: What distance is aimed at beyond the margin, m.
        gain: Which part of the missing distance one step makes up.
        stiffness: What a squared metre of missing distance counts.
        damping: What a squared radian of movement counts.
    """

    iterations: int = 30
    largest: float = 0.5
    room: float = 1e-4
    gain: float = 0.9
    stiffness: float = 100.0
    damping: float = 1e-6

    def refine(
        self,
        problem: IKProblem,
        world: CollisionWorld,
        start: NDArray[np.float64],
        base: NDArray[np.float64],
        evaluations: int,
    ) -> Refinement:
        """Step from coordinates ``start`` (n,) until the target is met free of collisions; base (nq,) holds the rest.

        One evaluation is one residual with its Jacobian and all distances.
        """
        n, chain = problem.chain.n, problem.chain
        solve = row_qp(quickest(), n + 1, ROWS, TOLERANCE)
        lower, upper = problem.limits.lower, problem.limits.upper
        x, spent = problem.limits.clip(start), 0
        P, q, E = np.zeros((n + 1, n + 1)), np.zeros(n + 1), np.eye(n)
        P[n, n] = self.stiffness
        while spent < min(self.iterations, evaluations):
            r, J = problem.linearize(x)  # (m,), (n, m)
            spent += 1
            at = chain.q(x, base)
            if spent > 1 and problem.accepts(at):
                return Refinement(x, True, spent)
            rows, least = self._rows(problem, world, at)
            P[:n, :n] = J @ J.T + self.damping * E
            q[:n] = J @ r
            low = np.concatenate([np.maximum(lower - x, -self.largest), [0.0], least])
            high = np.concatenate([np.minimum(upper - x, self.largest), [np.inf], np.full(ROWS, np.inf)])
            dx = solve(P, q, low, high, rows)[:n]
            if not np.isfinite(dx).all():
                break
            x = np.minimum(np.maximum(x + dx, lower), upper)
        return Refinement(x, False, spent)

    def _rows(
        self, problem: IKProblem, world: CollisionWorld, q: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Rows (ROWS, n + 1) and least values (ROWS,) for the pairs that are near at q (nq,); the rest are empty."""
        rows, least = np.zeros((ROWS, problem.chain.n + 1)), np.full(ROWS, -np.inf)
        near = sorted(world.checker.near(q), key=lambda pair: pair.room)[:ROWS]
        model, data = problem.chain.model, problem.chain.data
        tangent = problem.chain.tangent(problem.chain.x(q))
        if near:
            pin.computeJointJacobians(model, data, q)
        for k, pair in enumerate(near):
            for joint, point, sign in zip(pair.joints, pair.points, (-1.0, 1.0), strict=True):
                if joint:
                    J = pin.getJointJacobian(model, data, joint, pin.LOCAL_WORLD_ALIGNED) @ tangent
                    at_point = pin.SE3(NO_TURN, point - data.oMi[joint].translation)
                    rows[k, :-1] += sign * (at_point.act(pin.Force(pair.normal, NO_TORQUE)).vector @ J)
            rows[k, -1] = 1.0
            least[k] = self.gain * (self.room - pair.room)
        return rows, least
