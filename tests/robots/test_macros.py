"""Xacro: files of macros, with what they include, packages they find and arguments that they take."""

from math import pi
from pathlib import Path
from xml.sax.saxutils import escape

import pytest

from pin_metaik.errors import InvalidModel, InvalidTable, MissingExtra
from pin_metaik.robots import Description, load_robot

SPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
LINK = f"""<?xml version="1.0"?><robot {SPACE}>
<xacro:macro name="limb" params="parent child length">
  <link name="${{child}}"><visual><geometry><mesh filename="package://arm_description/m.stl"/></geometry></visual></link>
  <joint name="${{child}}_joint" type="revolute"><parent link="${{parent}}"/><child link="${{child}}"/>
    <origin xyz="${{length}} 0 0"/><axis xyz="0 0 1"/>
    <limit lower="${{-pi / 2}}" upper="${{pi / 2}}" effort="1" velocity="1"/></joint>
</xacro:macro></robot>"""
ARM = f"""<?xml version="1.0"?><robot name="limbs" {SPACE}>
<xacro:arg name="length" default="0.5"/><xacro:arg name="hand" default="false"/>
<xacro:include filename="parts/limb.xacro"/><xacro:include filename="$(find arm_description)/urdf/parts/more.xacro"/>
<link name="base"/><xacro:limb parent="base" child="upper" length="0"/>
<xacro:limb parent="upper" child="fore" length="$(arg length)"/>
<xacro:if value="$(arg hand)"><xacro:limb parent="fore" child="hand" length="0.1"/></xacro:if></robot>"""


@pytest.fixture
def arm(tmp_path: Path) -> Path:
    """A package with a robot in xacro, as ROS has them."""
    folder = tmp_path / "arm_description" / "urdf"
    (folder / "parts").mkdir(parents=True)
    (folder.parent / "package.xml").write_text("<package><name>arm_description</name></package>")
    (folder.parent / "m.stl").write_text(
        "solid m\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
        "vertex 0 1 0\nendloop\nendfacet\nendsolid m\n"
    )
    (folder / "parts" / "limb.xacro").write_text(LINK)
    (folder / "parts" / "more.xacro").write_text(f"<robot {SPACE}/>")
    path = folder / "arm.urdf.xacro"
    path.write_text(ARM)
    return path


def test_a_xacro_file_is_a_robot_with_what_it_includes_and_its_arguments(arm: Path) -> None:
    plain = load_robot(arm)
    assert (plain.name, plain.frame, plain.model.nq, plain.source) == ("limbs", "fore", 2, arm)
    assert plain.model.upperPositionLimit[0] == pytest.approx(pi / 2)
    assert plain.model.jointPlacements[2].translation[0] == 0.5
    assert plain.visual_model.ngeoms == 2
    longer = load_robot(arm, parameters={"length": 0.7, "hand": True})
    assert (longer.frame, longer.model.nq) == ("hand", 3)
    assert longer.model.jointPlacements[2].translation[0] == 0.7
    assert load_robot(longer.urdf).model.nq == 3


def test_text_may_be_xacro_too_and_what_is_wrong_with_it_is_told(arm: Path) -> None:
    text = ARM.replace('<xacro:include filename="parts/limb.xacro"/>', LINK[LINK.index("<xacro:macro") : -8])
    text = text.replace('<xacro:include filename="$(find arm_description)/urdf/parts/more.xacro"/>', "")
    assert load_robot(text).model.nq == 2
    arm.write_text(ARM.replace("parts/limb", "parts/leg"))
    with pytest.raises(InvalidModel, match=r"arm.urdf.xacro is xacro that cannot be expanded: .*parts/leg.xacro"):
        load_robot(arm)
    arm.write_text(ARM.replace("find arm_description", "find leg_description"))
    with pytest.raises(InvalidModel, match=r"cannot be expanded: .*leg_description"):
        load_robot(arm)
    with pytest.raises(InvalidModel, match=r"was not expanded: it has <xacro:arg>; run xacro on it first"):
        Description(ARM, None).model()
    with pytest.raises(InvalidTable, match="ur5 has no parameters: only DH tables and xacro files have"):
        load_robot("ur5", parameters={"length": 0.7})


@pytest.mark.parametrize("parameters", ["a:=" + "9" * 5000 + "'", "a b:='it\"", "a:=\"x' b"])
def test_a_quote_that_is_not_closed_does_not_keep_xacro_searching_for_ever(parameters: str) -> None:
    text = LINK.replace('"parent child length"', f'"{escape(parameters, {chr(34): "&quot;"})}"')
    with pytest.raises(InvalidModel, match="the parameters of macro 'limb' have a quote that is not closed"):
        load_robot(text)


def test_quotes_in_parameters_that_are_closed_are_taken(arm: Path) -> None:
    quoted = """parent child length offset:='0 0' note:="it's" """
    (arm.parent / "parts" / "limb.xacro").write_text(
        LINK.replace('"parent child length"', f'"{quoted.replace(chr(34), "&quot;")}"')
    )
    assert load_robot(arm).model.nq == 2
    whole = ARM.replace('<xacro:include filename="parts/limb.xacro"/>', LINK[LINK.index("<xacro:macro") : -8])
    whole = whole.replace('<xacro:include filename="$(find arm_description)/urdf/parts/more.xacro"/>', "")
    text = whole.replace('"parent child length"', f'"{quoted.replace(chr(34), "&quot;")}"')
    assert load_robot(text).model.nq == 2


def test_without_the_package_the_extra_is_named(arm: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pin_metaik.lookup.find_spec", lambda name: None)
    with pytest.raises(MissingExtra, match=r"arm.urdf.xacro is xacro: to expand it needs .*xacro\]"):
        load_robot(arm)
