"""The command line: parse, call, print. Errors of this package become one line and exit code 2."""

from __future__ import annotations

import errno
from typing import Annotated, Any

import typer
from rich.console import Console
from typer.core import TyperGroup

from pin_metaik import __version__
from pin_metaik.cli import compare, demo, plan, reproduce, robots, solve, stewart
from pin_metaik.cli.codes import INTERRUPTED, NONSENSE
from pin_metaik.cli.many import ManyValues
from pin_metaik.errors import MetaIKError


class Commands(TyperGroup):
    """The one place where what a command raises becomes a line and an exit code; what is left is a bug."""

    def invoke(self, ctx: Any) -> Any:
        """Run the command; see ``errors`` for what makes no sense, the system's for files, and Ctrl-C."""
        try:
            return super().invoke(ctx)
        except MetaIKError as error:
            raise _refused(str(error)) from None
        except OSError as error:
            if error.errno == errno.EPIPE:  # whoever read the output has gone, which is nobody's mistake
                raise
            raise _refused(_of_system(error)) from None
        except KeyboardInterrupt:
            raise typer.Exit(INTERRUPTED) from None


def _refused(why: str) -> typer.Exit:
    Console(stderr=True).print(f"pin-metaik: {why}", style="red", markup=False, highlight=False, soft_wrap=True)
    return typer.Exit(NONSENSE)


def _of_system(error: OSError) -> str:
    """An error of the system, with the file it is about."""
    reason = error.strerror or str(error) or type(error).__name__
    return f"{error.filename}: {reason}" if error.filename else reason


app = typer.Typer(
    name="pin-metaik",
    cls=Commands,
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
    """Entry point of the ``pin-metaik`` command."""
    app()
