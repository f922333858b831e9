"""Other people's QP solvers behind one call: minimise z'P z / 2 + q'z in the box lower <= z <= upper.

Every solver that qpsolvers finds installed will do. Two are called without it, because in a descent it is the programs'
small size that counts: at seven joints DAQP takes 12 us instead of 42, and OSQP, kept set up, 0.1 ms instead of 1.2.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from pin_metaik.errors import UnknownName

BoxQP: TypeAlias = Callable[
    [NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]], NDArray[np.float64]
]
"""z (n,) from P (n, n), q (n,), lower (n,) and upper (n,); within the solver's tolerance, not finite when it failed."""

ITERATIVE = {"osqp", "piqp", "proxqp", "scs"}  # those that stop at a tolerance eps_abs, eps_rel; the others are exact


def box_qp(solver: str, n: int, tolerance: float) -> BoxQP:
    """The solver of that name, for programs in n unknowns."""
    match solver:
        case "osqp":
            return _osqp(n, tolerance)
        case "daqp":
            return _daqp(n)
        case _:
            return _qpsolvers(solver, tolerance)


def check_installed(solver: str) -> None:
    """See that there is such a solver.

    Raises:
        UnknownName: qpsolvers does not know it, or it is not installed.
    """
    installed = import_module("qpsolvers").available_solvers
    if solver not in installed:
        raise UnknownName("QP solver", solver, installed)


def _osqp(n: int, tolerance: float) -> BoxQP:
    """OSQP, set up once and cold-started on every program."""
    sparse, lower_half = import_module("scipy.sparse"), np.tril_indices(n)
    E = sparse.eye(n, format="csc")
    full = sparse.csc_matrix(np.triu(np.ones((n, n))))
    settings = {"eps_abs": tolerance, "eps_rel": tolerance, "warm_starting": False, "verbose": False}
    solver: Any = import_module("osqp").OSQP()
    solver.setup(full, np.zeros(n), E, np.full(n, -1.0), np.ones(n), **settings)

    def solve(
        P: NDArray[np.float64], q: NDArray[np.float64], lower: NDArray[np.float64], upper: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        solver.update(Px=P[lower_half], q=q, l=lower, u=upper)  # P is symmetric: its rows are the columns OSQP wants
        return np.array(solver.solve(raise_error=False).x)

    return solve


def _daqp(n: int) -> BoxQP:
    """DAQP, without constraints but the box."""
    daqp, none, inequalities = import_module("daqp"), np.empty((0, n)), np.zeros(n, dtype=np.int32)

    def solve(
        P: NDArray[np.float64], q: NDArray[np.float64], lower: NDArray[np.float64], upper: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        z, _, flag, _ = daqp.solve(P, q, none, upper, lower, inequalities)
        return np.asarray(z) if flag > 0 else np.full(n, np.nan)

    return solve


def _qpsolvers(name: str, tolerance: float) -> BoxQP:
    """Any solver that qpsolvers knows."""
    qpsolvers, sparse = import_module("qpsolvers"), import_module("scipy.sparse")
    matrix = np.asarray if name in qpsolvers.dense_solvers else sparse.csc_matrix
    settings = {"eps_abs": tolerance, "eps_rel": tolerance} if name in ITERATIVE else {}

    def solve(
        P: NDArray[np.float64], q: NDArray[np.float64], lower: NDArray[np.float64], upper: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        program = qpsolvers.Problem(matrix(P), q, lb=lower, ub=upper)
        try:
            solution = qpsolvers.solve_problem(program, name, **settings)
        except qpsolvers.QPError:
            return np.full(len(q), np.nan)
        return np.full(len(q), np.nan) if solution.x is None else np.asarray(solution.x)

    return solve
