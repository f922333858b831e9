"""Pictures of worlds: the robot, obstacles, and the axes of targets."""

from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from matplotlib.figure import Figure
from PIL import Image

from pin_metaik.collision import Box, CollisionWorld, Obstacle, draw_world, save_world
from pin_metaik.errors import InvalidGeometry
from tests.collision.worlds import robot_of

POSE = pin.SE3(pin.utils.rotate("z", np.pi / 2), np.array([0.3, 0.2, 0.6]))


@pytest.fixture(scope="module")
def world() -> CollisionWorld:
    return CollisionWorld(robot_of("ur5"), [Obstacle("box", Box((0.1, 0.1, 0.1)), (0.9, 0.0, 0.1))])


def test_a_target_is_drawn_as_its_three_axes_and_a_position_as_those_of_the_world(world: CollisionWorld) -> None:
    axes = Figure().add_subplot(projection="3d")
    draw_world(axes, world, np.zeros(6), [POSE, (0.1, 0.2, 0.3)])
    ends = np.array([np.transpose(line.get_data_3d()) for line in axes.lines])  # (6, 2, 3)
    np.testing.assert_allclose(ends[:3, 0], np.tile(POSE.translation, (3, 1)))
    directions = (ends[:, 1] - ends[:, 0]) / np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1, keepdims=True)
    np.testing.assert_allclose(directions[:3], POSE.rotation.T, atol=1e-12)
    np.testing.assert_allclose(directions[3:], np.eye(3), atol=1e-12)


def test_a_picture_is_written_and_what_is_no_target_is_told(world: CollisionWorld, tmp_path: Path) -> None:
    file = save_world(tmp_path / "world.png", world, [np.zeros(6), np.full(6, 0.3)], [POSE])
    with Image.open(file) as picture:
        assert min(picture.size) > 500 and np.asarray(picture.convert("L")).std() > 10.0  # not blank
    with pytest.raises(InvalidGeometry):
        save_world(file, world, np.zeros(6), [np.zeros(5)])
