import pickle
import types
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from pin_metaik.errors import InvalidBounds, InvalidModel, InvalidTable, UnknownName
from pin_metaik.kinematics import Chain
from pin_metaik.kinematics.model import frame_id
from pin_metaik.robots import load_robot, robot_names
from pin_metaik.robots.description import description_of
from pin_metaik.robots.library import LEFT_OUT, TIPS, catalogue, example_robots

NAMES = [*catalogue(), *example_robots()]
ARMS = ["baxter", "kinova", "panda", "pr2", "talos", "talos_arm", "tiago", "ur5", "ur10", "xarm7", "z1"]
MIMICKING = ["baxter", "panda", "panda_collision", "pr2", "romeo", "talos_full", "talos_full_box", "tiago_pro"]
FREED = ["alex_psyonic_hands"]
REMARKED = {"alex_psyonic_hands", "pr2"}

JOINT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'
MESH = (
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n"
)


def urdf(limit: str = JOINT, geometry: str = "", kind: str = "revolute", more: str = "") -> str:
    return f"""<robot name="arm"><link name="base"/>
      <link name="tip"><collision><geometry>{geometry or '<sphere radius="0.1"/>'}</geometry></collision></link>
      <joint name="j" type="{kind}"><parent link="base"/><child link="tip"/><axis xyz="0 0 1"/>{limit}</joint>
      {more}</robot>"""


MJCF = """<mujoco model="arm"><compiler angle="radian"/><worldbody>
  <body name="a" pos="0 0 0.1"><joint name="j1" type="hinge" axis="0 0 1" range="-3 3"/>
    <body name="b" pos="0 0 0.3"><joint name="j2" type="slide" axis="0 1 0" range="-2 2"/>
      <geom type="box" size="0.1 0.1 0.1"/><site name="tip" pos="0 0 0.3"/></body></body></worldbody></mujoco>"""


@pytest.fixture
def write(tmp_path):
    def write(text: str, name: str = "arm.urdf") -> Path:
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    return write


@pytest.mark.filterwarnings("ignore:.*mimics|.*these limits are ignored")
@pytest.mark.parametrize("name", NAMES)
def test_every_listed_robot_loads_with_a_tip_that_its_joints_move(name, capfd):
    robot = load_robot(name)
    model, data = robot.model, robot.model.createData()
    frame = frame_id(model, robot.frame)
    assert robot.name == name
    assert bool(robot.remarks) == (name in REMARKED)
    assert np.abs(pin.computeFrameJacobian(model, data, pin.neutral(model), frame)).max() > 0
    assert not {"collision_model", "visual_model"} & set(vars(robot))
    assert capfd.readouterr() == ("", "")


def test_the_list_has_every_robot_with_its_source_freedom_and_tip():
    listed = robot_names()
    assert [robot.name for robot in listed] == NAMES
    by_name = {robot.name: robot for robot in listed}
    rv7fl, panda = by_name["rv7fl"], by_name["panda"]
    assert (rv7fl.source, rv7fl.dof, rv7fl.frame) == ("catalogue", 6, "tool0")
    assert (panda.source, panda.dof, panda.frame) == ("example-robot-data", 8, "panda_hand_tcp")
    assert set(ARMS) <= set(by_name)
    assert "panda" in listed
    assert panda == "panda" and hash(panda) == hash("panda") and f"{panda:>7}" == "  panda"
    again = pickle.loads(pickle.dumps(panda))
    assert (again, again.frame) == ("panda", "panda_hand_tcp")


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


@pytest.mark.filterwarnings("ignore:.*these limits are ignored")
@pytest.mark.parametrize("name", MIMICKING)
def test_a_mimic_joint_moves_as_its_urdf_says(name):
    held, free = load_robot(name), load_robot(name, mimic=False)
    moving = [joint for joint in ET.fromstring(held.urdf).findall("joint[mimic]") if joint.get("type") != "fixed"]
    tags = {joint.get("name"): joint.find("mimic") for joint in moving}
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
def test_mimic_joints_whose_leader_does_not_exist_are_free_and_said_to_be(name):
    with pytest.warns(UserWarning, match=r"'Left_index_q2' mimics 'index_q1', which .*did you mean 'Left_index_q1'"):
        robot = load_robot(name)
    assert len(robot.free_mimics) == len(robot.remarks) == 8
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


@pytest.mark.parametrize(("name", "meant"), [("UR5", "ur5"), ("Panda", "panda"), ("PUMA560", "puma560")])
def test_capitals_do_not_hide_which_name_is_meant(name, meant):
    with pytest.raises(UnknownName, match=f"no robot named '{name}'; did you mean '{meant}'"):
        load_robot(name)


def test_a_long_name_is_cut_in_the_message():
    with pytest.raises(UnknownName, match=r"no robot named 'a{80}\.\.\.'; known"):
        load_robot("a" * 5000)


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


UNREADABLE = {
    "empty": ("", "it has no XML element <robot>"),
    "cut short": (urdf()[:-20], "not well-formed XML"),
    "no XML": ("robot", "it has no XML element <robot>"),
    "another language": ("<scene/>", "outermost element is <scene>, not <robot>"),
    "SDF": ("<sdf version='1.6'/>", "is SDF, which Pinocchio's wheels cannot read"),
    "xacro": (urdf(more='<xacro:include filename="hand.xacro"/>'), "xacro that cannot be expanded: unbound prefix"),
    "a property of xacro": (urdf(JOINT.replace('"-1"', '"${-tau_}"')), "xacro that cannot be expanded: name 'tau_'"),
    "a version to come": (urdf().replace("<robot", "<robot version='2.0'"), "URDF of version '2.0': up to 1.2"),
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


def test_crossed_limits_refuse_the_chain_that_the_joint_moves_and_not_the_robot(write):
    crossed = (
        '<joint name="k" type="revolute"><parent link="base"/><child link="b"/><limit lower="1" upper="-1"/></joint>'
    )
    robot = load_robot(write(urdf(more=f'<link name="b"/>{crossed}')))
    assert Chain(robot.model, "tip").n == 1
    with pytest.raises(InvalidBounds, match=r"joint .k. has its lower limit 1\.0 above its upper limit -1"):
        Chain(robot.model, "b")


def test_files_that_are_missing_or_of_another_kind_are_named(tmp_path, write):
    for name in ("nowhere.urdf", "arm.xml", "arm.urdf.xacro"):
        with pytest.raises(InvalidModel, match=rf"cannot read .*{name}: No such file"):
            load_robot(tmp_path / name)
        with pytest.raises(InvalidModel, match=rf"cannot read {name}: No such file"):
            load_robot(name)
    with pytest.raises(InvalidModel, match=r"cannot read .*folder\.urdf: Is a directory"):
        (tmp_path / "folder.urdf").mkdir()
        load_robot(tmp_path / "folder.urdf")
    with pytest.raises(InvalidModel, match=r"arm\.stl is not a URDF: it has no XML element <robot>"):
        load_robot(write(MESH, "arm.stl"))


@pytest.mark.parametrize("name", ["arm.urdf", "arm.xml", "arm.xacro", "arm.urdf.xacro", "arm.txt", "arm"])
def test_a_files_content_decides_what_it_is_not_its_suffix(name, write, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert load_robot(write(urdf(), name)).frame == load_robot(name).frame == "tip"


def test_the_text_of_a_urdf_is_a_robot_whose_meshes_are_looked_for_from_here(write, tmp_path, monkeypatch):
    write(MESH, "meshes/m.stl")
    monkeypatch.chdir(tmp_path)
    robot = load_robot(f'<?xml version="1.0"?>\n{mesh("package://meshes/m.stl")}')
    assert (robot.name, robot.frame, robot.source) == ("arm", "tip", None)
    assert robot.collision_model.ngeoms == 1
    with pytest.raises(InvalidModel, match="the URDF text is not well-formed XML") as caught:
        load_robot(urdf()[:-20])
    assert len(str(caught.value)) < 150


def test_a_robot_may_come_as_mjcf(write, tmp_path):
    for given in (write(MJCF, "arm.xml"), MJCF):
        robot = load_robot(given)
        assert (robot.name, robot.frame, robot.model.nv, robot.free_mimics) == ("arm", "tip", 2, ())
        assert robot.collision_model.ngeoms == 1
        assert robot.visual_model.ngeoms == 1
        tip = Chain(robot.model, "tip").placements(np.array([0.0, 0.1]))[0]
        np.testing.assert_allclose(tip.translation, [0.0, 0.1, 0.7], atol=1e-12)
        assert description_of(robot.model) == robot.description
    with pytest.raises(InvalidModel, match="by <freejoint/>"):
        load_robot(MJCF, free_flyer=True)
    with pytest.warns(UserWarning, match="has <equality><joint>, which is not read"):
        load_robot(MJCF.replace("</mujoco>", "<equality><joint joint1='j2' joint2='j1'/></equality></mujoco>"))
    with pytest.raises(InvalidModel, match=r"not MJCF that can be read: No such node \(body\)"):
        load_robot("<mujoco><worldbody/></mujoco>")
    with pytest.raises(InvalidModel) as caught:
        load_robot("<mujoco/>")
    told = "the MJCF text is not MJCF that can be read: MJCF parser: no body found in parsed tree."
    assert str(caught.value) == told
    with pytest.raises(InvalidModel, match="the MJCF text is not MJCF that can be read: the MJCF text"):
        load_robot("<mujoco>")


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


@pytest.mark.parametrize("followed", ["revolute", "continuous"])
@pytest.mark.parametrize("kind", ["revolute", "prismatic", "continuous"])
def test_joints_of_any_kind_follow_joints_that_turn(followed, kind, write):
    robot = load_robot(write(follower(followed, kind)))
    assert (robot.model.nq, robot.model.nv, robot.free_mimics) == (1, 1, ())


def test_whatever_is_listed_can_be_loaded_as_it_is_listed() -> None:
    listed = robot_names()
    first, last = load_robot(listed[0]), load_robot(listed[-1])
    assert (first.name, last.name) == (listed[0].name, listed[-1].name)
    with pytest.raises(InvalidModel, match="name: expected a text or a path or a RobotName or a module, got 7"):
        load_robot(7)  # type: ignore[arg-type]


@pytest.mark.parametrize("kind", ["URDF_PATH", "MJCF_PATH"])
def test_a_module_that_has_a_path_describes_a_robot(kind):
    module = types.ModuleType("panda_description")
    setattr(module, kind, str(load_robot("panda").source))
    assert load_robot(module).model == load_robot("panda").model
    with pytest.raises(InvalidModel, match="'types' describes no robot: it has neither URDF_PATH nor MJCF_PATH"):
        load_robot(types)
