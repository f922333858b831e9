"""The command line: parse, call, print. Errors of this package become one line and exit code 2."""

from __future__ import annotations

import sys
import warnings
from typing import Annotated, Any, NoReturn

import typer
from rich.console import Console
from typer.core import TyperGroup

from pin_metaik import __version__
from pin_metaik.cli import (
    compare,
    demo,
    export,
    mobile,
    reachable,
    reproduce,
    robots,
    solve,
    stewart,
    toolbox,
    warm,
)
from pin_metaik.cli.codes import INTERRUPTED, NONSENSE
from pin_metaik.cli.examples import show_examples
from pin_metaik.cli.mobile.plan import plan
from pin_metaik.cli.options import ManyValues
from pin_metaik.errors import MetaIKError


class Commands(TyperGroup):
    """The commands, with the exit code for Ctrl-C that shells know."""

    def invoke(self, ctx: Any) -> Any:
        """Run the command that was named."""
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:
            raise typer.Exit(INTERRUPTED) from None


app = typer.Typer(
    name="pin-metaik",
    cls=Commands,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
app.command("solve")(solve.solve)
app.command("robots")(robots.robots)
app.command("urdf")(robots.urdf)
app.command("reachability")(reachable.reachability)
app.command("place-base")(reachable.place)
app.command("demo")(demo.demo)
app.command("reproduce")(reproduce.reproduce)
app.command("compare", cls=ManyValues)(compare.compare)
app.command("report")(compare.report)
app.command("replay")(compare.replay)
app.command("plan")(plan)
app.command("toolbox")(toolbox.toolbox)
app.command("export")(export.export)
app.command("warm")(warm.warm)
app.add_typer(mobile.app, name="mobile")
app.add_typer(stewart.app, name="stewart")
show_examples(app)


def _version(wanted: bool) -> None:
    if wanted:
        print(f"pin-metaik {__version__}")
        raise typer.Exit


@app.callback()
def main(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and exit.")
    ] = False,
) -> None:
    """Global inverse kinematics for Pinocchio."""


def run() -> None:
    """Entry point of the ``pin-metaik`` command: errors of this package and of files become one line."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("default", UserWarning)
            warnings.showwarning = _say
            app()
    except MetaIKError as error:
        _refuse(str(error))
    except OSError as error:  # of a file, mostly: full, gone, or not ours
        reason = error.strerror or str(error) or type(error).__name__
        _refuse(f"{error.filename}: {reason}" if error.filename else reason)


def _say(message: Warning | str, *_: object, **__: object) -> None:
    """A warning as one line, without the line of code that raised it."""
    Console(stderr=True).print(f"warning: {message}", style="yellow", markup=False, highlight=False, soft_wrap=True)


def _refuse(why: str) -> NoReturn:
    Console(stderr=True).print(f"pin-metaik: {why}", style="red", markup=False, highlight=False, soft_wrap=True)
    sys.exit(NONSENSE)
