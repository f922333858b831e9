"""``pin-metaik demo``: the RV-7FL cases by every seeder, alone and refined, then a Panda and a UR5 pose."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
from rich.console import Console
from rich.table import Table

from pin_metaik.compare.papers.rv7fl_setup import MM, TARGETS
from pin_metaik.ik import IKSolver, Target, solve_ik
from pin_metaik.kinematics import Chain
from pin_metaik.optimize import Budget
from pin_metaik.robots import load_robot

POSES = {  # the frame's position (m) and roll, pitch, yaw (rad)
    "panda": ((0.4, 0.2, 0.5), (np.pi, 0.0, 0.3)),
    "ur5": ((0.3, 0.3, 0.4), (0.0, np.pi / 2, 0.0)),
}
METHODS = {
    f"{seeder}{' + dls' if refiner else ''}": IKSolver(seeder, refiner, Budget(evaluations=30_000))
    for seeder in ("gwo", "mtde", "sfla")
    for refiner in (None, "dls")
}


def demo() -> None:
    """Solve a few poses with every seeder, and show a table.

    Three cases of the RV-7FL paper, each seeder alone and refined, and a Panda and a UR5 pose.
    """
    console = Console(highlight=False)
    table = Table(box=None)
    table.add_column("target")
    table.add_column("method")
    table.add_column("status")
    for heading in ("error mm", "error rad", "evals", "ms"):
        table.add_column(heading, justify="right")

    arm = load_robot("rv7fl_paper")
    chain = Chain(arm.model, arm.frame)
    for case, position in TARGETS.items():
        for method, solver in METHODS.items():
            _add(table, case.replace("Case", "RV-7FL"), method, chain, Target.at(np.array(position) / MM), solver)
        table.add_section()
    for name, (position, rpy) in POSES.items():
        robot = load_robot(name)
        chain = Chain(robot.model, robot.frame)
        pose = pin.SE3(pin.rpy.rpyToMatrix(*rpy), np.array(position))
        _add(table, name, "default", chain, Target(pose), IKSolver())
    console.print(table)
    console.print("\nErrors are Pinocchio's, recomputed from the answer. RV-7FL: position only, as in its paper.")
    console.print(
        "Times are of a second solve: the first one on a machine compiles, the first of a chain makes its tables."
    )


def _add(table: Table, name: str, method: str, chain: Chain, target: Target, solver: IKSolver) -> None:
    solve_ik(chain, target, solver=solver)
    result = solve_ik(chain, target, solver=solver)
    oriented = target.allowance[1] < np.inf
    table.add_row(
        name,
        method,
        str(result.status),
        f"{1e3 * result.position_error:.1e}",
        f"{result.orientation_error:.1e}" if oriented else "free",
        str(result.evaluations),
        f"{1e3 * result.seconds:.2f}",
        style="green" if result.success else "yellow",
    )
