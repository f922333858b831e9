"""Files as people have them: each is read, and its joints move by the textbook, or a message names what is wrong.

What is odd in a file is beside the same robot in plain words, from which forward kinematics is computed by hand.
"""

import re
import warnings

import numpy as np
import pinocchio as pin
import pytest

from pin_metaik.errors import MetaIKError
from pin_metaik.robots import load_robot
from tests.robots.plain_kinematics import link_placements

LIMIT = '<limit lower="-2" upper="2" effort="1" velocity="1"/>'
SHAPE = '<collision><geometry><sphere radius="0.1"/></geometry></collision>'


def arm(*, root="", link="", joint=LIMIT, kind="revolute", axis='<axis xyz="0.6 0 0.8"/>', attribute="", shape=SHAPE):
    """Two joints; what is odd goes into the outermost element, the second link or the second joint."""
    return (
        f'<robot name="arm"{attribute}>{root}<link name="base"/><link name="a"/><link name="b">{link}{shape}</link>'
        '<joint name="j" type="revolute"><parent link="base"/><child link="a"/>'
        f'<origin xyz="0.3 0 0.2" rpy="0.1 0.2 0.3"/><axis xyz="0 0 1"/>{LIMIT}</joint>'
        f'<joint name="k" type="{kind}"><parent link="a"/><child link="b"/>'
        f'<origin xyz="0.1 0.2 0.3" rpy="0.3 0.2 0.1"/>{axis}{joint}</joint></robot>'
    )


PLAIN = arm()
TURNED = PLAIN.replace('xyz="0.1 0.2 0.3" rpy="0.3 0.2 0.1"', 'xyz="0.1 0.2 0.3" quat_xyzw="0 0.6 0 0.8"')
ALONG_X = arm(axis="")

READ: dict[str, tuple[str | bytes, str]] = {
    "a tag of old Gazebo": (arm(root='<gazebo reference="a"><sensor:camera name="c"/></gazebo>'), PLAIN),
    "an attribute with a prefix nobody declared": (
        arm(link='<note drake:id="1"/>'),
        PLAIN,
    ),
    "a blank line before the declaration": (f'\n\n<?xml version="1.0"?>\n{PLAIN}', PLAIN),
    "blanks and a line before the declaration": (f'  \r\n <?xml version="1.0"?>\r\n{PLAIN}', PLAIN),
    "a comment before the declaration": (f'<!-- an arm --><?xml version="1.0"?>{PLAIN}', PLAIN),
    "a robot in a comment before the robot": (f"<!-- <robot name='old'><link/></robot> -->{PLAIN}", PLAIN),
    "dashes in a comment": (f"<!-- -- an arm -- ---->{PLAIN}", PLAIN),
    "XML 1.1": (f"<?xml version='1.1'?>{PLAIN}", PLAIN),
    "a declaration of standalone and an encoding nobody knows": (
        f"<?xml version='1.0' encoding='martian' standalone='yes'?>{PLAIN}",
        PLAIN,
    ),
    "a DOCTYPE": (f'<!DOCTYPE robot SYSTEM "urdf.dtd">{PLAIN}', PLAIN),
    "a DOCTYPE with entities": (f'<!DOCTYPE robot [<!ENTITY pi "3.14">]>{PLAIN}', PLAIN),
    "a processing instruction": (f'<?xml version="1.0"?><?xml-model href="urdf.rnc"?>{PLAIN}', PLAIN),
    "an ampersand and a less-than sign as they are": (arm(root='<gazebo note="a & b < c"/>'), PLAIN),
    "an entity of HTML": (arm(root="<gazebo>a&nbsp;b</gazebo>"), PLAIN),
    "text before the robot": (f"this is an arm {PLAIN}", PLAIN),
    "an element beside the robot": (f"{PLAIN}<note/>", PLAIN),
    "a control character": (arm(root="<gazebo>\x01</gazebo>"), PLAIN),
    "Windows' line ends": (PLAIN.replace("><", ">\r\n<"), PLAIN),
    "a byte order mark": (PLAIN.encode("utf-8-sig"), PLAIN),
    "UTF-16": (PLAIN.encode("utf-16"), PLAIN),
    "UTF-32": (PLAIN.encode("utf-32"), PLAIN),
    "zero bytes at the end": (f"{PLAIN}\n\0\0", PLAIN),
    "UTF-16 declared, without a mark": (f'<?xml version="1.0" encoding="UTF-16"?>{PLAIN}'.encode("utf-16-le"), PLAIN),
    "UTF-16 declared in a file of UTF-8": (f'<?xml version="1.0" encoding="UTF-16"?>{PLAIN}', PLAIN),
    "Latin-1, declared": (
        f'<?xml version="1.0" encoding="ISO-8859-1"?><!-- Größe -->{arm(root="<gazebo>Größe</gazebo>")}'.encode(
            "latin-1"
        ),
        PLAIN,
    ),
    "Latin-1 that is declared as UTF-8": (
        f'<?xml version="1.0" encoding="UTF-8"?>{arm(root="<gazebo>Größe</gazebo>")}'.encode("latin-1"),
        PLAIN,
    ),
    "names in other letters": (PLAIN.replace('"a"', '"größe"'), PLAIN.replace('"a"', '"größe"')),
    "names with blanks, and a link named as a joint": (
        PLAIN.replace('"a"', '"the first"').replace('"b"', '"k"'),
        PLAIN.replace('"a"', '"the first"').replace('"b"', '"k"'),
    ),
    "version 1": (arm(attribute=' version="1"'), PLAIN),
    "version 1.2": (arm(attribute=' version="1.2"'), PLAIN),
    "a quaternion in a file without a version": (TURNED, TURNED),
    "an axis without a direction": (arm(axis="<axis/>"), ALONG_X),
    "a limit without effort and velocity": (arm(joint='<limit lower="-2" upper="2"/>'), PLAIN),
    "a limit with a negative acceleration": (
        arm(joint=LIMIT.replace("/>", ' acceleration="-1"/>'), attribute=' version="1.2"'),
        PLAIN,
    ),
    "crossed limits of a joint": (arm(joint=LIMIT.replace('"-2"', '"3"')), PLAIN),
    "dynamics without a number": (arm(joint=f"{LIMIT}<dynamics/>"), PLAIN),
    "a safety controller without its gains": (arm(joint=f'{LIMIT}<safety_controller k_position="1"/>'), PLAIN),
    "a calibration that is no number": (arm(joint=f'{LIMIT}<calibration rising="up"/>'), PLAIN),
    "a material that is defined twice": (arm(root=2 * '<material name="m"><color rgba="1 0 0 1"/></material>'), PLAIN),
    "a visual with a material without a name": (
        arm(link='<visual><geometry><box size="1 1 1"/></geometry><material/></visual>'),
        PLAIN,
    ),
    "a declaration of xacro and nothing else of it": (arm(attribute=' xmlns:xacro="http://ros.org/wiki/xacro"'), PLAIN),
}

SAID: dict[str, tuple[str, str, str]] = {
    "a negative effort": (
        arm(joint=LIMIT.replace('effort="1"', 'effort="-1"')),
        PLAIN,
        "joint 'k' has effort = -1: taken as 1",
    ),
    "a negative velocity": (
        arm(joint=LIMIT.replace('velocity="1"', 'velocity="-2.5"')),
        PLAIN,
        "joint 'k' has velocity = -2.5: taken as 2.5",
    ),
    "a negative friction": (
        arm(joint=f'{LIMIT}<dynamics friction="-1"/>'),
        PLAIN,
        "joint 'k' has friction = -1: taken as 1",
    ),
    "an axis of no length": (
        arm(axis='<axis xyz="0 0 0"/>'),
        arm(axis="", kind="fixed"),
        "joint 'k' has a zero axis and is taken as fixed",
    ),
    "a mass without inertia": (
        arm(link='<inertial><mass value="1"/></inertial>'),
        PLAIN,
        r"Could not parse inertial element for Link \[b\]",
    ),
    "a misspelt element": (
        arm(axis='<axes xyz="0.6 0 0.8"/>'),
        ALONG_X,
        "joint 'k' has an element <axes>, which is not read; did you mean <axis>",
    ),
    "an element in capitals": (
        arm(axis='<Axis xyz="0.6 0 0.8"/>'),
        ALONG_X,
        "joint 'k' has an element <Axis>, which is not read; did you mean <axis>",
    ),
    "limits by other words": (
        arm(joint='<limit min="-2" max="2" effort="1" velocity="1"/>'),
        PLAIN,
        "joint 'k' has min='-2' in its <limit>, which is not read; did you mean lower?",
    ),
    "a loop": (arm(root='<loop_joint name="l"/>'), PLAIN, "<loop_joint> 'l': a URDF has no loops, this one stays open"),
    "limits in degrees": (
        arm(joint=LIMIT.replace('"-2"', '"-170"')),
        PLAIN,
        r"joint 'k' has limits \[-170, 2\] rad: probably degrees",
    ),
    "a mimic tag of a joint that does not exist": (
        arm(joint=f'{LIMIT}<mimic joint="jj"/>'),
        PLAIN,
        r"joint 'k' mimics 'jj', which does not exist \(did you mean 'j'\?\): it is free",
    ),
}

REFUSED: dict[str, tuple[str | bytes, str]] = {
    "nothing": ("", "it has no XML element <robot>"),
    "a picture": (b"\x89PNG\r\n\x1a\n\x00\x00", "it is not text"),
    "a pointer of Git LFS": ("version https://git-lfs.github.com/spec/v1\nsize 9", "pointer of Git LFS, not the file"),
    "xacro": (arm(root='<xacro:arm name="left"/>'), "is xacro that cannot be expanded: unbound prefix"),
    "xacro in a number": (
        arm(joint=LIMIT.replace('"2"', '"${pi/none}"')),
        "xacro that cannot be expanded: name 'none'",
    ),
    "SDF": ("<sdf version='1.7'><model name='m'/></sdf>", "is SDF, which"),
    "a launch file": ("<launch><node/></launch>", "outermost element is <launch>, not <robot>"),
    "an element that does not close": (PLAIN.replace("</joint>", "", 1), "not well-formed XML: mismatched tag: line 1"),
    "an attribute given twice": (arm(joint='<limit lower="1" lower="2"/>'), "not well-formed XML: duplicate attribute"),
    "numbers with commas": (arm(axis='<axis xyz="0, 0, 1"/>'), r"axis element for joint \[k\]"),
    "a decimal comma": (arm(joint=LIMIT.replace('"2"', '"1,5"')), r"joint \[k\]: upper value \(1,5\)"),
    "an axis of two numbers": (arm(axis='<axis xyz="0 1"/>'), r"axis element for joint \[k\]"),
    "a type in capitals": (arm(kind="Revolute"), r"Joint \[k\] has no known type \[Revolute\]"),
    "no limits": (arm(joint=""), r"Joint \[k\] is of type REVOLUTE but it does not specify limits"),
    "a version to come": (arm(attribute=' version="2.0"'), "version '2.0': up to 1.2 can be read"),
    "a link twice": (arm(root='<link name="a"/>'), "link 'a' is not unique"),
    "a joint twice": (PLAIN.replace('name="k"', 'name="j"'), "joint 'j' is not unique"),
    "two roots": (arm(root='<link name="c"/>'), r"Two root links found: \[base\] and \[c\]|Two root links"),
    "a mimic factor that is no number": (
        arm(joint=f'{LIMIT}<mimic joint="j" multiplier="-1/2"/>'),
        "joint 'k' mimics with multiplier = '-1/2', which is not a number",
    ),
}

SHAPES_READ = {
    "a capsule in a file without a version": ('<capsule radius="0.1" length="0.2"/>', ["Capsule"]),
    "two shapes in one geometry": ('<sphere radius="0.1"/><box size="1 1 1"/>', ["Sphere", "Box"]),
    "a sphere of no size": ('<sphere radius="0"/>', ["Sphere"]),
}

SHAPES_REFUSED = {
    "a shape nobody knows": ('<torus radius="0.1"/>', "of link 'b': Unknown geometry type 'torus'"),
    "a negative radius": ('<sphere radius="-0.1"/>', "below zero: link 'b': <sphere radius=\"-0.1\">"),
    "a negative capsule": ('<capsule radius="-1" length="1"/>', "below zero: link 'b': <capsule radius=\"-1\">"),
    "a box of two numbers": ('<box size="1 1"/>', "of link 'b': .*2 elements"),
    "a cylinder without a length": ('<cylinder radius="1"/>', "of link 'b': .*length and radius"),
    "a scale of one number": ('<mesh filename="m.stl" scale="0.001"/>', "of link 'b': Mesh scale was specified"),
    "a mesh without a file": ("<mesh/>", "of link 'b': Mesh must contain a filename"),
    "a mesh that is not there": ('<mesh filename="package://arm/m.stl"/>', "package://arm/m.stl could not be found"),
}


@pytest.fixture
def load(tmp_path):
    def load(content):
        path = tmp_path / "arm.urdf"
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return load_robot(path)

    return load


def assert_moves_like(model, plain):
    free = [joint for joint in ("j", "k") if f'name="{joint}" type="fixed"' not in plain]
    assert list(model.names)[1:] == free
    data = model.createData()
    for q in np.random.default_rng(0).uniform(-1.5, 1.5, (3, model.nq)):
        pin.framesForwardKinematics(model, data, q)
        for link, placement in link_placements(plain, dict(zip(free, q, strict=True))).items():
            frame = model.getFrameId(link, pin.FrameType.BODY)
            np.testing.assert_allclose(data.oMf[frame].homogeneous, placement, atol=1e-12)


@pytest.mark.parametrize("what", READ)
def test_a_file_that_is_odd_is_read_without_a_word_and_whole(what, load, capfd):
    content, plain = READ[what]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        robot = load(content)
        assert robot.collision_model.ngeoms == 1
        assert robot.visual_model.ngeoms == (1 if "visual" in what else 0)
    assert_moves_like(robot.model, plain)
    assert capfd.readouterr() == ("", "")


@pytest.mark.filterwarnings("ignore:.*which is not read")  # both limits
@pytest.mark.parametrize("what", SAID)
def test_what_is_mended_guessed_or_not_held_is_one_warning_that_names_it(what, load, capfd):
    content, plain, message = SAID[what]
    with pytest.warns(UserWarning, match=message) as caught:
        robot = load(content)
    assert all(len(str(warning.message).splitlines()) == 1 for warning in caught)
    assert any(re.search(message, remark) for remark in robot.remarks)
    assert robot.collision_model.ngeoms == 1
    assert_moves_like(robot.model, plain)
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("what", REFUSED)
def test_a_file_that_nobody_reads_is_refused_by_one_line_that_names_what_is_wrong(what, load, capfd):
    content, message = REFUSED[what]
    with pytest.raises(MetaIKError, match=message) as caught:
        load(content)
    assert "arm.urdf" in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("kind", ["collision", "visual"])
@pytest.mark.parametrize("what", SHAPES_READ)
def test_a_shape_that_is_odd_is_read(what, kind, load, capfd):
    shape, expected = SHAPES_READ[what]
    robot = load(arm(shape=f"<{kind}><geometry>{shape}</geometry></{kind}><{kind}/>"))
    geometry = robot.collision_model if kind == "collision" else robot.visual_model
    assert [type(part.geometry).__name__ for part in geometry.geometryObjects] == expected
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("kind", ["collision", "visual"])
@pytest.mark.parametrize("what", SHAPES_REFUSED)
def test_a_shape_that_cannot_be_read_is_named_with_its_link_when_shapes_are_asked_for(what, kind, load, capfd):
    shape, message = SHAPES_REFUSED[what]
    other = "visual" if kind == "collision" else "collision"
    good = f"<{other}><geometry><sphere radius='1'/></geometry></{other}>"
    robot = load(arm(shape=f"<{kind}><geometry>{shape}</geometry></{kind}>{good}"))
    assert_moves_like(robot.model, PLAIN)
    with pytest.raises(MetaIKError, match=message):
        _ = robot.collision_model if kind == "collision" else robot.visual_model
    assert (robot.visual_model if kind == "collision" else robot.collision_model).ngeoms == 1
    assert capfd.readouterr() == ("", "")


def test_a_shape_outside_its_geometry_is_named(load):
    robot = load(arm(shape='<collision><sphere radius="0.1"/></collision>'))
    with pytest.raises(MetaIKError, match=r"of link 'b': .*Could not parse collision element"):
        _ = robot.collision_model


def test_there_are_enough_odd_files_to_speak_of():
    assert len(READ) + len(SAID) + len(REFUSED) >= 60
