import numpy as np
import pinocchio as pin
import pytest

from pin_metaik.errors import InvalidConfiguration, InvalidTable
from pin_metaik.robots import DHRow, DHTable, Placement

EXACT = 1e-14  # a few roundings of numbers about 1


def screw(axis: np.ndarray, angle: float, length: float) -> np.ndarray:
    """Turn about an axis and shift along it, by Pinocchio's exponential."""
    return pin.exp6(np.concatenate([length * axis, angle * axis])).homogeneous


def test_a_standard_row_turns_and_shifts_along_z_and_then_along_x():
    row = DHRow(a=0.3, alpha=0.7, d=-0.2, theta=0.4)
    q = 1.1
    expected = screw(np.array([0, 0, 1]), 0.4 + q, -0.2) @ screw(np.array([1, 0, 0]), 0.7, 0.3)
    np.testing.assert_allclose(DHTable("r", "standard", (row,)).fk([q]), expected, atol=EXACT)


def test_a_modified_row_turns_and_shifts_along_x_and_then_along_z():
    row = DHRow(a=0.3, alpha=0.7, d=-0.2, theta=0.4)
    q = 1.1
    expected = screw(np.array([1, 0, 0]), 0.7, 0.3) @ screw(np.array([0, 0, 1]), 0.4 + q, -0.2)
    np.testing.assert_allclose(DHTable("r", "modified", (row,)).fk([q]), expected, atol=EXACT)


@pytest.mark.parametrize("convention", ["standard", "modified"])
def test_a_prismatic_row_varies_d_and_leaves_theta(convention):
    slide = DHRow(a=0.3, alpha=0.7, d=-0.2, theta=0.4, type="prismatic", lower=0, upper=1)
    still = DHRow(a=0.3, alpha=0.7, d=-0.2 + 0.9, theta=0.4)
    np.testing.assert_allclose(
        DHTable("r", convention, (slide,)).fk([0.9]), DHTable("r", convention, (still,)).fk([0]), atol=EXACT
    )


def test_base_and_tool_stand_on_either_side_of_the_product():
    rows = (DHRow(a=0.3), DHRow(d=0.2, alpha=1.0))
    base, tool = Placement((1, 2, 3), (0.1, -0.2, 0.3)), Placement((0, 0, 0.1), (1, np.pi / 2, -1))
    q = [0.5, -0.6]
    expected = base.matrix @ DHTable("r", "standard", rows).fk(q) @ tool.matrix
    np.testing.assert_allclose(DHTable("r", "standard", rows, base, tool).fk(q), expected, atol=EXACT)
    np.testing.assert_allclose(base.matrix[:3, :3], pin.rpy.rpyToMatrix(0.1, -0.2, 0.3), atol=EXACT)


def test_frames_begin_at_the_base_and_end_where_the_tool_begins():
    table = DHTable("r", "modified", (DHRow(a=0.3), DHRow(d=0.2)), tool=Placement((0, 0, 0.1)))
    frames = table.frames([0.4, 0.5])
    assert frames.shape == (3, 4, 4)
    np.testing.assert_array_equal(frames[0], np.eye(4))
    np.testing.assert_allclose(frames[-1] @ table.tool.matrix, table.fk([0.4, 0.5]), atol=EXACT)


@pytest.mark.parametrize("q", [[], [0.0], [0.0, 0.0, 0.0], [[0.0, 0.0]], [0.0, np.nan], [np.inf, 0.0]])
def test_a_configuration_of_the_wrong_length_or_not_finite_is_refused(q):
    with pytest.raises(InvalidConfiguration, match="needs 2 finite joint positions"):
        DHTable("r", "standard", (DHRow(), DHRow())).fk(q)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"a": np.nan}, "a = nan is not finite"),
        ({"theta": np.inf}, "theta = inf is not finite"),
        ({"lower": 2, "upper": 1}, "lower 2 is above upper 1"),
        ({"upper": np.inf}, "are not finite"),
        ({"type": "continuous"}, "has no limits"),
        ({"type": "helical"}, "not one of revolute, continuous, prismatic"),
        ({"velocity": 0}, "velocity = 0 is not above zero"),
        ({"effort": -1}, "effort = -1 is not above zero"),
    ],
)
def test_a_row_that_makes_no_sense_says_which_number(settings, message):
    with pytest.raises(InvalidTable, match=message):
        DHRow(**settings)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"rows": ()}, "at least one joint"),
        ({"convention": "hybrid"}, "not one of standard, modified"),
        ({"name": " "}, "is not a name"),
        ({"rows": (DHRow(name="a\n"),)}, "is not a name"),
        ({"rows": (DHRow(name="j"), DHRow(), DHRow(name="j"))}, "joints 1 and 3 are both named 'j'"),
        ({"rows": (DHRow(name="joint_2"), DHRow())}, "joints 1 and 2 are both named 'joint_2'"),
    ],
)
def test_a_table_that_makes_no_sense_says_why(settings, message):
    with pytest.raises(InvalidTable, match=message):
        DHTable(**{"name": "r", "convention": "standard", "rows": (DHRow(),)} | settings)


def test_a_placement_must_be_finite():
    with pytest.raises(InvalidTable, match="not all finite"):
        Placement((0, 0, np.nan))
