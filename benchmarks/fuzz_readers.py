"""Everything that reads a file, and what is done with what was read."""

from __future__ import annotations

import contextlib
import json
import os
import re
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from random import Random

import fuzz_seeds as seeds
import numpy as np
from fuzz_inputs import Tree, as_json, as_toml, as_xml, odd_bytes, odd_tree, toml_tree, xml_tree
from fuzz_seeds import good, npy

import pin_metaik as mik
from pin_metaik import cli, collision, learn, mobile, stewart
from pin_metaik.cli.goals import read_goals
from pin_metaik.cli.reachable import read_targets
from pin_metaik.collision.scene import read_points
from pin_metaik.collision.srdf import read_srdf
from pin_metaik.compare import read_results
from pin_metaik.compare.folder.environment import read_environment
from pin_metaik.compare.results.results import summarise
from pin_metaik.gui import kept
from pin_metaik.gui.look.pieces import pieces_of
from pin_metaik.gui.pages.arms.obstacles import entries_in
from pin_metaik.gui.pages.arms.state import ArmsState
from pin_metaik.gui.pages.heuristics.record import Record
from pin_metaik.gui.pages.heuristics.state import HeuristicsState
from pin_metaik.gui.pages.paths.state import PathsState
from pin_metaik.gui.pages.platforms.state import PlatformsState
from pin_metaik.mobile.motion.trajectory import load_trajectory

Syntax = tuple[Callable[[bytes], Tree], Callable[[Tree], str]]
JSON: Syntax = (json.loads, as_json)
TOML: Syntax = (toml_tree, as_toml)
XML: Syntax = (xml_tree, as_xml)
STATES = {"arms": ArmsState, "heuristics": HeuristicsState, "paths": PathsState, "platforms": PlatformsState}


TO_SOLVE: dict[str, tuple[str, ...]] = {
    "solve": ("rv7fl", "--position", "0.5", "0.1", "0.4", "--rpy", "0", "1", "0", "--q0", "0,0,0,0,0,0", "--json"),
    "robots": ("--json",),
    "urdf": ("rv7fl", "--out", "here.urdf"),
    "plan": ("ten_obstacles", "--start", "0", "0", "--goal", "1", "1", "--json"),
    "report": ("folder",),
    "replay": ("folder", "ur5/random/0/lm/0"),
    "stewart analyse": ("stroke_50", "--cells", "4", "--json"),
    "stewart show": ("stroke_50",),
    "mobile curve": ("--to", "1", "1", "90", "--radius", "0.5"),
}
WORDS = (
    "", "-", "--", "-1", "0", "1", "1e308", "nan", "inf", "9" * 400, "x" * 3000, "\ud800", "é", "a=b", "=", ",", "1,2",
    "--help", "--json", "--out", "--q0", "--position", "--frame", "--limits", "--world", "--cells", "folder",
    "file.toml", "../../x", "/", "/dev/null", "~", "rv7fl", "stroke_50", "ten_obstacles", "solve", "[red]", "%s", "\n",
)  # fmt: skip


@dataclass(frozen=True)
class Reader:
    """Something that reads.

    Attributes:
        file: Name of the file that is odd; in a folder with others, if ``beside`` makes them.
        seeds: Good files.
        read: Reads it, by its path, and uses what it has.
        syntax: How trees are read from seeds, and written; None for what is no tree.
        beside: Makes the good files that it is read with, in a folder.
        fast: Whether it takes a millisecond or so.
    """

    file: str
    seeds: Sequence[bytes]
    read: Callable[[Path], object]
    syntax: Syntax | None = None
    beside: Callable[[Path], object] = lambda folder: None
    fast: bool = True

    def odd(self, number: int) -> bytes:
        """Odd input of a number."""
        rnd = Random(number)
        if self.syntax is None or rnd.random() < 0.4:
            return odd_bytes(self.seeds, rnd)
        parse, write = self.syntax
        text = write(odd_tree(_parsed(parse, rnd.choice(self.seeds)), rnd)).encode("utf-8", "surrogatepass")
        return odd_bytes([text], rnd) if rnd.random() < 0.2 else text


@cache
def _parsed(parse: Callable[[bytes], Tree], seed: bytes) -> Tree:
    """The tree of a seed, which ``odd_tree`` takes a copy of."""
    return parse(seed)


def with_comparison(folder: Path) -> None:
    """Put the files of a comparison into a folder."""
    for name, content in seeds.comparison().items():
        (folder / name).write_bytes(content)


def read_robot(path: Path) -> None:
    """Load a robot, take its chain, and its geometry if it has one that can be read."""
    robot = mik.load_robot(path)
    chain = mik.Chain(robot, robot.frame)
    chain.poses(np.zeros(chain.n))
    _ = robot.collision_model, robot.visual_model


def read_scene(path: Path) -> None:
    """Read the obstacles of a scene, and what a robot's world needs of their shapes."""
    for obstacle in collision.load_scene(path):
        repr(obstacle)


def read_mobile_scene(path: Path) -> None:
    """Read a scene of polygons as plain values."""
    mobile.load_scene(path, (-5.0, -5.0), (9.0, 9.0)).as_dict()


def read_comparison(path: Path) -> None:
    """Read a comparison as its report does."""
    results = read_results(path.parent)
    read_environment(path.parent)
    summarise(results.trials)
    results.manifest.suite(path.parent)


def call_command(path: Path) -> None:
    """Call the command line with the words in a file, one a line, where it may write."""
    words = path.read_bytes().decode("utf-8", "surrogateescape").split("\0")
    os.chdir(path.parent)
    sys.argv = ["pin-metaik", *words]
    with (
        open(os.devnull, "w", encoding="utf-8", errors="backslashreplace") as nowhere,  # noqa: PTH123
        contextlib.redirect_stdout(nowhere),
        contextlib.redirect_stderr(nowhere),
        contextlib.suppress(SystemExit),
    ):
        cli.run()


@dataclass(frozen=True)
class CommandLines(Reader):
    """Command lines: words of good ones, and odd ones, put together."""

    def odd(self, number: int) -> bytes:
        """The words, with a null character between."""
        rnd = Random(number)
        command = rnd.choice(list(TO_SOLVE))
        words = [*command.split(), *TO_SOLVE[command]]
        for _ in range(rnd.randint(1, 4)):
            at = rnd.randint(0, len(words) - 1) if words else 0
            match rnd.randrange(4):
                case 0:
                    words[at : at + 1] = [rnd.choice(WORDS)]
                case 1:
                    words.insert(at, rnd.choice(WORDS))
                case 2:
                    del words[at : at + 1]
                case _ if words:
                    words[at] = odd_bytes([words[at].encode("utf-8", "surrogatepass")], rnd).decode("latin-1")
        return "\0".join(word.replace("\0", "") for word in quick(words)).encode("utf-8", "surrogatepass")


def quick(words: list[str]) -> list[str]:
    """The words, with at most 99 where they ask for up to thousands of cells a side, over which work may take long."""
    return [word[-2:] if re.fullmatch(r"\d{3,4}", word) else word for word in words]


def with_meshes(folder: Path) -> None:
    """Put robots into a folder that have one mesh each, of every kind, and a good one."""
    (folder / "m.obj").write_bytes(seeds.OBJ)
    for ending in ("obj", "stl", "dae", "ply"):
        (folder / f"{ending}.urdf").write_bytes(seeds.MESHES % f"odd.{ending}".encode())
        (folder / f"{ending}.xml").write_bytes(seeds.MESHES_MJCF % f"odd.{ending}".encode())


def read_mesh(path: Path) -> None:
    """Read a mesh as part of a robot, for the eye of the toolbox, and as an obstacle.

    Raises:
        MetaIKError: One of the three refuses it.
    """
    errors = []
    for read in (
        lambda: mik.load_robot(path.with_name(f"{path.suffix[1:]}.xml")).visual_model,
        lambda: pieces_of(mik.load_robot(path.with_name(f"{path.suffix[1:]}.urdf")), "meshes"),
        lambda: collision.Mesh.read(path),
    ):
        try:
            read()
        except mik.MetaIKError as error:
            errors.append(error)
    if errors:
        raise errors[0]


def read_state(path: Path) -> None:
    """Read the state of the toolbox, and of its pages."""
    for name, values in kept.from_text(path.read_bytes(), path.name)[1].items():
        if name in STATES:
            kept.state_of(STATES[name], values, path.name)


def read_run(path: Path) -> None:
    """Read a run of the toolbox."""
    Record.from_text(path.read_bytes(), path.name)


@cache
def readers() -> dict[str, Reader]:
    """All readers by name. In a folder that may be written into."""
    tables = good("robots/catalog/rv7fl.toml", "robots/catalog/puma560.toml", "robots/catalog/cobra600.toml")
    platforms = good("stewart/catalog/stroke_50.toml", "stewart/catalog/servo_sg90.toml")
    scenes = good("mobile/scenes/one_square.json", "mobile/scenes/u_trap.json")
    grid, rows = np.array([[0, 1, 0], [0, 0, 1]]), seeds.comparison()

    def image(folder: Path) -> None:
        (folder / "map.pgm").write_bytes(seeds.PGM)

    def its_yaml(folder: Path) -> None:
        (folder / "map.yaml").write_bytes(seeds.ROS_MAP)

    def read_image(path: Path) -> None:
        read_mobile_scene(path.parent / "map.yaml")

    def of_comparison(file: str, syntax: Syntax) -> Reader:
        return Reader(file, [rows[file]], read_comparison, syntax, with_comparison)

    links = {"base", "arm", "hand", "tool", "tip"}
    return {
        "URDF": Reader("r.urdf", [seeds.URDF], read_robot, XML, with_meshes),
        "xacro": Reader("r.xacro", [seeds.XACRO], read_robot, XML, fast=False),
        "MJCF": Reader("r.xml", [seeds.MJCF], read_robot, XML, with_meshes),
        "SRDF": Reader("r.srdf", [seeds.SRDF], lambda path: read_srdf(path, links, strict=True), XML),
        "DH table, TOML": Reader("r.toml", tables, read_robot, TOML),
        "scene of shapes, TOML": Reader("s.toml", good("collision/scenes/shelf.toml"), read_scene, TOML),
        "scene of shapes, JSON": Reader("s.json", [seeds.SCENE], read_scene, JSON, with_meshes),
        "mesh, OBJ": Reader("odd.obj", [seeds.OBJ], read_mesh, None, with_meshes),
        "mesh, STL": Reader("odd.stl", [seeds.STL, seeds.stl()], read_mesh, None, with_meshes),
        "mesh, DAE": Reader("odd.dae", [seeds.DAE], read_mesh, XML, with_meshes),
        "mesh, PLY": Reader("odd.ply", [seeds.PLY], read_mesh, None, with_meshes),
        "points, npy": Reader("p.npy", [npy(np.eye(3))], lambda path: collision.PointCloud(read_points(path), 0.1)),
        "goals, TOML": Reader("g.toml", [seeds.GOALS], lambda path: read_goals([], [], path), TOML),
        "poses to stand for, CSV": Reader("t.csv", [seeds.TARGETS], lambda path: read_targets(path, False)),
        "scene of polygons, JSON": Reader("p.json", scenes, read_mobile_scene, JSON),
        "GeoJSON": Reader("p.geojson", [seeds.GEOJSON], read_mobile_scene, JSON),
        "WKT": Reader("p.wkt", [seeds.WKT], read_mobile_scene),
        "ROS map, YAML": Reader(
            "map.yaml", [seeds.ROS_MAP, seeds.LAUGHS], read_mobile_scene, JSON_OR_YAML, image, fast=False
        ),
        "ROS map, PGM": Reader("map.pgm", [seeds.PGM, seeds.PGM_PLAIN], read_image, None, its_yaml),
        "ROS map, image": Reader("map.pgm", seeds.images(), read_image, None, its_yaml),
        "grid, npy": Reader("g.npy", [npy(grid), npy(grid.astype(float))], read_mobile_scene),
        "moving obstacles, JSON": Reader("o.json", [seeds.MOVING], mobile.load_moving, JSON),
        "vehicle, JSON": Reader("v.json", [seeds.VEHICLE], mobile.load_vehicle, JSON),
        "trajectory, JSON": Reader("t.json", [seeds.TRAJECTORY], lambda path: load_trajectory(path).as_dict(), JSON),
        "mechanism, TOML": Reader("m.toml", platforms, stewart.load_mechanism, TOML),
        "poses over time, CSV": Reader("w.csv", [seeds.POSES], stewart.read_trajectory),
        "network, npz": Reader("network.npz", [seeds.network()], learn.load_regressor),
        "turn, npz": Reader("turn.npz", [seeds.turn()], mobile.load_turn),
        "map of reach, npz": Reader("map.npz", [seeds.reach(".npz")], mik.Reachability.load),
        "map of reach, Parquet": Reader("map.parquet", [seeds.reach(".parquet")], mik.Reachability.load),
        "comparison, rows": of_comparison("rows.jsonl", LINES),
        "comparison, suite": of_comparison("suite.json", JSON),
        "comparison, environment": of_comparison("environment.json", JSON),
        "toolbox, state": Reader("s.json", [seeds.STATE], read_state, JSON),
        "toolbox, run": Reader(
            "r.json", [seeds.RUN], lambda path: Record.from_text(path.read_bytes(), path.name), JSON
        ),
        "toolbox, obstacles": Reader("s.json", [seeds.SCENE], entries_in, JSON),
        "command lines": CommandLines("words", [], call_command, None, with_comparison, fast=False),
    }


def _yaml_tree(text: bytes) -> Tree:
    import yaml

    return yaml.safe_load(text) if text.startswith(b"{") else {"image": "map.pgm"}


JSON_OR_YAML: Syntax = (_yaml_tree, as_json)
LINES: Syntax = (
    lambda text: [json.loads(line) for line in text.splitlines()],
    lambda tree: "".join(f"{as_json(line)}\n" for line in (tree if isinstance(tree, list) else [tree])),
)
