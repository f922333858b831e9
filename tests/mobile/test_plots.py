import sys

import pytest
import shapely
from matplotlib.figure import Figure

from pin_metaik.errors import MissingExtra
from pin_metaik.mobile import PathProblem, Scene, load_scene, plan_path, plan_trajectory, plots
from pin_metaik.optimize import Budget
from tests.mobile.routes import planned


def test_a_plan_is_drawn_with_its_scene_and_says_what_it_is_worth(tmp_path):
    problem = PathProblem.of(load_scene("ten_obstacles").between((0.5, 0.1), None), radius=0.05)
    figure = Figure()
    plots.draw_plan(figure, plan_path(problem))
    (ax,) = figure.axes
    assert len(ax.patches) == 10
    assert ax.get_title().endswith("the shortest")
    colliding = plan_path(load_scene("u_trap"), "pso", budget=Budget(evaluations=100))
    figure = Figure()
    plots.draw_plan(figure, colliding)
    assert "goes through an obstacle" in figure.axes[0].get_title()
    plots.save(tmp_path / "plan.png", lambda canvas: plots.draw_plan(canvas, colliding))
    assert (tmp_path / "plan.png").stat().st_size > 10_000


def test_a_trajectory_is_drawn_with_speed_turning_and_clearance():
    scene, path = planned(3)
    figure = Figure()
    plots.draw_trajectory(figure, plan_trajectory(path, obstacles=scene.obstacles), scene)
    by_label = {ax.get_ylabel(): ax for ax in figure.axes}
    assert all(len(by_label[label].lines) >= 2 for label in ("speed, m/s", "turning, deg/s", "clearance, m"))


def test_worlds_without_walls_or_obstacles_and_obstacles_with_holes_are_drawn():
    ring = shapely.box(0, 0, 3, 3).difference(shapely.box(1, 1, 2, 2))
    for scene in (Scene((-1, 0), (4, 0), (ring,)), Scene((0, 0), (1, 1))):
        figure = Figure()
        plan = plan_path(scene)
        plots.draw_plan(figure, plan)
        plots.draw_runs(figure.axes[0], scene, [plan.path], plan.path, colliding=[plan.path])
        assert figure.axes[0].lines[-2].get_linestyle() == ":"
        figure = Figure()
        plots.draw_trajectory(figure, plan_trajectory(plan.path, obstacles=scene.obstacles, radius=0.0), scene)


def test_without_matplotlib_the_extra_is_named(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(MissingExtra, match=r"pip install .*\[plots\]'"):
        plots.save(tmp_path / "no.png", lambda figure: None)
