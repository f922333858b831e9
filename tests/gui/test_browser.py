"""The toolbox in Chromium: the papers' examples clicked through, a target and a map under the mouse; nothing leaves."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import pytest

from pin_metaik import mobile, stewart
from pin_metaik.compare.papers.path_planning_setup import ITERATIONS, SETTINGS
from pin_metaik.compare.papers.puma_offset import EXAMPLES, METHODS, O
from pin_metaik.gui.pages.heuristics.state import PENALTY_17
from pin_metaik.ik import IKProblem, Target
from pin_metaik.optimize import Budget, minimize

DESIGNS = 120  # of the paper's 3600: two generations, whose numbers are the library's as well


def test_a_target_follows_the_mouse_and_a_map_takes_corners_from_its_clicks(tab: Any, toolbox: Any) -> None:
    tab.see("SOLVED")
    (session,) = toolbox.tabs.values()
    before = session.page.kept()["target"]
    x, y = session_pixel(session, before[:3], tab)
    tab.drag_mouse((x, y), (x + 25, y - 25))
    tab.wait_until(lambda: session.page.kept()["target"] != before)
    assert session.page.kept()["q"]

    tab.choose("Page", "Path planning")
    tab.see("Quickest motion along the shortest path")
    tab.choose("Mouse", "Draw obstacles")
    corners = [(7.0, 1.0), (9.0, 1.0), (9.0, 3.0)]
    for corner in corners:
        tab.page.mouse.click(*session_pixel(session, (*corner, 0.0), tab))
    tab.see("3 corners")
    tab.click("Close")
    tab.wait_until(lambda: len(session.page.kept()["scene"]["obstacles"]) == 3)
    drawn = np.array(session.page.kept()["scene"]["obstacles"][-1])
    for corner in corners:
        assert np.linalg.norm(drawn - corner, axis=1).min() < 0.1  # a few pixels


def test_the_papers_ga_and_pso_are_clicked_through_and_their_numbers_are_the_librarys(tab: Any) -> None:
    setting = SETTINGS["10 obstacles"]
    plan = mobile.plan_path(
        mobile.load_scene(setting.scene),
        setting.algorithm("GA"),
        fitness=mobile.PaperFitness(penalty=PENALTY_17),
        via=setting.via,
        budget=Budget(evaluations=setting.agents * ITERATIONS),
        rng=0,
    )
    example = EXAMPLES["Example B"]
    problem = IKProblem.of(example.chain(), Target.at(example.goal))
    budget = Budget(evaluations=example.budget)
    found = minimize(partial(O, problem, example.p), problem.box, METHODS["PSO"], budget, 0)
    assert plan.evaluations == found.evaluations == 10_000

    tab.choose("Page", "Metaheuristics at work")
    tab.see("Examples of the paper")
    tab.click("Set up")
    tab.see("crossover_rate")
    tab.click_until("Run", "by the exact test")
    assert f"{plan.cost:.6g}" in tab.text() and f"length {plan.length:.6f}" in tab.text()
    assert re.search(r"ga 1\s+\S+\s+10,000", tab.text())

    tab.choose("Example", "Fig. 18: PSO on the Puma")
    tab.click("Set up")
    tab.see("Goal x, y, z, m")
    tab.click_until("Run", "tip at")
    reached = problem.chain.poses(found.x)[0, 0, :3, 3]
    assert f"{found.cost:.6g}" in tab.text()
    assert f"tip at ({', '.join(f'{value:.4f}' for value in reached)})" in tab.text()


def test_the_3x3_design_for_a_stroke_of_100_mm_is_clicked_through(tab: Any, toolbox: Any) -> None:
    mechanism = stewart.load_mechanism("stroke_100")
    assert mechanism.task is not None and mechanism.geometry.type == "3x3"
    designed = stewart.design(replace(mechanism, task=replace(mechanism.task, evaluations=DESIGNS)))
    assert designed.score is not None
    tab.choose("Page", "Stewart platforms")
    tab.see("dexterity nu")
    tab.see("stroke_100")  # what the page begins with
    tab.open("5 Goal and search")
    tab.type("evaluations", str(DESIGNS))
    tab.click_until("Design", "designs looked at")
    assert f"{designed.score.fitness:.4f}: dexterity {designed.score.dexterity:.4f}" in tab.text()
    tab.click("Take the design")
    (session,) = toolbox.tabs.values()
    taken = stewart.to_toml(designed.mechanism)
    tab.wait_until(lambda: session.page is not None and session.page.kept()["mechanism"] == taken)


def session_pixel(session: Any, point: Any, tab: Any) -> tuple[float, float]:
    """Where a point of the scene is on the screen, by the camera that the browser tells."""
    import pinocchio as pin

    camera = session.client.camera
    w, x, y, z = camera.wxyz
    seen = pin.Quaternion(w, x, y, z).toRotationMatrix().T @ (np.asarray(point) - camera.position)
    box = tab.page.locator("canvas").first.bounding_box()
    scale = 0.5 * box["height"] / np.tan(0.5 * camera.fov)
    u, v = scale * seen[:2] / seen[2]
    return box["x"] + 0.5 * box["width"] + u, box["y"] + 0.5 * box["height"] + v


@pytest.mark.parametrize("page", ["Comparisons", "Information"])
def test_the_other_pages_open(tab: Any, page: str) -> None:
    tab.choose("Page", page)
    tab.see({"Comparisons": "Send the folder", "Information": "a page for teachers"}[page])
