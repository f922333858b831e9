"""The toolbox in Chromium: the papers' examples clicked through, a target and a map under the mouse; nothing leaves."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pin_metaik import mobile, stewart
from pin_metaik.compare import read_results
from pin_metaik.compare.papers.path_planning_setup import ITERATIONS, SETTINGS
from pin_metaik.compare.papers.puma_offset import EXAMPLES, METHODS, O
from pin_metaik.compare.results.series import rates
from pin_metaik.gui.pages import PAGES
from pin_metaik.gui.pages.heuristics.state import PENALTY_17
from pin_metaik.ik import IKProblem, Target
from pin_metaik.optimize import Budget, minimize
from tests.gui.conftest import benchmark

OPEN_ALL = """() => {
  const closed = [...document.querySelectorAll("[role=button][aria-expanded=false]")];
  const seen = closed.filter((title) => title.getClientRects().length);
  seen.forEach((title) => title.click());
  return seen.length;
}"""
pytestmark = pytest.mark.xdist_group("browser")  # one worker, as each would open one of its own
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
    tab.see("Quickest motion")
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

    tab.choose("Mouse", "Add via points")
    tab.open("Way by hand")
    tab.page.mouse.click(*session_pixel(session, (1.0, 8.0, 0.0), tab))
    tab.see("longer than the shortest")
    assert np.linalg.norm(np.subtract(session.page.kept()["hand"], [1.0, 8.0])) < 0.1


def test_the_papers_ga_and_pso_are_clicked_through_and_their_numbers_are_the_librarys(tab: Any, toolbox: Any) -> None:
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
    with tab.page.expect_download() as sent:
        tab.click("Download the last run")
    saved = Path(tab.folder) / "run.json"
    sent.value.save_as(saved)
    tab.click("Forget all runs")
    tab.see("No run yet.")
    tab.send("Open a run", saved)
    tab.see("by the exact test")
    assert f"{plan.cost:.6g}" in tab.text()
    tab.type("Generation", "3")  # the slider's own box
    via = np.reshape(json.loads(saved.read_text())["populations"][3], (-1, 2))
    (session,) = toolbox.tabs.values()
    drawn = session.page._stages[0]._map._nodes["via"]
    tab.wait_until(lambda: np.allclose(drawn.points[:, :2], via, atol=1e-5))

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


def test_a_results_folder_is_opened_and_its_hardest_target_is_seen_in_arms(
    tab: Any, toolbox: Any, results: Path
) -> None:
    tab.choose("Page", "Comparisons")
    tab.see("Send the folder")
    tab.send("Open a results folder: .zip", tab.packed(results))
    tab.see("95 % interval")
    for figure in ("Share solved within so many evaluations", "Share solved", "Every method against every other"):
        tab.see(figure)
    rate = rates(read_results(results), "random")["gwo"][0]
    tab.page.get_by_role("listitem", name=f"gwo: {100 * rate:.1f} %").wait_for()
    tab.page.get_by_title(re.compile("gwo takes .* times the evaluations of dls")).wait_for()
    tab.page.get_by_label("dls", exact=True).click()
    tab.see("There are no two methods to compare.")
    tab.click_until("See it in Arms", "Orientation counts")
    (session,) = toolbox.tabs.values()
    assert session.page.kept()["robot"] == "ur5"


@pytest.mark.parametrize("page", PAGES)
def test_everything_on_a_page_has_a_name_and_folders_open_by_a_key(tab: Any, page: str) -> None:
    tab.choose("Page", PAGES[page].title)
    tab.see(benchmark("toolbox_offline").ANSWERS[page])
    title = tab.page.get_by_role("button", name="This tab", exact=True)
    before = title.get_attribute("aria-expanded")
    title.focus()
    tab.page.keyboard.press("Enter")
    tab.wait_until(lambda: title.get_attribute("aria-expanded") != before)
    tab.wait_until(lambda: not tab.page.evaluate(OPEN_ALL))
    tab.wait_until(lambda: not nameless(tab))


def nameless(tab: Any) -> list[str]:
    """What can be used on a page and has no name that a screen reader could say."""
    lines = tab.page.locator("body").aria_snapshot().splitlines()
    used = re.compile(r"- (button|textbox|slider|combobox|checkbox|spinbutton|link)(?=:| \[|$)")
    return [line.strip() for line in lines if used.match(line.strip())]
