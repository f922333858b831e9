import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

from pin_metaik.errors import InvalidTarget
from pin_metaik.stewart import leg_lengths, pose_at
from tests.stewart.cases import cube, reference, some_poses, stroke

PRINTED = 1e-8 + 5e-10  # m: the figures have 1e-5 mm


def test_leg_lengths_of_the_design_for_stroke_100():  # A1
    geometry = stroke(100).geometry
    level = leg_lengths(geometry, pose_at((0, 0, 0.230)))
    tilted = leg_lengths(geometry, pose_at((0.020, -0.015, 0.240), np.radians((5, -8, 12))))
    level_mm = [305.207953, 287.430350, 305.014055, 287.561768, 305.304942, 288.166261]
    tilted_mm = [295.424803, 293.187101, 327.867639, 309.894107, 300.489699, 301.245912]
    assert_allclose(level, np.array(level_mm) / 1e3, rtol=0, atol=PRINTED)
    assert_allclose(tilted, np.array(tilted_mm) / 1e3, rtol=0, atol=PRINTED)


def test_leg_lengths_of_the_6x6_reference():  # A3
    geometry = reference().geometry
    tilted = leg_lengths(geometry, pose_at((0.030, -0.020, 0.420), np.radians((5, -8, 12))))
    tilted_mm = [442.711321, 469.360039, 474.757793, 464.676868, 429.003947, 467.298450]
    assert_allclose(leg_lengths(geometry, pose_at((0, 0, 0.4))), 0.436963767, rtol=0, atol=PRINTED)
    assert_allclose(tilted, np.array(tilted_mm) / 1e3, rtol=0, atol=PRINTED)


def test_the_legs_of_a_cube_are_its_edges():  # A5
    a = 0.1
    assert_allclose(leg_lengths(cube(a), pose_at((0, 0, a / np.sqrt(3)))), a, rtol=1e-12)


def test_many_poses_give_what_each_gives_alone():
    geometry = reference().geometry
    poses = some_poses(7, (0, 0, 0.4), (0.1, 0.1, 0.1), 0.4)
    assert leg_lengths(geometry, poses).shape == (7, 6)
    assert_allclose(leg_lengths(geometry, poses), [leg_lengths(geometry, pose) for pose in poses], rtol=1e-14)
    transforms = [pin.SE3(pose) for pose in poses]
    assert_allclose(leg_lengths(geometry, transforms), leg_lengths(geometry, poses), rtol=1e-14)
    assert leg_lengths(geometry, transforms[0]).shape == (6,)


def test_rpy_is_yaw_pitch_roll_in_the_base_frame():
    R = pose_at((0, 0, 0), (0.1, 0.2, 0.3))[:3, :3]
    turns = [pin.utils.rotate(axis, angle) for axis, angle in (("z", 0.3), ("y", 0.2), ("x", 0.1))]
    assert_allclose(R, turns[0] @ turns[1] @ turns[2], atol=1e-15)


@pytest.mark.parametrize(
    "pose",
    [
        np.eye(3),
        np.zeros((4, 4)),
        np.full((4, 4), np.nan),
        np.diag([1, 1, -1, 1]),
        "here",
        [np.eye(4), np.eye(3)],
        None,
    ],
)
def test_what_is_no_pose_is_refused(pose):
    with pytest.raises(InvalidTarget):
        leg_lengths(reference().geometry, pose)
    with pytest.raises(InvalidTarget):
        pose_at((0, 0))
