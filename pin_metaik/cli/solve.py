"""``pin-metaik solve``: one target, one answer."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from math import degrees, radians, tau
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from numpy.typing import NDArray
from rich.console import Console

from pin_metaik.cli import complete
from pin_metaik.cli.goals import KINDS, read_goals
from pin_metaik.cli.options import Json, split
from pin_metaik.cli.show import show_in_browser
from pin_metaik.cli.start import configuration, turns
from pin_metaik.cli.versions import print_json
from pin_metaik.collision import CollisionWorld, load_scene, scene_names
from pin_metaik.errors import InvalidBounds, InvalidSetting, InvalidTarget
from pin_metaik.figures import picture_file
from pin_metaik.ik import REFINERS, IKResult, IKSolver, Target, Weighted, save_arm, solve_ik
from pin_metaik.ik.criteria import CRITERIA, WEIGHTED
from pin_metaik.ik.goals import Goal, Loop, Wish
from pin_metaik.ik.solver import EVALUATIONS
from pin_metaik.kinematics import Chain
from pin_metaik.kinematics.pose import rpy_matrix
from pin_metaik.lookup import lookup
from pin_metaik.optimize import ALGORITHMS, Budget
from pin_metaik.robots import Robot, load_robot
from pin_metaik.said import warn

ALONE = "alone"
"""As a scene: the robot with itself, and nothing around it."""
BASES: dict[str, dict[str, bool]] = {"fixed": {}, "free-flyer": {"free_flyer": True}, "planar": {"planar": True}}
WARM = Budget(evaluations=64)
SEEDERS = f"auto, none, {', '.join(ALGORITHMS)}"


def solve(
    robot: Annotated[
        str,
        typer.Argument(
            help="A robot's name (see `robots`), or the path of a URDF, MJCF, xacro or DH .toml.",
            autocompletion=complete.robots,
        ),
    ],
    position: Annotated[
        tuple[float, float, float] | None, typer.Option(metavar="X Y Z", help="Target position in metres.")
    ] = None,
    settings: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="NAME=VALUE",
            help="A parameter of a DH table, in its units, such as h=10, or a xacro argument; may be repeated.",
        ),
    ] = None,
    rpy: Annotated[
        tuple[float, float, float] | None,
        typer.Option(
            metavar="R P Y", help="Target orientation Rz(Y) Ry(P) Rx(R) in radians; default: any orientation."
        ),
    ] = None,
    frame: Annotated[
        list[str] | None,
        typer.Option(
            "--frame",
            "--tip",
            help="The frame to place; default: the robot's tip. May be repeated for further frames of --goal.",
        ),
    ] = None,
    goal: Annotated[
        list[str] | None,
        typer.Option(
            metavar="'KIND NAME=VALUE ...'",
            help="A goal in addition to the target, such as 'look_at frame=tool0 point=1,0,0.5', m and rad; may be "
            f"repeated. Kinds: {KINDS}.",
        ),
    ] = None,
    wish: Annotated[
        list[str] | None,
        typer.Option(
            metavar="'KIND NAME=VALUE ...'",
            help="A goal that is improved as far as the others leave freedom; written as for --goal; may be repeated.",
        ),
    ] = None,
    goals: Annotated[
        Path | None, typer.Option(help="A TOML file of goals: [[goal]] and [[wish]], each with kind.")
    ] = None,
    base: Annotated[str, typer.Option(help=f"Joint between the base and the world: {', '.join(BASES)}.")] = "fixed",
    limit: Annotated[
        list[str] | None,
        typer.Option(
            metavar="JOINT=LEAST,MOST",
            help="Limits, m or rad, of a joint, or of a base: root_joint.x=-1,1; may be repeated.",
        ),
    ] = None,
    lock: Annotated[
        list[str] | None, typer.Option(metavar="JOINT", help="A joint that keeps its value of --q0; may be repeated.")
    ] = None,
    q0: Annotated[
        list[str] | None,
        typer.Option(
            metavar="JOINT=VALUE",
            help="Start configuration: values of joints, or all entries of q, separated by commas or repeated.",
        ),
    ] = None,
    seeder: Annotated[str, typer.Option(help=f"Where starts come from: {SEEDERS}.")] = "auto",
    refiner: Annotated[str, typer.Option(help=f"Local method that refines them: {', '.join(REFINERS)}, none.")] = "dls",
    select: Annotated[
        str, typer.Option(help=f"Which solution to return: first (found soonest), {', '.join(CRITERIA)}.")
    ] = "first",
    weight: Annotated[
        list[str] | None,
        typer.Option(
            metavar="JOINT=WEIGHT",
            help=f"Weight of a joint for --select {', '.join(WEIGHTED)}; default 1; may be repeated.",
        ),
    ] = None,
    evaluations: Annotated[int, typer.Option(help="Budget: largest number of forward kinematics.")] = EVALUATIONS,
    world: Annotated[
        str | None,
        typer.Option(
            help=f"Avoid collisions with itself and a scene: .toml, one of {', '.join(scene_names())}, or {ALONE}."
        ),
    ] = None,
    srdf: Annotated[
        str | None,
        typer.Option(
            help="With --world: an SRDF with pairs of links that are not checked; default: the robot's own file."
        ),
    ] = None,
    allow: Annotated[
        list[str] | None,
        typer.Option(metavar="A,B", help="With --world: a pair of names that is not checked; may be repeated."),
    ] = None,
    visual: Annotated[
        bool, typer.Option(help="With --world: check the visual geometry of a robot without collision geometry.")
    ] = True,
    margin: Annotated[float | None, typer.Option(help="With --world: distance to keep between bodies, m.")] = None,
    picture: Annotated[
        Path | None,
        typer.Option(
            "--plot", "--picture", help="Draw the arm at the solution, or at the nearest found: .png, .svg or .pdf."
        ),
    ] = None,
    in_browser: Annotated[
        bool,
        typer.Option(
            "--show", help="Show the robot at the solution in the browser, until Ctrl-C; needs the extra viewer."
        ),
    ] = False,
    rng: Annotated[int, typer.Option(min=0, help="Seed of every random choice.")] = 0,
    in_degrees: Annotated[bool, typer.Option("--degrees", help="Read and print angles in degrees.")] = False,
    as_json: Json = False,
) -> None:
    """Solve for one target, or for goals. Exit code 0: solved, 1: not solved, 2: invalid arguments.

    Loop closures of an MJCF (<connect>, <weld>) are kept as goals.
    """
    if position is None and rpy is None and not goal and goals is None:
        raise InvalidTarget("nothing to reach: give --position X Y Z, --rpy R P Y, both, or --goal")
    asked = read_goals(goal or (), wish or (), goals)
    for option, value in (("--margin", margin), ("--srdf", srdf), ("--allow", allow), ("--no-visual", not visual)):
        if value and world is None:
            raise InvalidSetting(f"{option} needs a world: give --world, too, e.g. --world {ALONE}")
    if picture is not None:
        picture_file(picture)
    lookup("base", base, BASES)
    loaded = load_robot(robot, parameters=_parameters(settings or ()), **BASES[base])
    loops = [Loop(closure) for closure in loaded.loops]
    ends = [link for loop in loops for link in loop.ends(loaded.model)]
    frames = [*dict.fromkeys([*(frame or [loaded.frame]), *ends])]
    chain = Chain(loaded.model, frames, locked=split(lock or ()), limits=_limits(limit or ()))
    start = configuration(loaded.model, split(q0), chain.reference, in_degrees) if q0 else None
    solver = IKSolver(
        None if seeder == "none" else seeder,
        None if refiner == "none" else refiner,
        Budget(evaluations=evaluations),
        select=Weighted(select, _weights(weight)) if weight else select,
    )
    obstacles = None if world is None else _world(loaded, world, margin or 0.0, srdf, allow or (), visual)
    target = _target(position, rpy, in_degrees)
    together = [*([] if target is None else [replace(target, frame=frames[0])]), *loops, *asked]
    wanted = together if target is None or len(together) > 1 else target
    if not in_degrees and any(abs(angle) > tau for angle in rpy or ()):
        warn("--rpy is in radians; for degrees give --degrees, too")
    _warm_up(chain, wanted, solver)
    result = solve_ik(chain, wanted, start, solver=solver, world=obstacles, rng=rng)
    there = position if target is None or position is None or rpy is None else target.pose  # None: nowhere to draw
    if picture is not None:
        save_arm(picture, chain, result.q, there, obstacles)
    if as_json:
        units = {"length": "m", "angle": "deg" if in_degrees else "rad", "orientation_error": "rad", "time": "s"}
        print_json(report(loaded.name, chain, result, in_degrees), units)
    else:
        show(loaded.name, chain, result, in_degrees)
    if in_browser:
        show_in_browser(loaded, chain.frames[0], result.q, there, obstacles)
    raise typer.Exit(0 if result.success else 1)


def _parameters(settings: Iterable[str]) -> dict[str, float | str | bool]:
    """Values by name, of ``NAME=VALUE`` each; the table or the xacro file knows which there are."""
    values: dict[str, float | str | bool] = {}
    for setting in settings:
        name, sign, text = setting.partition("=")
        if not sign or not text:
            raise InvalidSetting(f"--set takes NAME=VALUE, such as h=10, got {setting!r}")
        try:
            values[name.strip()] = float(text)
        except ValueError:
            values[name.strip()] = text
    return values


def _limits(given: Iterable[str]) -> dict[str, tuple[float, float]]:
    """Limits by the name of a joint, of ``JOINT=LEAST,MOST`` each."""
    limits: dict[str, tuple[float, float]] = {}
    for one in given:
        name, _, text = one.partition("=")
        try:
            least, most = (float(part) for part in text.split(","))
        except ValueError:
            raise InvalidBounds(f"--limit takes JOINT=LEAST,MOST with two numbers, got {one!r}") from None
        limits[name.strip()] = least, most
    return limits


def _weights(given: Iterable[str]) -> dict[str, float]:
    """Weights by the name of a joint, of ``JOINT=WEIGHT`` each."""
    weights: dict[str, float] = {}
    for one in given:
        name, _, text = one.partition("=")
        try:
            weights[name.strip()] = float(text)
        except ValueError:
            raise InvalidSetting(f"--weight takes JOINT=WEIGHT with a number, got {one!r}") from None
    return weights


def _world(
    robot: Robot, scene: str, margin: float, srdf: str | None, allowed: Iterable[str], visual: bool
) -> CollisionWorld:
    """The robot among the obstacles of a scene, or alone."""
    world = CollisionWorld(robot, () if scene == ALONE else load_scene(scene), margin, srdf, visual=visual)
    for pair in allowed:
        names = split([pair])
        if len(names) != 2:
            raise InvalidSetting(f"--allow takes two names with a comma between them, A,B, got {pair!r}")
        world.allow(*names)
    return world


def _warm_up(chain: Chain, wanted: Target | list[Goal | Wish], solver: IKSolver) -> None:
    """Solve, a target for the pose that the chain has, so that compiling and sampling are not in the time shown."""
    there = replace(wanted, pose=chain.placements(chain.reference)[0]) if isinstance(wanted, Target) else wanted
    solve_ik(chain, there, chain.reference, solver=replace(solver, select="first", budget=WARM))


def _target(
    position: tuple[float, float, float] | None, rpy: tuple[float, float, float] | None, in_degrees: bool
) -> Target | None:
    """The target of the first frame; None without one."""
    if rpy is None:
        return None if position is None else Target.at(position)
    rotation = rpy_matrix(*(radians(a) if in_degrees else a for a in rpy))
    if position is None:
        return Target.facing(rotation)
    pose = np.eye(4)
    pose[:3, :3] = rotation
    pose[:3, 3] = position
    return Target(pose)


def report(robot: str, chain: Chain, result: IKResult, in_degrees: bool) -> dict[str, object]:
    """A result as plain values; q is Pinocchio's whole configuration, joints the chain's coordinates by name.

    Angles are in degrees or radians, in q and in joints alike.
    """
    return {
        "robot": robot,
        "frame": chain.frames[0],
        **result.as_dict(),
        "q": _angles(chain, result, in_degrees),
        "joints": dict(zip(chain.names, _shown(chain, result.x, in_degrees), strict=True)),
    }


def show(robot: str, chain: Chain, result: IKResult, in_degrees: bool) -> None:
    """A result for people."""
    console = Console(highlight=False)
    console.print(
        f"{robot}, {chain.frames[0]}: {result}", style="green" if result.success else "yellow", soft_wrap=True
    )
    for i, (name, value) in enumerate(zip(chain.names, _shown(chain, result.x, in_degrees), strict=True)):
        unit = "m" if not chain.limits.rotates[i] else "deg" if in_degrees else "rad"
        console.print(f"  {name:24} {value:12.6f} {unit}")
    x, y, z = chain.placements(result.q)[0].translation
    console.print(f"  {'reached':24} {x:.6f} {y:.6f} {z:.6f} m", markup=False)
    for outcome in result.wishes:
        console.print(f"  wish {outcome}", soft_wrap=True, markup=False)
    if not result.success:
        console.print(f"  {result.why}", soft_wrap=True)


def _shown(chain: Chain, x: NDArray[np.float64], in_degrees: bool) -> list[float]:
    return [
        degrees(v) if in_degrees and turns else v for v, turns in zip(x.tolist(), chain.limits.rotates, strict=True)
    ]


def _angles(chain: Chain, result: IKResult, in_degrees: bool) -> list[float]:
    """The entries of q; angles in degrees (the cosine and sine of a continuous joint are no angles)."""
    q = result.q.tolist()
    if in_degrees:
        for joint in list(chain.model.joints)[1:]:
            if joint.nq == 1 and turns(joint):
                q[joint.idx_q] = degrees(q[joint.idx_q])
    return [float(v) for v in q]
