"""Good files of every kind that is read, which odd ones are made from."""

from __future__ import annotations

import io
from functools import cache
from pathlib import Path

import numpy as np

import pin_metaik as mik
from pin_metaik import learn, mobile
from pin_metaik.compare import Suite, compare

SHIPPED = Path(__file__).parents[1] / "pin_metaik"

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
STL = b"solid m\n" + b"".join(
    b"facet normal 0 0 0\nouter loop\n%bendloop\nendfacet\n"
    % b"".join(b"vertex %b\n" % b" ".join(b"%d" % (i == c - 1) for i in range(3)) for c in face)
    for face in ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))
) + b"endsolid m\n"  # fmt: skip
DAE = b"""<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="0.1"/><up_axis>Y_UP</up_axis></asset><library_effects><effect id="e"><profile_COMMON>
<technique sid="t"><phong><diffuse><color>1 0 0 1</color></diffuse></phong></technique></profile_COMMON></effect>
</library_effects><library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="f" count="12">0 0 0 1 0 0 0 1 0 0 0 1
</float_array><technique_common><accessor source="#f" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="4" material="m">
<input semantic="VERTEX" source="#v" offset="0"/><p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles></mesh></geometry>
</library_geometries><library_visual_scenes><visual_scene id="s"><node id="n"><rotate>0 0 1 90</rotate>
<translate>0 0 1</translate><instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="m" target="#m"/></technique_common></bind_material></instance_geometry></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>"""
XACRO = b"""<robot name="two" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="n" default="2"/>
<xacro:property name="l" value="${1 + 2 * pi}"/><xacro:macro name="part" params="a b:=1 *c"><link name="${a}"/>
<joint name="j_${a}" type="revolute"><xacro:insert_block name="c"/><parent link="base"/><child link="${a}"/>
<limit lower="${-b}" upper="${b * l}" effort="1" velocity="1"/></joint></xacro:macro><link name="base"/>
<xacro:part a="arm" b="$(arg n)"><origin xyz="0 0 ${l}"/></xacro:part><xacro:if value="${l > 2}"><link name="x"/>
<joint name="f" type="fixed"><parent link="arm"/><child link="x"/></joint></xacro:if></robot>"""
MESHES = b"""<robot name="m"><link name="base"/><link name="arm"><visual><geometry><mesh filename="%b"/></geometry>
</visual></link><joint name="j" type="continuous"><parent link="base"/><child link="arm"/></joint></robot>"""
MESHES_MJCF = b"""<mujoco><asset><mesh name="m" file="%b"/></asset><worldbody><body name="b"><joint type="hinge"/>
<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/><geom type="mesh" mesh="m"/></body></worldbody></mujoco>"""
GOALS = b"""[[goal]]
kind = "look_at"
frame = "tool0"
point = [1, 0, 0.5]
[[goal]]
kind = "posture"
joints = {elbow_joint = 1.0}
[[goal]]
kind = "frame_pose"
frame = "tool0"
pose = [0.4, 0, 0.5, 0, 1, 0]
[[wish]]
kind = "mid_range"
share = 0.5
weight = 0.5
[[wish]]
kind = "manipulability"
frame = "tool0"
least = 0.1
"""
TARGETS = b"x,y,z,roll,pitch,yaw\n0.1,0.2,0.3,0,1,2\n# none\n0.1,-0.2,3e-1,0,0,0\n"
STATE = b"""{"format": "pin_metaik toolbox 1", "page": "arms", "pages": {"arms": {"robot": "ur5", "parameters": {}},
"heuristics": {}, "paths": {}, "platforms": {}}}"""
RUN = b"""{"label": "gwo 1", "task": {"task": "sphere", "n": 2}, "trace": [[10, 1.5], [20, 0.5]],
"populations": [[[0, 1], [1, 0]], [[0, 0.5], [0.5, 0]]], "outcome": null}"""


def npy(values: np.ndarray) -> bytes:
    """An array as a .npy file."""
    file = io.BytesIO()
    np.save(file, values)
    return file.getvalue()


def stl() -> bytes:
    """The mesh of STL in its binary form."""
    corners = np.vstack([np.zeros(3), np.eye(3)])[[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]]
    rows = (np.concatenate([np.zeros((1, 3)), face]).astype("<f4").tobytes() + bytes(2) for face in corners)
    return bytes(80) + np.uint32(4).astype("<u4").tobytes() + b"".join(rows)


@cache
def network() -> bytes:
    """A saved network."""
    rng = np.random.default_rng(0)
    X = rng.uniform(size=(20, 2))
    path = Path("network.npz")
    learn.save_regressor(learn.fit(X, X.sum(axis=1), (2,), rng=0), path)
    return path.read_bytes()


@cache
def turn() -> bytes:
    """A saved turn."""
    path = Path("turn.npz")
    mobile.learn_turn(mobile.SynchroDrive("mine", 1.0, 0.5, 1.0, 1.0, 0.1), hidden=(2,), iterations=1).save(path)
    return path.read_bytes()


@cache
def reach(ending: str) -> bytes:
    """A saved map of reach."""
    robot, path = mik.load_robot("asr_twodof"), Path(f"reach{ending}")
    mik.reachability(mik.Chain(robot, robot.frame), np.array([[0.1, 0.1, 0.1], [3.0, 0.0, 0.0]])).save(path)
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


def good(*paths: str) -> list[bytes]:
    """Files that come with the package."""
    return [(SHIPPED / path).read_bytes() for path in paths]
