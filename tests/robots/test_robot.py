import pickle
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from pin_metaik.errors import InvalidBounds, InvalidModel, InvalidTable, UnknownName
from pin_metaik.robots import load_robot, robot_names
from pin_metaik.robots.description import description_of
from pin_metaik.robots.library import LEFT_OUT, TIPS, catalogue, example_robots

NAMES = [*catalogue(), *example_robots()]
ARMS = ["baxter", "kinova", "panda", "pr2", "talos", "talos_arm", "tiago", "ur5", "ur10", "xarm7", "z1"]
MIMICKING = ["baxter", "panda", "panda_collision", "pr2", "tiago_pro"]
FREED = ["alex_psyonic_hands", "romeo", "talos_full", "talos_full_box"]

JOINT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'
MESH = (
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n"
)


def urdf(limit: str = JOINT, geometry: str = "", kind: str = "revolute", more: str = "") -> str:
    return f"""<robot name="arm"><link name="base"/>
      <link name="tip"><collision><geometry>{geometry or '<sphere radius="0.1"/>'}</geometry></collision></link>
      <joint name="j" type="{kind}"><parent link="base"/><child link="tip"/><axis xyz="0 0 1"/>{limit}</joint>
      {more}</robot>"""


@pytest.fixture
def write(tmp_path):
    def write(text: str, name: str = "arm.urdf") -> Path:
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    return write


@pytest.mark.parametrize("name", NAMES)
def test_every_listed_robot_loads_with_a_tip_that_its_joints_move(name, capfd):
    robot = load_robot(name)
    model, data = robot.model, robot.model.createData()
    frame = model.getFrameId(robot.frame)
    assert robot.name == name
    assert frame < model.nframes
    assert np.abs(pin.computeFrameJacobian(model, data, pin.neutral(model), frame)).max() > 0
    assert not {"collision_model", "visual_model"} & set(vars(robot))
    assert capfd.readouterr() == ("", "")


def test_the_list_has_every_robot_with_its_source_freedom_and_tip():
    listed = robot_names()
    assert [robot.name for robot in listed] == NAMES
    by_name = {robot.name: robot for robot in listed}
    assert by_name["rv7fl"] == ("rv7fl", "catalogue", 6, "tool0")
    assert by_name["panda"] == ("panda", "example-robot-data", 8, "panda_hand_tcp")
    assert set(ARMS) <= set(by_name)


def test_every_robot_of_example_robot_data_is_listed_or_left_out_for_a_reason():
    from example_robot_data.robots_loader import ROBOTS

    assert set(ROBOTS) == set(example_robots()) | set(LEFT_OUT)
    for name, reason in LEFT_OUT.items():
        with pytest.raises(InvalidModel, match=reason.split(";")[0]):
            load_robot(name)


@pytest.mark.parametrize("name", TIPS)
def test_the_usual_tips_are_the_ones_one_gets(name):
    assert load_robot(name).frame == TIPS[name]


def test_the_ur3_is_not_the_ur5():
    three, five = load_robot("ur3").model, load_robot("ur5").model
    forearm = [m.jointPlacements[m.getJointId("wrist_1_joint")].translation[2] for m in (three, five)]
    np.testing.assert_allclose(forearm, [0.21325, 0.39225], atol=1e-12)


def test_bases_are_fixed_unless_asked_otherwise():
    fixed, free = load_robot("talos").model, load_robot("talos", free_flyer=True).model
    assert free.nv == fixed.nv + 6
    assert free.joints[1].shortname() == "JointModelFreeFlyer"
    assert load_robot("pr2", free_flyer=True).model.nv == load_robot("pr2").model.nv + 6
    assert load_robot("talos_arm").model.nv == 7


@pytest.mark.parametrize("name", MIMICKING)
def test_a_mimic_joint_moves_as_its_urdf_says(name):
    held, free = load_robot(name), load_robot(name, mimic=False)
    tags = {joint.get("name"): joint.find("mimic") for joint in ET.fromstring(held.urdf).findall("joint[mimic]")}
    assert held.free_mimics == ()
    assert set(free.free_mimics) == set(tags)
    assert free.model.nv - held.model.nv == len(tags)

    x = np.random.default_rng(0).uniform(-0.5, 0.5, held.model.nv)
    position = {j: x[held.model.joints[held.model.getJointId(j)].idx_v] for j in list(held.model.names)[1:]}
    for joint, tag in tags.items():
        followed = position[tag.get("joint")]
        position[joint] = float(tag.get("multiplier", 1)) * followed + float(tag.get("offset", 0))
    full = np.zeros(free.model.nv)
    for joint, value in position.items():
        full[free.model.joints[free.model.getJointId(joint)].idx_v] = value

    placements = []
    for model, v in ((held.model, x), (free.model, full)):
        data = model.createData()
        pin.framesForwardKinematics(model, data, pin.integrate(model, pin.neutral(model), v))
        placements.append([data.oMf[model.getFrameId(f.name, f.type)].homogeneous for f in free.model.frames])
    np.testing.assert_allclose(*placements, atol=1e-12)


@pytest.mark.parametrize("name", FREED)
def test_mimic_joints_that_pinocchio_cannot_hold_are_free_and_said_to_be(name):
    robot = load_robot(name)
    assert robot.free_mimics
    assert robot.model.nv == load_robot(name, mimic=False).model.nv


@pytest.mark.parametrize("name", ["panda", "ur5", "kinova", "z1"])
def test_meshes_are_read_when_asked_for_and_kept(name):
    robot = load_robot(name)
    assert "collision_model" not in vars(robot)
    assert robot.collision_model.ngeoms > 0
    assert robot.collision_model is robot.collision_model
    assert "visual_model" not in vars(robot)
    assert robot.visual_model.ngeoms > 0


@pytest.mark.parametrize("free_flyer", [False, True])
def test_a_robot_is_made_again_from_its_description_which_pickles(free_flyer):
    robot = load_robot("panda", free_flyer=free_flyer)
    assert description_of(robot.model) == robot.description
    assert description_of(pin.Model()) is None
    again = pickle.loads(pickle.dumps(robot.description)).model()
    assert again == robot.model
    q = pin.randomConfiguration(again, np.full(again.nq, -1.0), np.full(again.nq, 1.0))
    there, here = pin.Data(again), pin.Data(robot.model)
    pin.forwardKinematics(again, there, q)
    pin.forwardKinematics(robot.model, here, q)
    np.testing.assert_array_equal(there.oMi[again.njoints - 1], here.oMi[again.njoints - 1])


def test_a_robot_prints_in_one_line():
    assert len(repr(load_robot("panda")).splitlines()) == 1


@pytest.mark.parametrize("name", ["pandda", "", "ur", "Panda"])
def test_an_unknown_name_is_answered_with_the_names_there_are(name):
    with pytest.raises(UnknownName, match=r"known: .*panda.*rv7fl") as caught:
        load_robot(name)
    assert (caught.value.kind, caught.value.name) == ("robot", name)
    assert caught.value.known == sorted(NAMES)


def test_only_tables_have_parameters(write):
    for robot in ("panda", write(urdf())):
        with pytest.raises(InvalidTable, match="has no parameters"):
            load_robot(robot, parameters={"l1": 1})


def test_a_urdf_of_ones_own_is_a_robot(write):
    path = write(urdf())
    for given in (path, str(path)):
        robot = load_robot(given)
        assert (robot.name, robot.frame, robot.source) == ("arm", "tip", path)
        assert robot.collision_model.ngeoms == 1


def test_a_urdf_may_begin_with_a_byte_order_mark_and_end_in_capitals(tmp_path):
    path = tmp_path / "arm.URDF"
    path.write_text(urdf(), encoding="utf-8-sig")
    assert load_robot(path).name == "arm"


def test_without_a_usual_tip_it_is_the_leaf_with_the_most_joints():
    def link(name: str, parent: str, kind: str) -> str:
        joint = f'<joint name="{name}_j" type="{kind}"><parent link="{parent}"/><child link="{name}"/>{JOINT}</joint>'
        return f'<link name="{name}"/>{joint}'

    from pin_metaik.robots.description import build_model
    from pin_metaik.robots.robot import _tip

    tree = [link("camera", "tip", "fixed"), link("b", "tip", "revolute"), link("a", "tip", "revolute")]
    model = build_model(urdf(more="".join(tree)), Path("arm.urdf"))
    assert _tip(model, "tool0", Path("arm.urdf")) == "a"
    assert _tip(model, "camera", Path("arm.urdf")) == "camera"
    assert _tip(model, "base", Path("arm.urdf")) == "a"


UNREADABLE = {
    "empty": ("", "not well-formed XML: no element found"),
    "cut short": (urdf()[:-20], "not well-formed XML"),
    "no XML": ("robot", "not well-formed XML: syntax error: line 1"),
    "another language": ("<sdf/>", "outermost element is not <robot>"),
    "no links": ('<robot name="a"/>', "No link elements found"),
    "two roots": (urdf(more='<link name="b2"/>'), r"Two root links found: \[b2\] and \[base\]"),
    "a revolute joint without limits": (
        urdf(limit=""),
        r"Joint \[j\] is of type REVOLUTE but it does not specify limits",
    ),
    "a limit that is no number": (urdf(JOINT.replace('"-1"', '"nan"')), r"joint \[j\]: lower value \(nan\)"),
    "an infinite limit": (urdf(JOINT.replace('"-1"', '"-inf"')), r"joint \[j\]: lower value \(-inf\)"),
    "an unknown type": (urdf(kind="wobbly"), r"Joint \[j\] has no known type \[wobbly\]"),
    "a joint to nowhere": (urdf().replace('child link="tip"', 'child link="tap"'), r"child link \[tap\].*not found"),
    "no joint that moves": (urdf(kind="fixed"), "no frame that a joint moves"),
}


@pytest.mark.parametrize("what", UNREADABLE)
def test_a_urdf_that_cannot_be_read_is_told_by_one_error_and_nothing_printed(what, write, capfd):
    text, message = UNREADABLE[what]
    with pytest.raises(InvalidModel, match=message) as caught:
        load_robot(write(text))
    assert str(caught.value).count("arm.urdf") == 1
    assert len(str(caught.value).splitlines()) == 1
    assert capfd.readouterr() == ("", "")


def test_crossed_limits_are_refused_with_the_joints_name(write):
    with pytest.raises(InvalidBounds, match="joint 'j' has its lower limit 1 above its upper -1"):
        load_robot(write(urdf('<limit lower="1" upper="-1" effort="1" velocity="1"/>')))


def test_files_that_are_missing_or_of_another_kind_are_named(tmp_path, write):
    with pytest.raises(InvalidModel, match=r"cannot read .*nowhere\.urdf: No such file"):
        load_robot(tmp_path / "nowhere.urdf")
    with pytest.raises(InvalidModel, match=r"cannot read .*folder\.urdf: Is a directory"):
        (tmp_path / "folder.urdf").mkdir()
        load_robot(tmp_path / "folder.urdf")
    with pytest.raises(InvalidModel, match=r"arm\.xacro: a robot is a \.urdf file, a DH table \(\.toml\) or a name"):
        load_robot(write(urdf(), "arm.xacro"))
    with pytest.raises(InvalidModel, match="not UTF-8"):
        (tmp_path / "latin.urdf").write_bytes(b"<robot name='\xff'/>")
        load_robot(tmp_path / "latin.urdf")


def mesh(filename: str) -> str:
    return urdf(geometry=f'<mesh filename="{filename}"/>')


@pytest.mark.parametrize("filename", ["package://arms/meshes/gone.stl", "gone.stl", "file:///gone.stl"])
def test_a_missing_mesh_is_named_when_the_geometry_is_asked_for(filename, write, capfd):
    robot = load_robot(write(mesh(filename)))
    with pytest.raises(InvalidModel, match=r"gone\.stl"):
        _ = robot.collision_model
    assert robot.visual_model.ngeoms == 0
    assert capfd.readouterr() == ("", "")


def test_a_mesh_that_is_none_is_named(write, tmp_path):
    robot = load_robot(write(mesh("bad.stl")))
    (tmp_path / "bad.stl").write_text("not a mesh")
    with pytest.raises(InvalidModel, match=r"bad\.stl"):
        _ = robot.collision_model


@pytest.mark.parametrize("filename", ["package://arms/meshes/m.stl", "../meshes/m.stl"])
def test_meshes_are_found_from_the_file(filename, write):
    write(MESH, "arms/meshes/m.stl")
    assert load_robot(write(mesh(filename), "arms/urdf/arm.urdf")).collision_model.ngeoms == 1


def test_meshes_are_found_through_ros_package_path(write, tmp_path, monkeypatch):
    write(MESH, "elsewhere/arms/m.stl")
    path = write(mesh("package://arms/m.stl"), "here/arm.urdf")
    monkeypatch.setenv("ROS_PACKAGE_PATH", f"/nowhere:{tmp_path / 'elsewhere'}")
    assert load_robot(path).collision_model.ngeoms == 1


def follower(followed: str, kind: str) -> str:
    limit = JOINT if followed == "revolute" else ""
    joint = f'<joint name="k" type="{kind}"><parent link="tip"/><child link="end"/><axis xyz="0 1 0"/>{JOINT}'
    return urdf(limit, kind=followed, more=f'<link name="end"/>{joint}<mimic joint="j" multiplier="0.5"/></joint>')


@pytest.mark.parametrize(
    ("followed", "kind", "held"),
    [
        ("revolute", "revolute", True),
        ("revolute", "prismatic", True),
        ("continuous", "continuous", True),
        ("continuous", "revolute", False),
        ("revolute", "continuous", False),
    ],
)
def test_a_continuous_joint_can_only_follow_and_be_followed_by_its_like(followed, kind, held, write):
    robot = load_robot(write(follower(followed, kind)))
    assert robot.model.nv == (1 if held else 2)
    assert robot.free_mimics == (() if held else ("k",))


def test_whatever_is_listed_can_be_loaded_as_it_is_listed() -> None:
    listed = robot_names()
    first, last = load_robot(listed[0]), load_robot(listed[-1])
    assert (first.name, last.name) == (listed[0].name, listed[-1].name)
    with pytest.raises(InvalidModel, match="name: expected a text or a path or a RobotName, got 7"):
        load_robot(7)  # type: ignore[arg-type]
