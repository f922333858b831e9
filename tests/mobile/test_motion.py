import csv
import json

import numpy as np
import pinocchio as pin
import pytest
import shapely
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp

from pin_metaik.errors import InvalidSetting
from pin_metaik.mobile import NOMAD_200, configurations, mobile_robot, plan_trajectory, velocities
from pin_metaik.mobile.motion.trajectory import Trajectory
from pin_metaik.optimize import Budget
from tests.mobile.routes import BOX, A, B, C, planned


def random_plan():
    scene, path = planned(3)
    return plan_trajectory(path, NOMAD_200, scene.obstacles)


PLANS = {
    "A": lambda: plan_trajectory(A),
    "B": lambda: plan_trajectory(B),
    "C": lambda: plan_trajectory(C, NOMAD_200, (BOX,)),
    "stops": lambda: plan_trajectory(B, method="de", budget=Budget(evaluations=30)),
    "random": random_plan,
}


@pytest.fixture(scope="module", params=PLANS)
def plan(request):
    return PLANS[request.param]()


def test_integrating_the_accelerations_leads_to_the_goal(plan):
    state = np.array([*plan.trajectory.start, 0.0, 0.0])  # x, y, heading, v, omega
    for phase in plan.trajectory.phases:

        def rates(_, s, phase=phase):
            return [s[3] * np.cos(s[2]), s[3] * np.sin(s[2]), s[4], phase.a, phase.alpha]

        state = solve_ivp(rates, (0, phase.duration), state, rtol=1e-10, atol=1e-10).y[:, -1]
    assert_allclose(state[:2], plan.route.path.points[-1], atol=1e-5)
    assert_allclose(state[3:], 0, atol=1e-9)
    assert plan.end_error < 1e-9


def test_no_limit_is_exceeded_and_curves_have_constant_speed(plan):
    s = plan.trajectory.sample(0.005)
    limits = plan.route.vehicle
    for values, limit in (
        (s.v, limits.v_max),
        (s.a, limits.a_max),
        (s.omega, limits.omega_max),
        (s.alpha, limits.alpha_max),
    ):
        assert np.abs(values).max() <= limit + 1e-9
    assert s.v.min() >= -1e-9
    turning = (s.alpha != 0) | (np.abs(s.omega) > 1e-9)
    assert (s.a[turning] == 0).all()
    assert (s.omega[~turning] < 1e-9).all()
    for phase in plan.trajectory.phases:
        assert phase.a == 0 or (phase.alpha == 0 and phase.omega == 0)


def test_speed_position_and_heading_fit_each_other_between_samples(plan):
    s = plan.trajectory.sample(0.001)
    dt = np.diff(s.t)
    assert_allclose(np.diff(s.v), s.a[:-1] * dt, atol=1e-9)
    assert_allclose(np.diff(s.omega), s.alpha[:-1] * dt, atol=1e-9)
    assert_allclose(np.diff(s.heading), (s.omega[:-1] + np.diff(s.omega) / 2) * dt, atol=1e-9)
    middle, v = (s.heading[:-1] + s.heading[1:]) / 2, (s.v[:-1] + s.v[1:]) / 2
    # The midpoint rule is wrong by about v omega^2 dt^3 / 24: 3e-11 m.
    assert_allclose(np.diff(s.x), v * np.cos(middle) * dt, atol=1e-9)
    assert_allclose(np.diff(s.y), v * np.sin(middle) * dt, atol=1e-9)


def test_the_whole_trajectory_keeps_the_radius(plan):
    if plan.obstacles:
        points = shapely.points(plan.trajectory.sample(0.002).xy)
        nearest = shapely.distance(points, shapely.union_all(plan.obstacles)).min()
        assert nearest >= plan.radius - 1e-6
        assert plan.clearance == pytest.approx(nearest, abs=1e-5)
        assert plan.clearance <= nearest + 1e-12
    assert plan.collision_free


def test_the_robot_stands_still_before_and_after(plan):
    s = plan.trajectory.at([-1.0, 0.0, plan.time, plan.time + 1])
    assert_allclose(s.v, 0, atol=1e-9)
    assert_allclose(s.xy[:2], [plan.route.path.points[0]] * 2)
    assert_allclose(s.xy[2:], [plan.route.path.points[-1]] * 2, atol=1e-9)


def test_samples_are_written_as_csv_and_json(plan, tmp_path):
    plan.trajectory.write_csv(tmp_path / "t.csv", dt=0.1)
    plan.trajectory.write_json(tmp_path / "t.json", dt=0.1)
    with (tmp_path / "t.csv").open() as file:
        rows = list(csv.DictReader(file))
    columns = json.loads((tmp_path / "t.json").read_text())
    assert list(rows[0]) == list(columns) == ["t", "x", "y", "heading", "v", "omega", "a", "alpha"]
    for name, values in columns.items():
        assert [float(row[name]) for row in rows] == values
    assert_allclose(np.diff(columns["t"]).max(), 0.1, atol=1e-9)
    assert json.loads(json.dumps(plan.as_dict(0.5), allow_nan=False))["time"] == plan.time


def test_a_trajectory_without_phases_stands_where_it_is():
    still = Trajectory([], (1, 2, 3))
    assert still.duration == 0
    assert still.end == (1, 2, 3)
    assert_allclose(still.sample().table, [[0, 1, 2, 3, 0, 0, 0, 0]])
    with pytest.raises(InvalidSetting):
        still.sample(0.0)


def test_pinocchio_moves_the_robot_as_the_trajectory_says(plan):
    robot = mobile_robot(NOMAD_200)
    model, data = robot.model, robot.model.createData()
    samples = plan.trajectory.sample(0.01)
    q, v = configurations(samples), velocities(samples)
    assert (model.nq, model.nv) == (4, 3)
    for i in range(0, len(samples.t) - 1, 7):
        pin.framesForwardKinematics(model, data, q[i])
        place = data.oMf[model.getFrameId(robot.frame)]
        assert_allclose(place.translation, [samples.x[i], samples.y[i], 0], atol=1e-12)
        assert_allclose(pin.log3(place.rotation), [0, 0, (samples.heading[i] + np.pi) % (2 * np.pi) - np.pi], atol=1e-9)
        dt = samples.t[i + 1] - samples.t[i]
        moved = pin.integrate(model, q[i], (v[i] + v[i + 1]) / 2 * dt)
        assert_allclose(moved, q[i + 1], atol=2e-6)  # a step of 10 ms with its mean velocity


def test_the_robot_has_a_body_of_its_radius():
    robot = mobile_robot(NOMAD_200)
    assert robot.collision_model.geometryObjects[0].geometry.radius == pytest.approx(NOMAD_200.radius)
    assert len(robot.visual_model.geometryObjects) == 2
