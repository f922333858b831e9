"""QP solvers of other packages behind one call: minimise z'P z / 2 + q'z in a box, and perhaps between rows.

Every solver that qpsolvers finds installed will do. Two are called without it, because in a descent it is the programs'
small size that counts: at seven joints DAQP takes 12 us instead of 42, and OSQP, kept set up, 0.1 ms instead of 1.2.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec
from typing import Any, TypeAlias

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.errors import UnknownName

BoxQP: TypeAlias = Callable[[Array, Array, Array, Array], Array]
"""z (n,) from P (n, n), q (n,), lower (n,) and upper (n,); within the solver's tolerance, not finite when it failed."""
RowQP: TypeAlias = Callable[[Array, Array, Array, Array, Array], Array]
"""The same with lower <= (z, A z) <= upper: bounds (n + m,) of the box, then of the rows A (m, n)."""

ITERATIVE = {"osqp", "piqp", "proxqp", "scs"}  # those that stop at a tolerance eps_abs, eps_rel; the others are exact


def box_qp(solver: str, n: int, tolerance: float) -> BoxQP:
    """The solver of that name, for programs in n unknowns and a box."""
    solve, none = row_qp(solver, n, 0, tolerance), np.empty((0, n))
    return lambda P, q, lower, upper: solve(P, q, lower, upper, none)


def row_qp(solver: str, n: int, m: int, tolerance: float) -> RowQP:
    """The solver of that name, for programs in n unknowns, a box and m rows."""
    match solver:
        case "osqp":
            return _osqp(n, m, tolerance)
        case "daqp":
            return _daqp(n, m)
        case _:
            return _qpsolvers(solver, n, tolerance)


def quickest() -> str:
    """The solver to take for small programs: DAQP where it is installed, else OSQP, which always is."""
    return "daqp" if find_spec("daqp") else "osqp"


def check_installed(solver: str) -> None:
    """See that there is such a solver.

    Raises:
        UnknownName: qpsolvers does not know it, or it is not installed.
    """
    installed = import_module("qpsolvers").available_solvers
    if not isinstance(solver, str) or solver not in installed:
        raise UnknownName("QP solver", str(solver), installed)


def _osqp(n: int, m: int, tolerance: float) -> RowQP:
    """OSQP, set up once and cold-started on every program."""
    sparse, lower_half = import_module("scipy.sparse"), np.tril_indices(n)
    rows = sparse.vstack([sparse.eye(n), sparse.csc_matrix(np.ones((m, n)))], format="csc") if m else sparse.eye(n)
    full = sparse.csc_matrix(np.triu(np.ones((n, n))))
    settings = {"eps_abs": tolerance, "eps_rel": tolerance, "warm_starting": False, "verbose": False}
    osqp: Any = import_module("osqp")
    solver, interrupted = osqp.OSQP(), osqp.SolverStatus.OSQP_SIGINT
    solver.setup(full, np.zeros(n), rows.tocsc(), np.full(n + m, -1.0), np.ones(n + m), **settings)

    def solve(P: Array, q: Array, lower: Array, upper: Array, A: Array) -> Array:
        given = {"Ax": np.vstack([np.ones(n), A]).T.ravel()} if m else {}  # by column: the 1 of the box, then the rows
        solver.update(Px=P[lower_half], q=q, l=lower, u=upper, **given)  # P's rows are the columns OSQP wants
        found = solver.solve(raise_error=False)
        if found.info.status_val == interrupted:  # OSQP listens to Ctrl-C itself, and nobody else hears it then
            raise KeyboardInterrupt
        return np.array(found.x)

    return solve


def _daqp(n: int, m: int) -> RowQP:
    """DAQP."""
    daqp, inequalities = import_module("daqp"), np.zeros(n + m, dtype=np.int32)

    def solve(P: Array, q: Array, lower: Array, upper: Array, A: Array) -> Array:
        z, _, flag, _ = daqp.solve(P, q, A, upper, lower, inequalities)
        return np.asarray(z) if flag > 0 else np.full(n, np.nan)

    return solve


def _qpsolvers(name: str, n: int, tolerance: float) -> RowQP:
    """Any solver that qpsolvers knows."""
    qpsolvers, sparse = import_module("qpsolvers"), import_module("scipy.sparse")
    matrix = np.asarray if name in qpsolvers.dense_solvers else sparse.csc_matrix
    settings = {"eps_abs": tolerance, "eps_rel": tolerance} if name in ITERATIVE else {}

    def solve(P: Array, q: Array, lower: Array, upper: Array, A: Array) -> Array:
        rows = (matrix(np.vstack([A, -A])), np.concatenate([upper[n:], -lower[n:]])) if len(A) else (None, None)
        program = qpsolvers.Problem(matrix(P), q, *rows, lb=lower[:n], ub=upper[:n])
        try:
            solution = qpsolvers.solve_problem(program, name, **settings)
        except qpsolvers.QPError:
            return np.full(n, np.nan)
        return np.full(n, np.nan) if solution.x is None else np.asarray(solution.x)

    return solve
