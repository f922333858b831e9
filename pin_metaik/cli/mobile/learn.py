"""``pin-metaik mobile learn``: a network for the turns of a robot, trained and saved."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from pin_metaik.cli.codes import INTERRUPTED
from pin_metaik.cli.mobile.common import Rng, VehicleName, print_report, say_written
from pin_metaik.cli.options import Json
from pin_metaik.cli.progress import progress_bar
from pin_metaik.errors import InvalidSetting, UnknownName
from pin_metaik.interrupts import kept
from pin_metaik.learn import TRAINERS
from pin_metaik.learn.files import network_file

POINTS = ("grid", "clustered", "random")


def learn(
    output: Annotated[Path, typer.Option("--output", "-o", help="Where to write the network: .npz.")],
    vehicle: VehicleName = "nomad200",
    hidden: Annotated[list[int], typer.Option(min=1, help="Neurons of each hidden layer: --hidden 5 5.")] = [5, 5],  # noqa: B006  # nothing changes it
    trainer: Annotated[str, typer.Option(help=f"One of {', '.join(TRAINERS)}.")] = "lm",
    design: Annotated[
        str,
        typer.Option(help="log: logarithms of speed and length, square root of the angle; paper: no transformation."),
    ] = "log",
    points: Annotated[
        str,
        typer.Option(help="Training points: the paper's grid, its clustered points (half a minute), or random ones."),
    ] = "grid",
    iterations: Annotated[int, typer.Option(min=1, help="Largest number of iterations.")] = 4000,
    rng: Rng = 0,
    as_json: Json = False,
) -> None:
    """Train a network on the exact tangent lengths of a synchro-drive's turns, and save it for `plan --network`.

    Ctrl-C keeps the best weights so far. Exit code 0: trained, 2: invalid arguments, 130: interrupted.
    """
    from pin_metaik import mobile
    from pin_metaik.mobile.motion.turn_data import clustered_points, random_points

    network_file(output)
    robot = mobile.load_vehicle(vehicle)
    if not isinstance(robot, mobile.SynchroDrive):
        raise InvalidSetting(f"networks are learned for a SynchroDrive, which {robot.name} is not")
    if points not in POINTS:
        raise UnknownName("points to learn from", points, POINTS)
    table = None
    if points == "clustered":
        with progress_bar("clustering") as watch:
            table = kept(lambda: clustered_points(robot, rng, watch=watch)).centres
    elif points == "random":
        table = random_points(robot, rng)
    with progress_bar("learning") as watch:
        turn = kept(
            lambda: mobile.learn_turn(
                robot,
                design=design,  # type: ignore[arg-type]  # it checks the name itself
                hidden=hidden,
                trainer=trainer,
                iterations=iterations,
                points=table,
                rng=rng,
                watch=watch,
            )
        )
    turn.save(output)
    training, errors = turn.regressor.training, turn.errors()
    if as_json:
        print_report(
            {
                "network": str(turn.regressor.network),
                "trainer": trainer,
                "design": design,
                "points": points,
                **{key: value for key, value in training.as_dict().items() if key not in ("w", "trace")},
                "errors": asdict(errors),
            }
        )
    else:
        console = Console(highlight=False)
        console.print(
            f"{turn.regressor.network} by {trainer}, {training.iterations} iterations, {training.seconds:.1f} s, mean "
            f"squared error {training.mse:.3g} (scaled)"
        )
        console.print(
            f"  on the paper's test set: mean error {errors.E0:.3g} % (E0), largest {errors.Em:.3g} % (Em), above 5 % "
            f"at {errors.E5:,} of {errors.n:,} points (E5)",
            soft_wrap=True,
        )
    say_written([output], as_json)
    if training.interrupted:
        raise typer.Exit(INTERRUPTED)
