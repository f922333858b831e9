"""The two mobile papers run again, shortened: what their reports say must follow from what was measured."""

import dataclasses

import numpy as np
import pytest
from matplotlib.figure import Figure

from pin_metaik.compare.papers import PAPERS, Options, reproduce, trajectory_setup
from pin_metaik.compare.papers.claims import verdict
from pin_metaik.compare.papers.path_planning import SETTINGS, comparison
from pin_metaik.compare.papers.path_planning_setup import ExactTrial, HitTrial, PathTrial
from pin_metaik.compare.papers.trajectory_claims import claims
from pin_metaik.compare.papers.trajectory_setup import PRINTED, Lab, NetTrial, routes, stepped
from pin_metaik.compare.report.write import markdown
from pin_metaik.interrupts import kept
from pin_metaik.mobile import NOMAD_200
from pin_metaik.mobile.motion.turn import lead_time

PATHS, TRAJECTORY = PAPERS["path_planning"], PAPERS["trajectory"]


@pytest.fixture(scope="module")
def paths():
    return [job.work() for job in PATHS.jobs(Options(2))]


def test_the_path_paper_runs_every_method_on_every_scene(paths):
    trials = [trial for trial in paths if isinstance(trial, PathTrial)]
    assert len(trials) == 2 * 2 * 2 * len(SETTINGS) + 2 * 2
    assert all(trial.free == (trial.gap is not None) for trial in trials)
    assert all(trial.free for trial in trials if trial.f < 120)
    assert all(trial.f == pytest.approx(trial.length) for trial in trials if trial.f < 120)
    assert [trial.corners for trial in paths if isinstance(trial, ExactTrial)] == [2, 4, 1, 3]
    assert all(trial.missed == 0 for trial in paths if isinstance(trial, HitTrial))


def test_the_path_papers_report_has_its_tables_claims_and_figures(paths):
    sections = PATHS.sections(paths, Options(2))
    text = markdown(["# Paths"], sections, figures=True)
    assert "11.815274943" in text
    assert "0 of 4 runs end without a penalty" in text
    assert "| reproduces |" in text
    assert "median gap is smaller on" in text
    (_, table, _), *_ = (section.tables for section in sections)
    assert len(table.rows) == 2 * 2 * len(SETTINGS)
    for section in sections:
        for figure in section.figures:
            canvas = Figure(figsize=figure.size)
            figure.draw(canvas)
            assert canvas.axes


def test_the_path_papers_numbers_are_those_of_its_runs():
    def trial(run, f, gap):
        return PathTrial(
            "10 obstacles", "GA", "paper", run, f, f, gap is not None, gap, 0.25, np.zeros((2, 2)), np.ones((1, 2))
        )

    (row,) = comparison([trial(0, 12.0, 0.02), trial(1, 13.0, 0.1), trial(2, 500.0, None)]).rows
    assert row[3:] == pytest.approx((3, 200 / 3, 2.0, 6.0, 10.0, 13.0, 250.0))


def test_interrupted_experiments_report_on_what_there_is():
    for paper in (PATHS, TRAJECTORY):
        assert markdown([], paper.sections([], Options(1)), figures=True)


@pytest.mark.parametrize("paper", [PATHS, TRAJECTORY], ids=["paths", "trajectory"])
def test_ctrl_c_keeps_the_jobs_that_are_done(paper, monkeypatch):
    jobs = list(paper.jobs(Options(1, quick=True)))

    def some(options):
        yield from jobs[:3]

        def stop():
            raise KeyboardInterrupt

        yield type(jobs[0])("stop", stop)

    monkeypatch.setattr(trajectory_setup, "QUICK", 2)
    again = kept(lambda: reproduce(dataclasses.replace(paper, jobs=some), Options(1, quick=True)))
    assert again.partial
    assert again.done == 3
    assert again.sections


def test_the_trajectory_paper_runs_every_network_and_plans_with_them(monkeypatch):
    for name, value in (("QUICK", 15), ("CLUSTERING", 100), ("SCENES", 1)):
        monkeypatch.setattr(trajectory_setup, name, value)
    trained = [job.work() for job in TRAJECTORY.jobs(Options(1, quick=True))]
    nets = [trial for trial in trained if isinstance(trial, NetTrial)]
    assert {(t.net, t.trainer, t.points) for t in nets} >= set(PRINTED)
    assert all(t.n == 23621 and np.isfinite([t.E0, t.Em, t.F0, t.Fm, t.mse]).all() for t in nets)
    sections = TRAJECTORY.sections(trained, Options(1, quick=True))
    text = markdown(["# Trajectories"], sections, figures=True)
    assert "0.3517" in text
    plans = next(table for section in sections for table in section.tables if table.name == "trajectory_plans")
    assert {row[0] for row in plans.rows} == {"A, one corner", "B, three corners", "random 1"}
    for section in sections:
        for figure in section.figures:
            canvas = Figure(figsize=figure.size)
            figure.draw(canvas)
            assert canvas.axes


def test_the_claims_about_networks_are_counted_not_written():
    def net(net, trainer, points, E0):
        return NetTrial(net, trainer, points, "paper", 0, E0, 10 * E0, 3, E0 / 10, E0, 23621, E0 / 1e6, 10, 0.1)

    trials = [net(*key, 2.0 if key[2] == "grid" else 1.0) for key in PRINTED]
    clustering, trainers, errors, speed = claims(trials, [])
    assert clustering.verdict == "reproduces"
    assert clustering.because.startswith("in 8 of 8")
    assert "larger in 0 (in the table in 3)" in clustering.because
    assert (trainers.verdict, errors.verdict, speed.verdict) == ("does not reproduce", "in part", "not run")
    worse, *_ = claims([net(*key, 1.0 if key[2] == "grid" else 2.0) for key in PRINTED], [])
    assert worse.verdict == "does not reproduce"
    assert worse.because.startswith("in 0 of 8")


def test_a_verdict_needs_every_case():
    assert [verdict(cases) for cases in ([True, True], [True, False], [False], [])] == [
        "reproduces",
        "in part",
        "does not reproduce",
        "not run",
    ]


def test_integrating_a_turn_in_steps_gives_the_closed_form():
    rng = np.random.default_rng(0)
    v, theta = rng.uniform(0.1, 1, 20), rng.uniform(0.05, 2.6, 20)
    assert stepped(v, theta) == pytest.approx(v * lead_time(theta, NOMAD_200), rel=1e-5)


def test_a_tenth_of_the_clustering_goes_on_where_the_last_one_stopped(monkeypatch):
    monkeypatch.setattr(trajectory_setup, "CLUSTERING", 100)
    lab = Lab(Options(1, quick=True))
    lab.cluster()
    first = lab.clustered
    lab.cluster()
    assert first.shape == (1064, 2)
    assert not np.array_equal(first, lab.clustered)


def test_planned_routes_are_the_same_for_the_same_seed():
    one, same = routes(Options(1, rng=4)), routes(Options(1, rng=4))
    assert list(one) == ["A, one corner", "B, three corners", "random 1", "random 2", "random 3"]
    assert all(np.array_equal(one[name][0], same[name][0]) for name in one)
