"""``pin-metaik demo``: the RV-7FL cases by every seeder, alone and refined, then a Panda and a UR5 pose."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import pinocchio as pin
from rich.console import Console
from rich.table import Table

from pin_metaik.cli.options import Json
from pin_metaik.cli.versions import print_json
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


def demo(as_json: Json = False) -> None:
    """Solve a few poses with every seeder, and show a table.

    Three cases of the RV-7FL paper, each seeder alone and refined, and a Panda and a UR5 pose.
    """
    rows: list[dict[str, object]] = []
    arm = load_robot("rv7fl_paper")
    chain = Chain(arm.model, arm.frame)
    for case, position in TARGETS.items():
        for method, solver in METHODS.items():
            rows.append(_row(case.replace("Case", "RV-7FL"), method, chain, Target.at(np.array(position) / MM), solver))
    for name, (position, rpy) in POSES.items():
        robot = load_robot(name)
        chain = Chain(robot.model, robot.frame)
        pose = pin.SE3(pin.rpy.rpyToMatrix(*rpy), np.array(position))
        rows.append(_row(name, "default", chain, Target(pose), IKSolver()))
    if as_json:
        print_json({"results": rows})
        return
    console = Console(highlight=False)
    console.print(_table(rows))
    console.print("\nErrors are recomputed from each result by Pinocchio. RV-7FL: position only, as in its paper.")
    console.print(
        "Times are those of a second solve: the first on a machine compiles, the first of a chain makes its tables."
    )


def _row(target: str, method: str, chain: Chain, asked: Target, solver: IKSolver) -> dict[str, object]:
    """What became of a target, solved twice: the first time compiles, and lays out tables."""
    solve_ik(chain, asked, solver=solver)
    return {"target": target, "method": method, **solve_ik(chain, asked, solver=solver).as_dict()}


def _table(rows: Iterable[dict[str, Any]]) -> Table:
    table = Table(box=None)
    for heading in ("target", "method", "status"):
        table.add_column(heading)
    for heading in ("error mm", "error rad", "evals", "ms"):
        table.add_column(heading, justify="right")
    for row in rows:
        table.add_row(
            row["target"],
            row["method"],
            row["status"],
            f"{1e3 * row['position_error']:.1e}",
            f"{row['orientation_error']:.1e}",
            str(row["evaluations"]),
            f"{1e3 * row['seconds']:.2f}",
            style="green" if row["success"] else "yellow",
        )
    return table
