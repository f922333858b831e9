"""Planning from a state in motion: nothing jumps, no limit is exceeded, nothing is hit, and nothing is lost."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from pin_metaik.errors import InvalidSetting
from pin_metaik.mobile import (
    NOMAD_200,
    TURTLEBOT3_WAFFLE,
    Blocked,
    NoRoom,
    Scene,
    State,
    plan_in_motion,
    plan_trajectory,
    replan,
)
from pin_metaik.mobile.motion.joining import backwards, swings
from pin_metaik.mobile.motion.trajectory import Phase, Trajectory
from tests.mobile.routes import A, planned

STATES = ("x", "y", "heading", "v", "omega")


def check_motion(plan, start):
    """It begins in the state, keeps all limits, and its speeds have no jumps."""
    s, vehicle = plan.trajectory.sample(0.005), plan.route.vehicle
    assert_allclose([getattr(s, key)[0] for key in STATES], [getattr(start, key) for key in STATES], atol=1e-9)
    assert (s.v <= vehicle.v_max + 1e-9).all()
    assert s.v.min() >= -1e-9
    assert (np.abs(s.omega) <= vehicle.omega_at(s.v) + 1e-9).all()
    assert np.abs(s.a).max() <= vehicle.a_max + 1e-9
    assert np.abs(s.alpha).max() <= vehicle.alpha_max + 1e-9
    dt = np.diff(s.t)
    assert_allclose(np.diff(s.v), s.a[:-1] * dt, atol=1e-9)
    assert_allclose(np.diff(s.omega), s.alpha[:-1] * dt, atol=1e-9)
    assert plan.end_error < 1e-8


@pytest.mark.parametrize(("vehicle", "seed"), [(NOMAD_200, 3), (TURTLEBOT3_WAFFLE, 1)], ids=["nomad200", "waffle"])
def test_a_plan_stopped_at_any_time_is_planned_again_from_there_without_a_stop(vehicle, seed):
    scene, path = planned(seed)
    plan = plan_trajectory(path, vehicle, scene.obstacles)
    for t in plan.time * np.array([0.35, 0.8]):
        start = plan.trajectory.state(float(t))
        again = replan(scene, vehicle, start=start, paths=2)
        check_motion(again, start)
        assert again.success
        assert t + again.time <= 1.1 * plan.time


def test_a_robot_in_a_curve_of_an_unchanged_plan_drives_it_to_the_end():
    plan = plan_trajectory(A)
    turning = plan.trajectory.boundaries[[i for i, p in enumerate(plan.trajectory.phases) if p.alpha]]
    for t in (turning[0] + 0.3, turning[-1] + 0.4):
        again = plan_in_motion(A, start=plan.trajectory.state(float(t)), goal=None) if t < turning[-1] else None
        again = again or plan_in_motion([A[1], A[2]], start=plan.trajectory.state(float(t)))
        assert t + again.time <= plan.time + 1e-6 or t < turning[-1]
    last = plan_in_motion([A[1], A[2]], start=plan.trajectory.state(float(turning[0] + 0.3)))
    assert turning[0] + 0.3 + last.time == pytest.approx(plan.time, abs=1e-3)


def test_start_and_goal_have_the_heading_and_the_speed_that_were_asked_for():
    start, goal = State(0, 0, 1.0, 0.5, 0.2), State(3, 3, 0.3, 0.4)
    for path in (A, [A[0], A[2]]):
        plan = plan_in_motion(path, start=start, goal=goal)
        check_motion(plan, start)
        assert_allclose(plan.trajectory.end, goal.pose, atol=1e-9)
        assert plan.trajectory.state(plan.time).v == pytest.approx(0.4, abs=1e-9)
        assert plan.as_dict()["success"] is True
    turned = plan_in_motion(A, start=State(0, 0, -2.0), goal=State(3, 3, 3.0))  # from rest to rest
    assert_allclose(turned.trajectory.end, (3, 3, 3.0), atol=1e-9)
    check_motion(turned, State(0, 0, -2.0))


def test_an_obstacle_that_comes_up_on_the_way_is_driven_round_or_named():
    empty = Scene((0, 0), (8, 0), [], (-1, -3, 9, 3))
    plan = plan_trajectory([(0, 0), (8, 0)])
    start = plan.trajectory.state(2.0)
    blocked = Scene((0, 0), (8, 0), [[(5, -0.6), (6, -0.6), (6, 0.9), (5, 0.9)]], (-1, -3, 9, 3))
    round_it = replan(blocked, start=start)
    check_motion(round_it, start)
    assert round_it.success
    assert round_it.trajectory.sample().v[1:-1].min() > 0
    assert replan(empty, start=start).time == pytest.approx(plan.time - 2.0, abs=1e-6)
    wall = Scene((0, 0), (8, 0), [[(start.x + 0.4, -2), (start.x + 0.6, -2), (start.x + 0.6, 2), (start.x + 0.4, 2)]])
    with pytest.raises(NoRoom, match="braking ends at"):
        replan(wall, start=start)
    with pytest.raises(Blocked, match="the goal"):
        replan(Scene((0, 0), (5.5, 0), blocked.obstacles, (-1, -3, 9, 3)), start=start)


@pytest.mark.parametrize("wrong", [State(0, 0, 0, 2.0), State(0, 0, 0, 0.2, 3.0)])
def test_states_that_the_robot_is_never_in_are_refused(wrong):
    with pytest.raises(InvalidSetting, match="start"):
        plan_in_motion(A, start=wrong)
    with pytest.raises(InvalidSetting, match="the turning rate at the end is 0"):
        plan_in_motion(A, start=State(0, 0, 0), goal=State(3, 3, 0, 0, 0.1))
    with pytest.raises(InvalidSetting):
        State(0, 0, np.nan)


def test_a_way_driven_backwards_comes_from_where_it_went():
    phases = [Phase(1.0, 0.5), Phase(0.7, 0.0, 0.8), Phase(0.5, 0.0, -0.8, 0.56), Phase(0.3, -0.2)]
    there = Trajectory(phases, (1.0, 2.0, 0.5), 0.1)
    x, y, heading = there.end
    back = Trajectory(backwards(phases), (x, y, heading + np.pi), there.state(there.duration).v)
    assert_allclose(back.end, (1.0, 2.0, 0.5 + np.pi), atol=1e-12)


def test_turns_from_a_turning_rate_end_without_one_at_the_angle():
    angles = np.linspace(-7, 7, 57)
    for omega in (-0.7, 0.0, 0.3, 0.8):
        durations, alphas = swings(angles, omega, 0.8, 1.3)
        rate, turned = np.full(57, omega), np.zeros(57)
        for t, alpha in zip(durations.T, alphas.T, strict=True):
            turned, rate = turned + rate * t + alpha * t**2 / 2, rate + alpha * t
            assert (np.abs(rate) <= 0.8 + 1e-12).all()
        assert_allclose(turned, angles, atol=1e-12)
        assert_allclose(rate, 0, atol=1e-12)
