"""Numbers in another unit are taken as they are, and said in one line that names the joint and the guess."""

import warnings

import pytest

from pin_metaik.robots import load_robot
from pin_metaik.robots.library import catalogue, example_robots
from pin_metaik.robots.plausible import range_in_degrees

MESH = """solid a
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 300 0 0
vertex 0 400 0
endloop
endfacet
endsolid a
"""


def arm(
    kind="revolute",
    limit='lower="-1" upper="1"',
    xyz="0.1 0.2 0.3",
    rpy="0 1.5708 0",
    shape='<sphere radius="0.1"/>',
    at="",
):
    return (
        '<robot name="arm"><link name="base"/><link name="a"/><link name="tip">'
        f"<collision>{at}<geometry>{shape}</geometry></collision></link>"
        '<joint name="i" type="revolute"><parent link="base"/><child link="a"/><limit lower="-3" upper="3"/></joint>'
        f'<joint name="j" type="{kind}"><parent link="a"/><child link="tip"/><origin xyz="{xyz}" rpy="{rpy}"/>'
        f'<limit {limit} effort="1" velocity="1"/></joint></robot>'
    )


ODD = {
    "limits of 90 and 180": (arm(limit='lower="-90" upper="180"'), r"arm: joint 'j' has limits \[-90, 180\] rad"),
    "limits of 360": (arm(limit='lower="0" upper="360"'), r"joint 'j' has limits \[0, 360\] rad: probably degrees"),
    "a limit of -170": (arm(limit='lower="-170" upper="2"'), r"joint 'j' has limits \[-170, 2\] rad: probably degrees"),
    "a limit of 162.5": (arm(limit='lower="0" upper="162.5"'), r"joint 'j' has limits \[0, 162\.5\] rad"),
    "a limit of 15": (arm(limit='lower="-15" upper="15"'), r"joint 'j' has limits \[-15, 15\] rad: probably degrees"),
    "a slide of 400": (
        arm("prismatic", 'lower="0" upper="400"'),
        r"joint 'j' has limits \[0, 400\] m: probably millim",
    ),
    "a roll of 90": (arm(rpy="90 0 0"), "joint 'j' has rpy = 90 0 0 rad: probably degrees"),
    "a yaw of -45 of a shape": (
        arm(at='<origin rpy="0 0 -45"/>'),
        "a collision of link 'tip' has rpy = 0 0 -45 rad: probably degrees",
    ),
    "a step of 300": (arm(xyz="0 0 300"), "the links reach 300 m, 300 m of it by joint 'j': probably millimetres"),
    "a box of 200": (
        arm(shape='<box size="200 10 10"/>'),
        "a collision of link 'tip' has size = 200 10 10 m: probably",
    ),
}


@pytest.mark.parametrize("what", ODD)
def test_a_number_that_is_probably_in_another_unit_is_taken_and_said(what):
    urdf, message = ODD[what]
    with pytest.warns(UserWarning, match=message) as caught:
        robot = load_robot(urdf)
    assert len(caught) == len(robot.remarks) == 1
    assert robot.model.nv == 2


PLAIN = {
    "two turns": arm(limit='lower="-6.2832" upper="12.566"'),
    "five quarter turns, rounded": arm(limit='lower="-7.85" upper="7.854"'),
    "400 degrees": arm(limit='lower="-6.98" upper="6.98"'),
    "no limit, as 10 rad": arm(limit='lower="-10" upper="10"'),
    "no limit, as a million": arm(limit='lower="-1e6" upper="1e6"'),
    "a gantry": arm("prismatic", 'lower="-40" upper="40"'),
    "a base without a limit": arm("prismatic", 'lower="-1e6" upper="1e6"'),
    "a roll of a turn and a half": arm(rpy="9.42478 0 0"),
}


@pytest.mark.parametrize("what", PLAIN)
def test_numbers_that_are_large_for_a_reason_are_taken_without_a_word(what):
    assert load_robot(PLAIN[what]).remarks == ()


def test_a_mesh_in_millimetres_is_said_when_it_is_read(tmp_path):
    (tmp_path / "part.stl").write_text(MESH)
    for scale, size in (("", 1), (' scale="0.001 0.001 0.001"', 0)):
        (tmp_path / "arm.urdf").write_text(arm(shape=f'<mesh filename="part.stl"{scale}/>'))
        robot = load_robot(tmp_path / "arm.urdf")
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            assert robot.collision_model.ngeoms == 1
        said = [str(warning.message) for warning in caught]
        assert said == ["arm: the mesh 'tip_0' is 500 m across: probably millimetres"] * size


TABLE = """
name = "arm"
convention = "standard"
length = "{length}"
angle = "{angle}"
[[joint]]
name = "turn"
a = {a}
alpha = {alpha}
d = 0
limits = [{lower}, {upper}]
"""


@pytest.mark.filterwarnings("ignore:.*probably millimetres")  # of the other links, too
@pytest.mark.parametrize(
    ("numbers", "message"),
    [
        ({"angle": "rad", "lower": -170, "upper": 170}, r"joint 'turn' has limits \[-170, 170\] rad: probably degrees"),
        ({"angle": "rad", "alpha": -90}, r"has rpy = -90.* rad: probably degrees"),
        ({"angle": "deg", "alpha": 1.5708}, r"joint 'turn' has alpha = 1\.5708 degrees: probably radians"),
        ({"angle": "deg", "lower": -3.1416, "upper": 3}, r"'turn' has lower = -3\.1416 degrees: probably radians"),
        ({"length": "m", "a": 425}, "the links reach 425 m, 425 m of it by joint 'flange_joint': probably millimetres"),
    ],
)
def test_a_dh_table_in_another_unit_is_taken_and_said(numbers, message, tmp_path):
    plain = {"length": "m", "angle": "rad", "a": 0.4, "alpha": 0, "lower": -1, "upper": 1}
    (tmp_path / "arm.toml").write_text(TABLE.format(**plain | numbers))
    with pytest.warns(UserWarning, match=message):
        load_robot(tmp_path / "arm.toml")


def test_nothing_is_said_of_the_units_of_any_named_robot():
    for name in (*catalogue(), *example_robots()):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            assert not any("probably" in remark for remark in load_robot(name).remarks), name


@pytest.mark.parametrize("limit", [0.0, 3.2, 6.3, -6.3, 9.43, 1e3, -1e9, float("inf")])
def test_a_range_in_radians_is_not_taken_for_degrees(limit):
    assert range_in_degrees("j", min(limit, 0.0), max(limit, 0.0)) == ""
