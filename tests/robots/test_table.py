import numpy as np
import pytest

from pin_metaik.errors import InvalidTable, UnknownName
from pin_metaik.robots import Placement, load_robot, read_table

TABLE = """
name = "arm"
convention = "standard"
length = "mm"
angle = "deg"

[parameters]
l1 = 250

[tool]
xyz = [0, 0, 100]
rpy = [0, 90, 0]

[[joint]]
a = "l1"
alpha = -90
d = 10
offset = 45
limits = [-90, 180]
velocity = 60
effort = 5

[[joint]]
type = "prismatic"
name = "slide"
a = 0
alpha = 0
theta = 30
offset = "-l1"
limits = [0, 500]

[[joint]]
a = 1
alpha = 0
d = 0
continuous = true
"""


@pytest.fixture
def write(tmp_path):
    def write(text: str) -> str:
        path = tmp_path / "arm.toml"
        path.write_text(text)
        return str(path)

    return write


def test_a_table_is_read_into_metres_and_radians(write):
    table = read_table(write(TABLE))
    turn, slide, wheel = table.rows
    assert (table.name, table.convention, table.joint_names) == ("arm", "standard", ("joint_1", "slide", "joint_3"))
    assert (turn.a, turn.d, turn.effort) == (0.25, 0.01, 5)
    assert (turn.alpha, turn.theta) == (np.radians(-90), np.radians(45))
    assert (turn.lower, turn.upper, turn.velocity) == (np.radians(-90), np.pi, np.radians(60))
    assert (slide.type, slide.d, slide.theta) == ("prismatic", -0.25, np.radians(30))
    assert (slide.lower, slide.upper, slide.velocity) == (0, 0.5, 1)
    assert (wheel.type, wheel.lower, wheel.upper) == ("continuous", -np.inf, np.inf)
    assert table.tool == Placement((0, 0, 0.1), (0, np.radians(90), 0))


@pytest.mark.parametrize(("unit", "factor"), [("m", 1), ("cm", 100), ("mm", 1000)])
def test_the_same_arm_in_another_unit_is_the_same_arm(write, unit, factor):
    def text(length: str, a: float) -> str:
        head = f'name = "r"\nconvention = "modified"\nlength = "{length}"\nangle = "rad"\n'
        return f"{head}[[joint]]\na = {a}\nalpha = 0\nd = 0\nlimits = [-1, 1]\n"

    assert read_table(write(text(unit, 0.25 * factor))).rows == read_table(write(text("m", 0.25))).rows


def test_parameters_can_be_replaced_in_the_units_of_the_table(write):
    path = write(TABLE)
    assert read_table(path, {"l1": 300}).rows[0].a == 0.3
    assert read_table(path, {"l1": np.int64(300)}).rows[1].d == -0.3
    assert read_table(path).rows[0].a == 0.25


@pytest.mark.parametrize("value", [np.nan, np.inf, True, None, [1]])
def test_a_parameter_must_be_a_finite_number(write, value):
    with pytest.raises(InvalidTable, match=r"parameters: .*l1"):
        read_table(write(TABLE), {"l1": value})


def test_a_replaced_parameter_must_be_one_of_the_table(write):
    with pytest.raises(UnknownName, match=r"no parameter of arm named 'L1'; did you mean 'l1'\?"):
        read_table(write(TABLE), {"L1": 1})


JOINT1 = 'a = "l1"\nalpha = -90\nd = 10\noffset = 45\nlimits = [-90, 180]\nvelocity = 60\neffort = 5\n'

WRONG = {
    "an unknown key": ('name = "arm"', 'name = "arm"\ncolour = "red"', "unknown key 'colour'"),
    "a misspelt key": ("convention", "convetion", r"unknown key 'convetion'; did you mean 'convention'\?"),
    "a misspelt key of a joint": (
        "offset = 45",
        "ofset = 45",
        r"joint 1: unknown key 'ofset'; did you mean 'offset'\?",
    ),
    "a misspelt key of the tool": ("rpy", "rpv", r"tool: unknown key 'rpv'; did you mean 'rpy'\?"),
    "no name": ('name = "arm"\n', "", "name is missing"),
    "no convention": ('convention = "standard"\n', "", "convention is missing"),
    "no unit of length": ('length = "mm"\n', "", "length is missing"),
    "no unit of angle": ('angle = "deg"\n', "", "angle is missing"),
    "no joints": (TABLE[TABLE.index("[[joint]]") :], "", "joint is missing"),
    "no twist": ("alpha = -90\n", "", "joint 1: alpha is missing"),
    "no d of a revolute joint": ("d = 10\n", "", "joint 1: d is missing"),
    "no theta of a prismatic joint": ("theta = 30\n", "", "joint 2: theta is missing"),
    "no limits": ("limits = [-90, 180]\n", "", "joint 1: limits is missing.*or continuous = true"),
    "no limits of a prismatic joint": ("limits = [0, 500]\n", "", r"joint 2: limits is missing.*upper\]$"),
    "an unknown convention": ('"standard"', '"craig"', "convention = 'craig' is not one of standard, modified"),
    "an unknown unit": ('"mm"', '"inch"', "length = 'inch' is not one of the units m, cm, mm"),
    "an unknown type": ('"prismatic"', '"helical"', "joint 2: type = 'helical' is neither"),
    "a name that is no text": ('name = "arm"', "name = 3", "name = 3 is not text"),
    "a joint's name that is no text": ('name = "slide"', "name = 3", "joint 2: name = 3 is not text"),
    "an empty name": ('name = "arm"', 'name = ""', "'' is not a name"),
    "a number that is text": (
        "alpha = -90",
        'alpha = "-90°"',
        "joint 1: alpha = '-90°' is neither a number nor a param",
    ),
    "a number that is a list": ("d = 10", "d = [10]", r"joint 1: d = \[10\] is not a number"),
    "a number that is true": ("d = 10", "d = true", "joint 1: d = True is not a number"),
    "a number that is none": ("d = 10", "d = nan", "joint 1: d = nan is not finite"),
    "an infinite limit": ("[-90, 180]", "[-inf, 180]", "joint 1: limits = -inf is not finite"),
    "crossed limits": ("[-90, 180]", "[180, -90]", "joint 1: limits are crossed: lower 180 is above upper -90"),
    "crossed limits of a slide": ("[0, 500]", "[500, 0]", "joint 2: limits are crossed: lower 500 is above upper 0"),
    "one limit only": ("[-90, 180]", "[-90]", r"joint 1: limits = \[-90\] is not a list of 2"),
    "limits that are a number": ("[-90, 180]", "90", "joint 1: limits = 90 is not a list of 2"),
    "a speed below zero": ("velocity = 60", "velocity = -60", "joint 1: velocity = .* is not above zero"),
    "an unknown parameter": ('"l1"', '"l2"', "joint 1: a = 'l2' is neither .*; known: l1"),
    "parameters that are no table": ("[parameters]\nl1 = 250\n", "parameters = 250\n", "parameters is not a table"),
    "a parameter that is no number": ("l1 = 250", "l1 = [250]", r"parameters: l1 = \[250\] is not a number"),
    "a revolute joint with an angle": ("d = 10", "d = 10\ntheta = 3", "joint 1: theta is what a revolute joint varies"),
    "a prismatic joint with a length": (
        "theta = 30",
        "theta = 30\nd = 3",
        "joint 2: d is what a prismatic joint varies",
    ),
    "limits of a continuous joint": (
        "continuous = true",
        "continuous = true\nlimits = [0, 1]",
        "joint 3: a continuous j",
    ),
    "a continuous slide": ("theta = 30", "theta = 30\ncontinuous = true", "joint 2: a prismatic joint cannot be cont"),
    "continuous that is no boolean": ("continuous = true", "continuous = 1", "joint 3: continuous = 1 is neither true"),
    "two joints of one name": ('name = "slide"', 'name = "joint_1"', "joints 1 and 2 are both named 'joint_1'"),
    "a joint that is no list": ("[[joint]]\n" + JOINT1, "[joint]\n" + JOINT1, "is not TOML"),
    "a tool that is no table": ("[tool]\nxyz = [0, 0, 100]\nrpy = [0, 90, 0]\n", "tool = 3\n", "tool"),
    "a tool with two coordinates": ("xyz = [0, 0, 100]", "xyz = [0, 0]", r"tool: xyz = \[0, 0\] is not a list of 3"),
    "a broken line": ("alpha = -90", "alpha = ", "is not TOML: .*line"),
}


@pytest.mark.parametrize("what", WRONG)
def test_a_table_with_a_mistake_says_file_place_and_key(what, write):
    old, new, message = WRONG[what]
    assert old in TABLE
    text = TABLE.replace(old, new, 1)
    if new.startswith(("parameters", "tool")):  # a plain key must stand above the tables
        text = new + TABLE.replace(old, "", 1)
    with pytest.raises(InvalidTable, match=message) as caught:
        read_table(write(text))
    assert str(caught.value).count("arm.toml") == 1


@pytest.mark.parametrize("text", ["", "\n", "# only a comment\n"])
def test_an_empty_table_says_what_it_needs(write, text):
    with pytest.raises(InvalidTable, match="is empty: a DH table needs name, convention, length, angle, joint"):
        read_table(write(text))


def test_joints_that_are_no_tables_are_refused(write):
    with pytest.raises(InvalidTable, match=r"write \[\[joint\]\] above each row"):
        read_table(write('name = "r"\nconvention = "standard"\nlength = "m"\nangle = "rad"\njoint = [1, 2]\n'))


def test_a_missing_or_unreadable_file_is_named(tmp_path):
    with pytest.raises(InvalidTable, match=r"cannot read .*nowhere\.toml: No such file"):
        load_robot(tmp_path / "nowhere.toml")
    (tmp_path / "latin.toml").write_bytes(b'name = "\xff"')
    with pytest.raises(InvalidTable, match="not UTF-8"):
        load_robot(tmp_path / "latin.toml")


def test_a_table_of_ones_own_is_a_robot(write):
    robot = load_robot(write(TABLE.replace('"arm"', "'my <arm> & \"tool\"'")), parameters={"l1": 100})
    assert robot.name == robot.model.name == 'my <arm> & "tool"'
    assert (robot.frame, robot.model.nv, robot.model.nq) == ("tool0", 3, 4)
