"""Path planners side by side: the same seeds, gaps to the shortest path, and a report with pictures."""

from __future__ import annotations

from pathlib import Path

import pytest
from numpy.testing import assert_array_equal

from pin_metaik import compare, mobile
from pin_metaik.compare.planners.report import comparison_table, sections
from pin_metaik.compare.report.write import write
from pin_metaik.errors import InvalidSetting, UnknownName
from pin_metaik.interrupts import Interrupted
from pin_metaik.optimize import Budget
from pin_metaik.optimize.ga import GA
from pin_metaik.watching import Progress

FEW = Budget(evaluations=600)
SCENES = [mobile.load_scene("ten_obstacles"), mobile.random_scene(6, 1, concave=1.0)]


@pytest.fixture(scope="module")
def comparison() -> compare.PlannerComparison:
    methods = {"exact": "exact", "grid": mobile.GridAStar(cells=30), "rrtstar": "rrtstar", "mine": GA(agents=20)}
    return compare.compare_planners(SCENES, methods, 2, via=3, budget=FEW, rng=5)


def test_every_planner_runs_on_every_scene_and_those_without_chance_once(comparison: compare.PlannerComparison) -> None:
    assert len(comparison.runs) == comparison.planned == 2 * (1 + 1 + 2 + 2)
    assert not comparison.partial
    for scene in comparison.problems:
        (exact,) = comparison.of(scene, "exact")
        assert exact.plan.gap == 0.0
        for method in ("grid", "rrtstar", "mine"):
            assert all(run.plan.gap is None or run.plan.gap >= -1e-9 for run in comparison.of(scene, method))


def test_a_run_is_what_plan_path_gives_with_its_seed(comparison: compare.PlannerComparison) -> None:
    run = comparison.of("ten_obstacles", "mine")[1]
    again = mobile.plan_path(SCENES[0], GA(agents=20), via=3, budget=FEW, rng=6)
    assert run.plan.seed == 6
    assert_array_equal(run.plan.path.points, again.path.points)


def test_the_table_has_a_row_for_each_scene_and_planner(comparison: compare.PlannerComparison) -> None:
    rows = comparison_table(comparison).rows
    assert [row[:3] for row in rows[:4]] == [
        ("ten_obstacles", "exact", 1),
        ("ten_obstacles", "grid", 1),
        ("ten_obstacles", "rrtstar", 2),
        ("ten_obstacles", "mine", 2),
    ]
    assert rows[0][4] == 0.0


def test_the_report_is_written_with_its_figures(comparison: compare.PlannerComparison, tmp_path: Path) -> None:
    files = write(tmp_path, "planners", ["# Planners"], sections(comparison), figures=True)
    names = {file.name for file in files}
    assert {"planners.md", "planners_runs.csv", "planners_paths.png", "planners_convergence.png"} <= names
    assert all(file.stat().st_size > 500 for file in files if file.suffix == ".png")
    assert (tmp_path / "planners_runs.csv").read_text().count("\n") == 1 + len(comparison.runs)


def test_a_watch_and_control_c_keep_what_is_done() -> None:
    stopped = compare.compare_planners(SCENES, ["rrt"], 5, budget=FEW, watch=lambda at: at.done >= 3)
    assert (len(stopped.runs), stopped.planned) == (3, 10)
    assert stopped.partial

    def press(at: Progress) -> None:
        if at.done >= 2:
            raise KeyboardInterrupt

    with pytest.raises(Interrupted) as stop:
        compare.compare_planners(SCENES, ["rrt"], 5, budget=FEW, watch=press)
    assert len(stop.value.result.runs) == 2


def test_control_c_before_the_first_run_carries_a_comparison_without_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    def pressed(*_: object, **__: object) -> None:
        raise Interrupted("a plan")

    monkeypatch.setattr(mobile, "plan_path", pressed)
    with pytest.raises(Interrupted) as stop:
        compare.compare_planners(SCENES, ["rrt"], 5, budget=FEW)
    assert stop.value.result.runs == ()
    assert comparison_table(stop.value.result).rows == []


def test_what_cannot_be_compared_is_told() -> None:
    with pytest.raises(UnknownName, match="rrtstar"):
        compare.compare_planners(SCENES, ["rrtstr"], 1)
    with pytest.raises(InvalidSetting, match="at least one planner"):
        compare.compare_planners(SCENES, {}, 1)
    with pytest.raises(InvalidSetting, match="name of its own"):
        compare.compare_planners([SCENES[0], SCENES[0]], ["exact"], 1)
    with pytest.raises(InvalidSetting, match="problems"):
        compare.compare_planners(3, ["exact"], 1)
    wall = mobile.Scene((1.0, 1.0), (4.0, 1.0), [[(2.0, -1.0), (3.0, -1.0), (3.0, 5.0), (2.0, 5.0)]], (0, 0, 5, 4))
    with pytest.raises(mobile.NoPath):
        compare.compare_planners(wall, ["exact"], 1)
