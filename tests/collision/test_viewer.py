import numpy as np
import pinocchio as pin
import pytest

from pin_metaik.collision import Box, Capsule, Cone, HalfSpace, Obstacle, viewer
from pin_metaik.collision.world import CollisionWorld
from pin_metaik.errors import MissingExtra
from tests.collision.worlds import robot_of


@pytest.fixture
def world() -> CollisionWorld:
    shapes = {"box": Box((0.1, 0.1, 0.1)), "rod": Capsule(0.05, 0.2), "hat": Cone(0.1, 0.2), "floor": HalfSpace()}
    obstacles = [Obstacle(name, shape, (1.0, 0.3 * i, -0.1)) for i, (name, shape) in enumerate(shapes.items())]
    world = CollisionWorld(robot_of("ur5"), obstacles)
    world.attach("held", Box((0.05, 0.05, 0.05)), "tool0")
    return world


def test_a_viewer_shows_robot_obstacles_and_what_is_held(world: CollisionWorld) -> None:
    pytest.importorskip("viser")
    shown = viewer.open_viewer(world, port=0)
    try:
        shown.display(pin.neutral(world.model))
        names = {piece.name for piece in shown.visual_model.geometryObjects}
        assert {"box", "rod", "hat", "floor", "held"} <= names
        held = shown.frames["pinocchio/visual/held"]
        data = world.model.createData()
        pin.framesForwardKinematics(world.model, data, pin.neutral(world.model))
        tip = data.oMf[world.model.getFrameId("tool0")]
        np.testing.assert_allclose(held.position, tip.translation, atol=1e-6)
    finally:
        shown.viewer.stop()


def test_without_the_extra_it_says_what_to_install(world: CollisionWorld, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(viewer, "find_spec", lambda name: None)
    with pytest.raises(MissingExtra, match=r"\[viewer\]"):
        viewer.open_viewer(world)
