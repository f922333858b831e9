"""The page of path planning without a browser: maps that are sent, ways round, a way by hand, motions along them."""

from __future__ import annotations

import io
import json
import zipfile
from typing import Any

import numpy as np
import pytest

pytest.importorskip("viser")

from pin_metaik import mobile
from pin_metaik.errors import InvalidGeometry
from pin_metaik.gui.pages.paths.hand import points_of, text_of

BUTTON = "Open a map: GeoJSON, ROS, scene"
FACING = (1.0, 0.0, 0.0, 0.0)
WALL = {"type": "Polygon", "coordinates": [[[4.0, 0.0], [5.0, 0.0], [5.0, 9.0], [4.0, 9.0], [4.0, 0.0]]]}


@pytest.fixture
def page(socket: Any) -> Any:
    """A tab that shows it, with the map that it begins with."""
    socket.set("Page", "Path planning")
    socket.see("SHORTEST")
    return socket


def problem_of(toolbox: Any) -> mobile.PathProblem:
    (session,) = toolbox.tabs.values()
    return mobile.PathProblem.of(session.page._editor.world, 0.23, 0.1)


def test_a_way_by_hand_is_typed_dragged_and_judged_as_by_the_library(page: Any, toolbox: Any) -> None:
    problem = problem_of(toolbox)
    for typed in ("1, 9; 5, 9", "5, 4"):
        page.set("Via points", typed)
        plan = mobile.path_through(problem, points_of(typed))
        page.see(f"{plan.status}**: length {plan.length:.6f}")
    assert not plan.collision_free
    page.drag("/page/via/0", (9.0, 2.0, 0.0), FACING)
    moved = mobile.path_through(problem, [(9.0, 2.0)])
    assert moved.gap is not None
    page.see(f"{moved.status}**: length {moved.length:.6f}, free by the exact test; {100 * moved.gap:.2f} % longer")
    assert page.value("Via points") == "9, 2"
    page.set("Via points", "5; 4")
    page.told("via points are typed as")


def test_ways_round_are_one_for_each_homotopy_class_and_a_motion_goes_along_the_chosen_one(
    page: Any, toolbox: Any
) -> None:
    problem = problem_of(toolbox)
    plans = mobile.plan_alternatives(problem, 3)
    page.set("Along", "way round")
    page.set("Plan a motion", True)
    page.told("way round: there is none that is free; there is: shortest path")
    page.set("Find ways round", True)
    for number, plan in enumerate(plans, start=1):
        page.see(f"| {number} | {plan.length:.6f} |")
    page.set("Way", 2)
    page.set("Plan a motion", True)
    drive = mobile.plan_trajectory(plans[1].path, mobile.NOMAD_200, problem.scene.obstacles)
    page.see(f"{drive.time:.6f} s; {drive.stop_and_turn:.4g} s with a stop at every corner")


def packed(files: dict[str, bytes]) -> bytes:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    return content.getvalue()


def test_a_geojson_and_a_ros_map_are_planned_on_between_the_start_and_the_goal_that_there_are(
    page: Any, toolbox: Any
) -> None:
    cells = np.full((40, 40), 254, dtype=np.uint8)
    cells[:30, 18:22] = 0  # a wall from above, rows of an image go down
    files = {
        "map.yaml": b"image: map.pgm\nresolution: 0.25\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\n"
        b"free_thresh: 0.196\n",
        "map.pgm": b"P5 40 40 255\n" + cells.tobytes(),
    }
    (session,) = toolbox.tabs.values()
    for name, content in (("wall.geojson", json.dumps(WALL).encode()), ("map.zip", packed(files))):
        before = session.page._editor.world
        page.send_file(BUTTON, name, content)
        page.wait_until(lambda before=before: session.page._editor.world is not before)
        problem = problem_of(toolbox)
        plan = mobile.plan_path(problem)
        page.see(f"{plan.status}**: length {plan.length:.6f}")
        straight = np.linalg.norm(np.subtract(problem.scene.goal, problem.scene.start))
        assert len(problem.scene.obstacles) == 1 and plan.length > 1.05 * straight  # round the wall


@pytest.mark.parametrize("via", [[], [(1.0, -2.5)], [(0.5, 1e-3), (3.0, 4.0)]])
def test_via_points_that_are_typed_read_back(via: list[tuple[float, float]]) -> None:
    assert points_of(text_of(via)) == via
    for text in ("1", "1, 2, 3", "1, x", "inf, 2"):
        with pytest.raises(InvalidGeometry, match="via points"):
            points_of(text)
