"""The robots of the catalogue against the numbers of the papers they come from."""

import numpy as np
import pinocchio as pin
import pytest

from pin_metaik.errors import UnknownName
from pin_metaik.robots import Robot, load_robot, read_table
from pin_metaik.robots.library import catalogue

EXAMPLE_B = {"h": 10, "d1": 4, "l1": 5, "l2": 5, "l3": 5, "l4": 5}


def tip(robot: Robot, q: list[float]) -> np.ndarray:
    data = robot.model.createData()
    pin.framesForwardKinematics(robot.model, data, np.array(q, dtype=float))
    return data.oMf[robot.model.getFrameId(robot.frame)].translation


def test_the_papers_rv7fl_ends_at_its_third_case_when_all_angles_are_zero():
    np.testing.assert_allclose(tip(load_robot("rv7fl_paper"), [0] * 6), [-0.050, -0.905, 0.315], atol=1e-12)


def test_the_papers_rv7fl_moves_its_tip_with_the_first_three_joints_only():
    robot = load_robot("rv7fl_paper")
    rng = np.random.default_rng(0)
    first = rng.uniform(-1, 1, size=3)
    tips = [tip(robot, [*first, *rng.uniform(-2, 2, size=3)]) for _ in range(20)]
    np.testing.assert_allclose(tips, tips[:1] * 20, atol=1e-12)


def wrist(q: list[float]) -> np.ndarray:
    """The RV-7FL's wrist as seen from its shoulder."""
    frames = read_table(catalogue()["rv7fl"]).frames(q)
    return frames[4][:3, 3] - frames[1][:3, 3]


def test_the_physical_rv7fl_reaches_as_far_as_its_maker_says():
    straight = np.arctan2(0.050, 0.470)
    bends = np.radians(np.arange(163))
    reach = np.array([np.linalg.norm(wrist([0, 0, q3, 0, 0, 0])) for q3 in (straight, *bends)])
    assert reach[0] == pytest.approx(0.9077, abs=5e-5)
    assert reach[0] == pytest.approx(0.435 + np.hypot(0.470, 0.050), abs=1e-12)
    assert (reach[1:] < reach[0]).all()
    assert (np.diff(reach[1:][bends > straight]) < 0).all()
    assert reach.min() == pytest.approx(0.193, abs=5e-4)


def test_the_physical_rv7fl_points_up_at_zero_and_leans_forwards():
    np.testing.assert_allclose(tip(load_robot("rv7fl"), [0] * 6), [-0.050, 0, 1.390], atol=1e-12)
    assert wrist([0, 0.3, 0, 0, 0, 0])[0] > 0
    np.testing.assert_allclose(wrist([0, 0, np.pi / 2, 0, 0, 0]), [0.470, 0, 0.485], atol=1e-12)


def test_the_aerial_arm_ends_where_its_paper_says_at_zero():
    np.testing.assert_allclose(tip(load_robot("aerial_arm"), [0] * 6), [0.084, 0, 0.646], atol=1e-12)


def test_the_offset_puma_with_the_lengths_of_example_b_ends_where_its_paper_says():
    robot = load_robot("puma_offset", parameters=EXAMPLE_B)
    q = [0.19, -0.95, 1.90, 1.28, -1.57, 0]
    np.testing.assert_allclose(tip(robot, q), [4.9560, 5.0305, 10.0000], atol=1e-4)


def test_the_offset_puma_has_the_lengths_of_example_a_by_default():
    np.testing.assert_allclose(tip(load_robot("puma_offset"), [0] * 6), [30, 15, 30], atol=1e-12)


def test_the_offset_puma_stands_where_its_world_coordinates_say_and_starts_at_its_zeros():
    q, zeros, base = np.array([0.1, 0.2, -0.3, 0.4, 0.5, 0.6]), np.radians([0, 0, 30, 0, 0, 0]), np.array([1, -2, 3])
    moved = load_robot("puma_offset", parameters=EXAMPLE_B | {"x": 1, "y": -2, "z": 3, "zero3": 30})
    there = tip(load_robot("puma_offset", parameters=EXAMPLE_B), list(q + zeros))
    np.testing.assert_allclose(tip(moved, list(q)), there + base, atol=1e-12)


def test_an_unknown_parameter_is_answered_with_those_there_are():
    with pytest.raises(UnknownName, match=r"no parameter of puma_offset named 'l5'.*known: d1, h, l1, l2, l3, l4"):
        load_robot("puma_offset", parameters={"l5": 1})


def test_the_puma_560_is_an_l_at_zero_and_straight_up_when_ready():
    robot = load_robot("puma560")
    np.testing.assert_allclose(tip(robot, [0] * 6), [0.4521, -0.15005, 0.4318], atol=1e-12)
    np.testing.assert_allclose(tip(robot, [0, np.pi / 2, -np.pi / 2, 0, 0, 0]), [0.0203, -0.15005, 0.8636], atol=1e-12)


def test_the_scara_reaches_600_mm_and_pushes_its_quill_down():
    robot = load_robot("cobra600")
    np.testing.assert_allclose(tip(robot, [0, 0, 0, 0]), [0.600, 0, 0.387], atol=1e-12)
    np.testing.assert_allclose(tip(robot, [0, 0, 0.21, 0]), [0.600, 0, 0.177], atol=1e-12)


@pytest.mark.parametrize("name", catalogue())
def test_every_table_says_what_it_is_and_where_its_numbers_are_from(name):
    table = read_table(catalogue()[name])
    assert table.name == name
    assert table.description
    assert table.source
