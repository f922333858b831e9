"""The command line: parse, call, print. Errors of this package become one line and exit code 2."""

from __future__ import annotations

import sys

import typer
from rich.console import Console

from pin_metaik.cli import compare, demo, plan, reproduce, robots, solve, stewart
from pin_metaik.cli.many import ManyValues
from pin_metaik.errors import MetaIKError

SOLVED, NOT_SOLVED, NONSENSE = 0, 1, 2

app = typer.Typer(
    name="pin-metaik",
    help="Global inverse kinematics for Pinocchio.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
app.command("solve")(solve.solve)
app.command("robots")(robots.robots)
app.command("urdf")(robots.urdf)
app.command("demo")(demo.demo)
app.command("reproduce")(reproduce.reproduce)
app.command("compare", cls=ManyValues)(compare.compare)
app.command("report")(compare.report)
app.command("replay")(compare.replay)
app.command("plan")(plan.plan)
app.add_typer(stewart.app, name="stewart")


def run() -> None:
    """Entry point of the ``pin-metaik`` command."""
    try:
        app()
    except MetaIKError as error:
        Console(stderr=True).print(f"pin-metaik: {error}", style="red", markup=False, highlight=False, soft_wrap=True)
        sys.exit(NONSENSE)
