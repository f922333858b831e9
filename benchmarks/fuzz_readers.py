"""Everything that reads a file: what good files look like, and what is done with what was read."""

from __future__ import annotations

import contextlib
import io
import json
import os
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from random import Random

import numpy as np
from fuzz_inputs import Tree, as_json, as_toml, as_xml, odd_bytes, odd_tree, toml_tree, xml_tree

import pin_metaik as mik
from pin_metaik import cli, collision, learn, mobile, stewart
from pin_metaik.collision.scene import read_points
from pin_metaik.collision.srdf import read_srdf
from pin_metaik.compare import Suite, compare, read_results
from pin_metaik.compare.folder.environment import read_environment
from pin_metaik.compare.results.results import summarise
from pin_metaik.mobile.motion.trajectory import load_trajectory

ROOT = Path(__file__).parents[1]
SHIPPED = ROOT / "pin_metaik"
Syntax = tuple[Callable[[bytes], Tree], Callable[[Tree], str]]
JSON: Syntax = (json.loads, as_json)
TOML: Syntax = (toml_tree, as_toml)
XML: Syntax = (xml_tree, as_xml)


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
        text = write(odd_tree(parse(rnd.choice(self.seeds)), rnd)).encode("utf-8", "surrogatepass")
        return odd_bytes([text], rnd) if rnd.random() < 0.2 else text


URDF = b"""<robot name="two"><material name="m"><color rgba="1 0 0 1"/></material><link name="base"/>
<link name="arm"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><origin xyz="0 0 0.1" rpy="0 1 0"/><geometry><box size="0.1 0.1 0.2"/></geometry></collision>
<visual><geometry><mesh filename="package://m.obj" scale="1 1 1"/></geometry><material name="m"/></visual></link>
<link name="hand"><collision><geometry><cylinder radius="0.1" length="0.2"/></geometry></collision></link>
<link name="tool"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
<joint name="j" type="revolute"><origin xyz="0 0 1" rpy="0 0 1.57"/><parent link="base"/><child link="arm"/>
<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/><dynamics damping="0.1" friction="0"/></joint>
<joint name="k" type="continuous"><parent link="arm"/><child link="hand"/><axis xyz="0.6 0 0.8"/></joint>
<joint name="l" type="prismatic"><parent link="hand"/><child link="tool"/><axis xyz="1 0 0"/>
<limit lower="0" upper="0.1" effort="1" velocity="1"/></joint>
<joint name="m" type="revolute"><parent link="hand"/><child link="tip"/><axis xyz="1 0 0"/><mimic joint="j"
multiplier="-2" offset="0.1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint><link name="tip"/></robot>"""
MJCF = b"""<mujoco model="two"><compiler angle="radian" autolimits="true" meshdir="."/><option gravity="0 0 -9"/>
<default><joint damping="1" range="-1 1"/><default class="c"><geom type="capsule"/></default></default>
<asset><mesh name="mesh" file="m.obj"/></asset><worldbody><body name="a" pos="0 0 1" quat="1 0 0 0">
<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/><joint name="j" type="hinge" axis="0 0 1"/>
<geom class="c" size="0.1 0.2"/><body name="b" pos="0 0 0.3" euler="0 1 0"><joint name="k" type="slide" axis="1 0 0"
range="0 0.2"/><geom type="box" size="0.1 0.1 0.1"/><site name="tip" pos="0 0 0.1"/></body></body></worldbody>
<keyframe><key name="home" qpos="0 0"/></keyframe></mujoco>"""
SRDF = b"""<robot name="two"><group name="all"><chain base_link="base" tip_link="tool"/></group>
<group_state name="home" group="all"><joint name="j" value="0"/></group_state>
<disable_collisions link1="base" link2="arm" reason="Adjacent"/>
<disable_collisions link1="arm" link2="tool"/></robot>"""
SCENE = b"""{"obstacle": [{"name": "a", "shape": "box", "size": [1, 1, 0.1], "position": [0, 0, 1], "rpy": [0, 0, 1],
"touching": ["a"], "padding": 0.01}, {"name": "b", "shape": "sphere", "radius": 0.1},
{"name": "c", "shape": "capsule", "radius": 0.1, "length": 1}, {"name": "d", "shape": "halfspace", "normal": [0, 0, 1],
"offset": 0}, {"name": "e", "shape": "point_cloud", "points": [[0, 0, 0], [1, 1, 1]], "radius": 0.1},
{"name": "f", "shape": "octree", "points": [[0, 0, 0], [1, 1, 1]], "resolution": 0.1, "padding": {"a": 0.1}},
{"name": "g", "shape": "height_field", "size": [1, 1], "heights": [[0, 1], [1, 0]], "base": -1},
{"name": "h", "shape": "mesh", "file": "m.obj", "scale": 0.1}]}"""
OBJ = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
PLY = (
    b"ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
    b"property list uchar int vertex_indices\nend_header\n"
    b"0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"
)
WKT = b"POLYGON ((0 0, 1 0, 1 1, 0 1, 0 0), (0.2 0.2, 0.4 0.2, 0.4 0.4, 0.2 0.2))\nPOINT (3 3)\nLINESTRING (4 4, 5 5)\n"
GEOJSON = b"""{"type": "FeatureCollection", "start": [-5, 0], "goal": [9, 9], "features": [{"type": "Feature",
"properties": {"a": 1}, "geometry": {"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 0]]]}},
{"type": "Feature", "geometry": {"type": "MultiPolygon", "coordinates": [[[[3, 3], [4, 3], [4, 4], [3, 3]]]]}}]}"""
ROS_MAP = b"""{"image": "map.pgm", "resolution": 0.05, "origin": [-1, -1, 0.1], "negate": 0, "occupied_thresh": 0.65,
"free_thresh": 0.2, "mode": "trinary"}"""
LAUGHS = b"a: &a [x, x, x, x, x, x, x, x, x]\n" + b"".join(
    b"%c: &%c [%s]\n" % (98 + i, 98 + i, b", ".join([b"*%c" % (97 + i)] * 9)) for i in range(9)
)
PGM = b"P5\n# made by hand\n4 3\n255\n" + bytes([0, 255, 254, 205] * 3)
PGM_PLAIN = b"P2 4 3 15 " + b"0 15 3 9 " * 3
MOVING = b"""[{"name": "a", "radius": 0.5, "way": [[0, 0, 0], [1, 1, 0], [2, 1, 1]]},
{"outline": [[0, 0], [1, 0], [0, 1]], "around": 0.1, "way": [[0, 5, 5]]}]"""
VEHICLE = b'{"name": "mine", "v_max": 1.0, "a_max": 0.5, "omega_max": 1.0, "alpha_max": 1.0}'
TRAJECTORY = b'{"start": [0, 0, 0.5], "v": 0.0, "phases": [[1.0, 0.5, 0.0, 0.0], [2.0, 0.0, 0.1, 0.0]]}'
POSES = b"time,x,y,z,roll,pitch,yaw\n0,0,0,0.25,0,0,0\n1,0.01,0,0.25,1,2,3\n2,0.02,0,0.25,0,0,0\n"
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


def npy(values: np.ndarray) -> bytes:
    """An array as a .npy file."""
    file = io.BytesIO()
    np.save(file, values)
    return file.getvalue()


@cache
def npz(kind: str) -> bytes:
    """A saved network or map."""
    path = Path(f"{kind}.npz").absolute()
    if kind == "network":
        rng = np.random.default_rng(0)
        X = rng.uniform(size=(20, 2))
        learn.save_regressor(learn.fit(X, X.sum(axis=1), (2,), rng=0), path)
    else:
        chain = mik.Chain(mik.load_robot("asr_twodof"), mik.load_robot("asr_twodof").frame)
        mik.reachability(chain, np.array([[0.1, 0.1, 0.1], [3.0, 0.0, 0.0]])).save(path)
    return path.read_bytes()


@cache
def images() -> list[bytes]:
    """The same few pixels in several forms."""
    from PIL import Image

    found = []
    pixels = np.array([[0, 255, 254, 205]] * 3, dtype=np.uint8)
    for mode, form in (("L", "PNG"), ("RGBA", "PNG"), ("P", "PNG"), ("L", "BMP"), ("L", "TIFF"), ("L", "GIF")):
        file = io.BytesIO()
        Image.fromarray(pixels).convert(mode).save(file, form)
        found.append(file.getvalue())
    return found


@cache
def comparison() -> dict[str, bytes]:
    """The files of a small comparison."""
    folder = Path("compared").absolute()
    compare(Suite(("asr_twodof",), ("random",), ("lm",), tasks=2, seeds=1, budget=20), folder)
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.suffix in (".json", ".jsonl")}


def with_comparison(folder: Path) -> None:
    """Put the files of a comparison into a folder."""
    for name, content in comparison().items():
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
        return "\0".join(word.replace("\0", "") for word in words).encode("utf-8", "surrogatepass")


def good(*paths: str) -> list[bytes]:
    """Files that come with the package."""
    return [(SHIPPED / path).read_bytes() for path in paths]


def readers() -> dict[str, Reader]:
    """All readers by name. In a folder that may be written into."""
    tables = good("robots/catalog/rv7fl.toml", "robots/catalog/puma560.toml", "robots/catalog/cobra600.toml")
    platforms = good("stewart/catalog/stroke_50.toml", "stewart/catalog/servo_sg90.toml")
    scenes = good("mobile/scenes/one_square.json", "mobile/scenes/u_trap.json")
    grid = np.array([[0, 1, 0], [0, 0, 1]])

    def image(folder: Path) -> None:
        (folder / "map.pgm").write_bytes(PGM)

    def its_yaml(folder: Path) -> None:
        (folder / "map.yaml").write_bytes(ROS_MAP)

    def mesh(folder: Path) -> None:
        (folder / "m.obj").write_bytes(OBJ)

    def read_image(path: Path) -> None:
        read_mobile_scene(path.parent / "map.yaml")

    links = {"base", "arm", "hand", "tool", "tip"}
    return {
        "URDF": Reader("r.urdf", [URDF], read_robot, XML, mesh),
        "MJCF": Reader("r.xml", [MJCF], read_robot, XML, mesh),
        "SRDF": Reader("r.srdf", [SRDF], lambda path: read_srdf(path, links, strict=True), XML),
        "DH table, TOML": Reader("r.toml", tables, read_robot, TOML),
        "scene of shapes, TOML": Reader("s.toml", good("collision/scenes/shelf.toml"), read_scene, TOML),
        "scene of shapes, JSON": Reader("s.json", [SCENE], read_scene, JSON, mesh),
        "mesh, OBJ": Reader("m.obj", [OBJ], lambda path: collision.Mesh.read(path)),
        "mesh, PLY": Reader("m.ply", [PLY], lambda path: collision.Mesh.read(path)),
        "points, npy": Reader("p.npy", [npy(np.eye(3))], lambda path: collision.PointCloud(read_points(path), 0.1)),
        "scene of polygons, JSON": Reader("p.json", scenes, read_mobile_scene, JSON),
        "GeoJSON": Reader("p.geojson", [GEOJSON], read_mobile_scene, JSON),
        "WKT": Reader("p.wkt", [WKT], read_mobile_scene),
        "ROS map, YAML": Reader("map.yaml", [ROS_MAP, LAUGHS], read_mobile_scene, JSON_OR_YAML, image),
        "ROS map, PGM": Reader("map.pgm", [PGM, PGM_PLAIN], read_image, None, its_yaml),
        "ROS map, image": Reader("map.pgm", images(), read_image, None, its_yaml),
        "grid, npy": Reader("g.npy", [npy(grid), npy(grid.astype(float))], read_mobile_scene),
        "moving obstacles, JSON": Reader("o.json", [MOVING], mobile.load_moving, JSON),
        "vehicle, JSON": Reader("v.json", [VEHICLE], mobile.load_vehicle, JSON),
        "trajectory, JSON": Reader("t.json", [TRAJECTORY], lambda path: load_trajectory(path).as_dict(), JSON),
        "mechanism, TOML": Reader("m.toml", platforms, stewart.load_mechanism, TOML),
        "poses over time, CSV": Reader("w.csv", [POSES], stewart.read_trajectory),
        "network, npz": Reader("network.npz", [npz("network")], learn.load_regressor),
        "map of reach, npz": Reader("map.npz", [npz("map")], mik.Reachability.load),
        "comparison, rows": Reader(
            "rows.jsonl", [comparison()["rows.jsonl"]], read_comparison, LINES, with_comparison, fast=False
        ),
        "comparison, suite": Reader(
            "suite.json", [comparison()["suite.json"]], read_comparison, JSON, with_comparison, fast=False
        ),
        "comparison, environment": Reader(
            "environment.json", [comparison()["environment.json"]], read_comparison, JSON, with_comparison, fast=False
        ),
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
