import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from pin_metaik.collision import Box, Capsule, Cone, HalfSpace, Mesh, Obstacle, Sphere, viewer
from pin_metaik.collision.drawing import surface
from pin_metaik.collision.world import CollisionWorld
from pin_metaik.errors import FrameNotFound, InvalidGeometry, MissingExtra
from tests.collision.test_mesh import CORNERS
from tests.collision.worlds import robot_of

EXAMPLE = Path(__file__).parents[2] / "examples" / "11_look_at_the_world.py"


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
    monkeypatch.setattr("pin_metaik.lookup.find_spec", lambda name: None)
    with pytest.raises(MissingExtra, match=r"\[viewer\]"):
        viewer.open_viewer(world)


def test_what_collides_is_red_and_only_while_it_does(world: CollisionWorld) -> None:
    pytest.importorskip("viser")
    world.add(Obstacle("ball", Sphere(0.2), (0.8, 0.2, 0.1)))
    shown = viewer.open_viewer(world, port=0, frame="tool0")
    try:
        free, hit = np.array([0.0, -1.5, 0.5, 0.0, 0.0, 0.0]), np.zeros(6)
        names = {name for contact in world.pairs_in_collision(hit) for name in contact[:2]}
        assert "ball" in names
        assert not world.in_collision(free)
        for q, red in ((free, set()), (hit, names), (free, set())):
            shown.display(q)
            hidden = {piece for piece in shown._owners if not shown.frames[f"pinocchio/visual/{piece}"].visible}
            assert {shown._owners[piece] for piece in hidden} == red
            assert {piece for piece, twin in shown._red.items() if twin.visible} == hidden
            data = world.model.createData()
            pin.framesForwardKinematics(world.model, data, q)
            tip = data.oMf[world.model.getFrameId("tool0")]
            np.testing.assert_allclose(shown._tip.position, tip.translation, atol=1e-6)
        shown.show_target((0.1, 0.2, 0.3))
        with pytest.raises(InvalidGeometry):
            shown.show_target((0.1, 0.2, np.nan))
    finally:
        shown.viewer.stop()


def test_a_viewer_listens_to_this_machine_only_and_opens_on_the_whole_scene(world: CollisionWorld) -> None:
    pytest.importorskip("viser")
    shown = viewer.open_viewer(world, port=0)
    try:
        assert shown.viewer.get_host() == "127.0.0.1"
        camera = shown.viewer.initial_camera
        away = np.linalg.norm(np.asarray(camera.position) - camera.look_at)
        corners = np.concatenate([shown._corners(robot=True), shown._corners(robot=False)])
        ray = (np.asarray(camera.look_at) - camera.position) / away
        depth = (corners - camera.position) @ ray
        across = np.linalg.norm(corners - camera.position - depth[:, None] * ray, axis=1)
        assert depth.min() > 0.0
        assert 0.4 < (across / depth).max() / np.tan(0.5 * camera.fov) < 1.1
    finally:
        shown.viewer.stop()


def test_a_frame_that_the_robot_lacks_is_told(world: CollisionWorld) -> None:
    pytest.importorskip("viser")
    with pytest.raises(FrameNotFound, match="did you mean 'tool0'"):
        viewer.open_viewer(world, port=0, frame="tool1")


@pytest.mark.parametrize("shape", [Box((0.2, 0.4, 0.6)), Sphere(0.3), Capsule(0.1, 0.4), Cone(0.1, 0.6), Mesh(CORNERS)])
def test_what_is_drawn_is_as_large_as_the_shape(shape: Box) -> None:
    pytest.importorskip("trimesh")
    geometry = shape.geometry()
    geometry.computeLocalAABB()
    vertices, _ = surface(geometry)
    np.testing.assert_allclose(vertices.max(axis=0), geometry.aabb_local.max_, atol=2e-3)
    np.testing.assert_allclose(vertices.min(axis=0), geometry.aabb_local.min_, atol=2e-3)


def test_the_example_stays_until_it_is_interrupted_and_ends_without_a_traceback(tmp_path: Path) -> None:
    pytest.importorskip("viser")
    command = [sys.executable, "-u", str(EXAMPLE), "--stay", "--port", "0"]
    with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as run:
        assert run.stdout is not None
        assert any("HTTP" in line for line in iter(run.stdout.readline, ""))
        run.send_signal(signal.SIGINT)
        _, errors = run.communicate(timeout=300)
        assert run.returncode == 130
        assert "Traceback" not in errors
