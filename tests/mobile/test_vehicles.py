"""Differential drives: what their wheels do, by integration of one's own."""

import json

import numpy as np
import pytest
import shapely
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp

from pin_metaik.errors import InvalidSetting
from pin_metaik.mobile import (
    TURTLEBOT3_BURGER,
    TURTLEBOT3_WAFFLE,
    DifferentialDrive,
    PathProblem,
    Route,
    SynchroDrive,
    load_vehicle,
    plan_trajectory,
    random_scene,
)
from pin_metaik.mobile.motion.speeds import optimal_speeds
from pin_metaik.mobile.motion.turn import lead_time, turn_shape
from tests.mobile.routes import A, B, C, planned

BOTS = (TURTLEBOT3_BURGER, TURTLEBOT3_WAFFLE)
SHARES = (0.3, 0.5, 0.7, 0.9)  # of a wheel's speed for driving on; the rest is for turning


def wheel_rates(plan, dt=0.01):
    """Speeds and accelerations of the two wheels, integrated from the phases alone."""
    track = plan.route.vehicle.track
    left = right = 0.0
    speeds, accelerations = [], []
    for phase in plan.trajectory.phases:
        a = np.array([phase.a - phase.alpha * track / 2, phase.a + phase.alpha * track / 2])
        t = np.linspace(0, phase.duration, max(2, int(phase.duration / dt)))
        speeds.append(np.array([left, right]) + t[:, None] * a)
        left, right = speeds[-1][-1]
        accelerations.append(a)
    return np.vstack(speeds), np.array(accelerations)


def scaled_down(bot, share):
    """The robot as a synchro-drive whose turning rate is scaled down until the wheels can do both at once."""
    turning = (1 - share) * bot.omega_max
    return SynchroDrive("scaled", share * bot.v_max, bot.a_max, turning, bot.alpha_max, bot.radius)


@pytest.mark.parametrize("bot", BOTS, ids=lambda bot: bot.name)
def test_no_wheel_is_asked_for_more_than_it_does_and_omega_scaled_down_is_slower(bot):
    for seed in range(8):
        scene = random_scene(10, seed, gap=2 * bot.radius + 0.6)
        path = PathProblem.of(scene, bot.radius, 0.1).optimum
        plan = plan_trajectory(path, bot, scene.obstacles)
        speeds, accelerations = wheel_rates(plan)
        assert np.abs(speeds).max() <= bot.wheel_speed + 1e-9
        assert np.abs(accelerations).max() <= bot.wheel_acceleration + 1e-9
        assert plan.success
        assert_allclose(speeds[-1], 0, atol=1e-9)
        assert plan.time < min(plan_trajectory(path, scaled_down(bot, s), scene.obstacles).time for s in SHARES)


def test_wheels_turned_as_planned_lead_to_the_goal():
    bot = TURTLEBOT3_BURGER
    plan = plan_trajectory(B, bot)
    state = np.array([*plan.trajectory.start, 0.0, 0.0])  # x, y, heading, left, right
    for phase in plan.trajectory.phases:
        left, right = bot.wheels(phase.a, phase.alpha)

        def rates(_, s, left=left, right=right):
            v, omega = (s[3] + s[4]) / 2, (s[4] - s[3]) / bot.track
            return [v * np.cos(s[2]), v * np.sin(s[2]), omega, left, right]

        state = solve_ivp(rates, (0, phase.duration), state, rtol=1e-10, atol=1e-11).y[:, -1]
    assert_allclose(state[:2], B[-1], atol=1e-6)


def test_a_data_sheets_two_numbers_at_once_would_ask_for_nearly_twice_the_wheels_speed():
    both = TURTLEBOT3_BURGER.wheels(0.22, 2.84)
    assert both.max() / 0.033 == pytest.approx(13.55, abs=0.01)  # rad/s; the wheels do 6.67
    assert TURTLEBOT3_BURGER.wheel_speed / 0.033 == pytest.approx(6.67, abs=0.01)
    assert TURTLEBOT3_BURGER.omega_max == pytest.approx(2.75)
    assert TURTLEBOT3_WAFFLE.omega_max == pytest.approx(1.82, abs=0.01)
    assert_allclose(TURTLEBOT3_BURGER.omega_at([0.0, 0.11]), [2.75, 1.375])


def test_curves_of_faster_drives_lie_outside_those_of_slower_ones():
    for theta in (0.2, 1.0, 2.0, 3.0):
        inner = shapely.Point(0, 0)
        for v in np.linspace(0.02, 0.21, 12):
            curve = v * turn_shape(theta, TURTLEBOT3_BURGER, v, 801)
            between = shapely.Polygon(np.vstack(([0, 0], curve)))
            assert between.buffer(1e-6).contains(inner)
            assert curve[0, 0] == pytest.approx(-v * float(lead_time(theta, TURTLEBOT3_BURGER, v)))
            inner = between


def test_no_random_choice_of_speeds_beats_dynamic_programming_on_wheels_either():
    for seed, bot in ((1, BOTS[0]), (3, BOTS[1])):
        scene, path = planned(seed)
        route = Route.along(path, bot, scene.obstacles)
        best = optimal_speeds(route)
        rng = np.random.default_rng(seed)
        anywhere = rng.random((5000, len(route.caps))) * route.caps
        nearby = np.clip(best.v + 0.003 * rng.standard_normal(anywhere.shape), 0, route.caps)
        assert min(route.times(anywhere).min(), route.times(nearby).min()) >= best.time - 1e-6
        assert route.times(best.v[None])[0] == pytest.approx(best.time, abs=1e-9)
        assert plan_trajectory(path, bot, scene.obstacles, method="de").time >= best.time - 1e-4


def test_a_differential_drive_of_ones_own_is_a_json_file(tmp_path):
    file = tmp_path / "agv.json"
    file.write_text(json.dumps({"track": 0.5, "wheel_speed": 1.2, "wheel_acceleration": 0.8, "radius": 0.4}))
    assert load_vehicle(file) == DifferentialDrive("agv", 0.5, 1.2, 0.8, 0.4)
    file.write_text(json.dumps({"track": 0.5, "wheel_speed": 1.2}))
    with pytest.raises(InvalidSetting, match="missing: wheel_acceleration, radius"):
        load_vehicle(file)
    with pytest.raises(InvalidSetting, match="track must be a finite number above 0"):
        DifferentialDrive("none", 0.0, 1.0, 1.0, 0.1)
    with pytest.raises(InvalidSetting, match="networks are learned for a SynchroDrive"):
        plan_trajectory(A, TURTLEBOT3_BURGER, method="ann")
    assert plan_trajectory(C, load_vehicle("turtlebot3_waffle")).route.vehicle is TURTLEBOT3_WAFFLE
