"""``pin-metaik mobile``: show scenes, compare planners, plan in motion, curves for cars, moving obstacles."""

from __future__ import annotations

import typer

from pin_metaik.cli.mobile import compare, curve, drive, evolve, learn, moving, scene
from pin_metaik.cli.options import ManyValues

app = typer.Typer(
    help="Mobile robots: scenes, planners side by side, motions from a speed, curves of cars, obstacles that move.",
    no_args_is_help=True,
)
app.command("show")(scene.show)
app.command("compare", cls=ManyValues)(compare.compare)
app.command("evolve")(evolve.evolve)
app.command("drive")(drive.drive)
app.command("curve")(curve.curve)
app.command("moving")(moving.moving)
app.command("learn", cls=ManyValues)(learn.learn)
