import dataclasses
import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose

from pin_metaik.errors import InvalidSetting, UnknownName
from pin_metaik.learn import OutsideTraining
from pin_metaik.mobile import NOMAD_200, learn_turn, plan_trajectory
from pin_metaik.mobile.motion.turn import lead_time
from pin_metaik.mobile.motion.turn_data import (
    chebyshev_points,
    clustered_points,
    coarse_grid,
    fine_grid,
    judging_points,
    random_points,
)
from pin_metaik.mobile.motion.turn_errors import turn_errors
from tests.mobile.routes import BOX, B, C


@pytest.fixture(scope="module")
def model():
    return learn_turn(NOMAD_200, iterations=150)


def test_the_data_sets_are_the_papers():
    fine, coarse, judged = (f(NOMAD_200) for f in (fine_grid, coarse_grid, judging_points))
    assert (len(fine), len(coarse), len(judged)) == (23779, 1064, 23621)
    v, theta = np.unique(fine[:, 0].round(9)), np.unique(np.degrees(fine[:, 1]).round(9))
    assert (len(v), len(theta)) == (79, 301)
    assert_allclose(v, 0.0127 * np.arange(2, 81), atol=1e-9)
    assert_allclose(theta, 0.5 * np.arange(301), atol=1e-9)
    v, theta = np.unique(coarse[:, 0].round(9)), np.unique(np.degrees(coarse[:, 1]).round(9))
    assert_allclose(v, 0.0762 * np.arange(14) + 0.0254, atol=1e-9)
    assert_allclose(theta, 2 * np.arange(76), atol=1e-9)


def test_other_ways_to_choose_points_choose_as_many_inside_the_same_range():
    fine = fine_grid(NOMAD_200)
    clusters = clustered_points(NOMAD_200, iterations=2, clusters=60)
    onwards = clustered_points(NOMAD_200, iterations=2, clusters=60, start=clusters.centres)
    assert onwards.objective[0] < clusters.objective[-1]
    for points in (random_points(NOMAD_200), chebyshev_points(NOMAD_200), onwards.centres):
        assert (points >= fine.min(axis=0) - 1e-12).all()
        assert (points <= fine.max(axis=0) + 1e-12).all()
    assert len(random_points(NOMAD_200)) == len(chebyshev_points(NOMAD_200)) == 1064


def test_the_logarithmic_design_is_better_than_the_papers_by_far(model):
    plain = learn_turn(NOMAD_200, design="paper", iterations=150).errors()
    errors = model.errors()
    assert errors.n == plain.n == 23621
    assert errors.E0 < 0.3
    assert errors.E0 < plain.E0 / 3


def test_errors_are_what_their_names_say():
    errors = turn_errors(np.array([1.1, 2.0, 3.6]), np.array([1.0, 2.0, 4.0]))
    assert dataclasses.astuple(errors) == pytest.approx((20 / 3, 10, 2, 100 * 0.5 / 3 / 4, 10, 3))


def test_a_plan_with_a_network_reports_its_errors_and_where_they_lead(model):
    plan = plan_trajectory(B, method="ann", model=model)
    exact = plan.v * plan.route.g
    turns = model.at(np.abs(plan.route.turns))
    lengths = turns.tangents(plan.v[None])[0]
    assert plan.learned.tangent_error == pytest.approx(np.abs(lengths - exact).max())
    assert 0 < plan.learned.tangent_error < 0.01
    # Executed with true turns, each straight is wrong by the errors at its ends: the end is their sum along the path.
    along = np.diff(plan.route.path.points, axis=0)
    along /= np.hypot(*along.T)[:, None]
    error = np.pad(lengths - exact, 1)
    miss = ((error[:-1] + error[1:])[:, None] * along).sum(axis=0)
    assert plan.end_error == pytest.approx(np.hypot(*miss), rel=1e-6)
    assert plan.success
    assert any("mm from the goal" in note for note in plan.notes)
    assert plan.time == pytest.approx(plan_trajectory(B).time, rel=0.01)


def test_a_network_that_makes_the_robot_cut_a_corner_is_no_success(model):
    plan = plan_trajectory(C, NOMAD_200, (BOX,), method="ann", model=model)
    assert plan.success is plan.collision_free
    assert plan.clearance >= NOMAD_200.radius - 2 * plan.learned.tangent_error


def test_outside_its_training_range_a_network_warns_and_stays_finite(model):
    assert_allclose(model.tangent([0.5, 0.0], [1.0, 1.0]), [0.5 * lead_time(1.0, NOMAD_200), 0], rtol=0.01)
    for v, theta in ((0.01, 1.0), (2.0, 1.0), (0.5, 0.001), (0.5, 3.0), (1e-300, 0.0)):
        with pytest.warns(OutsideTraining, match="error there is unknown"):
            assert np.isfinite(model.tangent(v, theta))
    for v, theta in ((-1, 1.0), (np.nan, 1.0), (0.5, np.pi), (0.5, np.nan)):
        with pytest.raises(InvalidSetting):
            model.tangent(v, theta)


def test_corners_outside_the_training_range_are_planned_with_the_closed_form_and_said_so(model):
    path = [(0, 0), (4, 0), (8, 0.02), (8, 4), (0, 3.9)]
    with pytest.warns(OutsideTraining, match=r"corner 1 \(0.286 degrees\)"):
        plan = plan_trajectory(path, method="ann", model=model)
    assert plan.learned.exact == (1,)
    assert any("corner 1 lies outside its training range" in note for note in plan.notes)
    assert np.isfinite(plan.trajectory.sample().table).all()


def test_a_network_is_for_one_robot_and_unknown_designs_are_named(model):
    other = dataclasses.replace(NOMAD_200, v_max=0.5)
    with pytest.raises(InvalidSetting, match="the network was learned for"):
        plan_trajectory(B, other, method="ann", model=model)
    with pytest.raises(UnknownName, match="known: log, paper"):
        learn_turn(NOMAD_200, design="square")


def test_without_a_network_one_is_learned():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        plan = plan_trajectory(B, method="ann")
    assert plan.learned.tangent_error < 0.005
