"""``pin-metaik stewart``: begin, analyse, design and show general Stewart platforms."""

from __future__ import annotations

import typer

from pin_metaik.cli.stewart import analyse, design, move, show, types

app = typer.Typer(
    help="General Stewart platforms with linear actuators or servos: analysis and dimensional optimisation.",
    no_args_is_help=True,
)
app.command("new")(show.new)
app.command("show")(show.show)
app.command("analyse")(analyse.analyse)
app.command("forward", context_settings={"ignore_unknown_options": True})(move.forward)
app.command("follow")(move.follow)
app.command("design")(design.design)
app.command("types")(types.types)
