"""Targets: what is taken for one, and what is refused where it enters."""

import math

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

import pin_metaik as mik
from pin_metaik.errors import InvalidTarget

NAN, INF = math.nan, math.inf


def off(value: float, at: tuple[int, int]) -> np.ndarray:
    matrix = np.eye(4)
    matrix[at] = value
    return matrix


@pytest.mark.parametrize(
    ("target", "says"),
    [
        (off(NAN, (0, 3)), "finite"),
        (off(INF, (1, 1)), "finite"),
        (off(1.1, (0, 0)), "orthonormal"),
        (np.diag([1.0, 1.0, -1.0, 1.0]), "right-handed"),
        (off(0.5, (3, 0)), "last row"),
        (np.eye(3), "4x4"),
        (np.zeros(4), "4x4"),
        ([1.0, 2.0], "position"),
        ([NAN, 0.0, 0.0], "finite"),
        ("up", "pin.SE3"),
        (None, "pin.SE3"),
        ({}, "pin.SE3"),
        (pin.SE3(np.eye(3) * 2.0, np.zeros(3)), "orthonormal"),
        (pin.SE3(np.eye(3), np.array([NAN, 0.0, 0.0])), "finite"),
    ],
)
def test_what_is_no_target_is_refused_with_the_reason(target: object, says: str) -> None:
    with pytest.raises(InvalidTarget, match=says):
        mik.Target.of(target)


@pytest.mark.parametrize("tolerance", [0.0, -1e-3, NAN, (1e-3, 1e-3), (1e-3, 0.0, 1e-3), "small"])
def test_a_tolerance_is_above_zero(tolerance: object) -> None:
    with pytest.raises(InvalidTarget, match="position_tolerance"):
        mik.Target(np.eye(4), position_tolerance=tolerance)


@pytest.mark.parametrize("weight", [0.0, -1.0, NAN, INF])
def test_a_weight_is_finite_and_above_zero(weight: float) -> None:
    with pytest.raises(InvalidTarget, match="orientation_weight"):
        mik.Target(np.eye(4), orientation_weight=weight)


def test_something_must_count() -> None:
    with pytest.raises(InvalidTarget, match="nothing is left"):
        mik.Target(np.eye(4), position_tolerance=INF, orientation_tolerance=(INF, INF, INF))
    with pytest.raises(InvalidTarget, match="nothing is left"):
        mik.Target(np.eye(4), position_tolerance=INF, orientation_tolerance=INF)


def test_a_pose_a_matrix_and_a_position_are_targets() -> None:
    pose = pin.SE3.Random()
    assert_allclose(mik.Target.of(pose).pose.homogeneous, pose.homogeneous)
    assert_allclose(mik.Target.of(pose.homogeneous.tolist()).pose.homogeneous, pose.homogeneous)
    position = mik.Target.of([1, 2, 3])
    assert_allclose(position.pose.translation, [1, 2, 3])
    assert position.orientation_tolerance == INF


def test_judging_measures_in_metres_and_radians_and_leaves_free_axes_out() -> None:
    goal = pin.SE3.Random()
    error = pin.SE3(pin.exp3(np.array([0.0, 0.0, 0.3])), np.array([0.03, 0.04, 0.0]))
    judged = mik.Target(goal).judge(goal * error)
    assert judged.position_error == pytest.approx(0.05)
    assert judged.orientation_error == pytest.approx(0.3)
    assert not judged.met
    assert mik.Target(goal, position_tolerance=0.051, orientation_tolerance=0.31).judge(goal * error).met
    assert not mik.Target(goal, position_tolerance=0.049, orientation_tolerance=0.31).judge(goal * error).met
    assert mik.Target(goal, position_tolerance=(0.031, 0.041, 1e-5), orientation_tolerance=(1e-5, 1e-5, INF)).judge(
        goal * error
    ) == (pytest.approx(0.05), pytest.approx(0.0), True)
