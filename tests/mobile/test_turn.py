import dataclasses

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import cumulative_simpson

from pin_metaik.errors import InvalidGeometry, InvalidSetting, UnknownName
from pin_metaik.mobile import NOMAD_200, Path, Route, SynchroDrive, load_vehicle
from pin_metaik.mobile.motion.straight import straight_phases, straight_time
from pin_metaik.mobile.motion.timing import drive
from pin_metaik.mobile.motion.turn import clothoid, cut_time, lead_time, turn_phases, turn_shape, turn_time

SLOWER = dataclasses.replace(NOMAD_200, alpha_max=np.radians(30))
TABLE = [  # robot, theta in degrees, g, e, T in s
    (NOMAD_200, 5, 0.316368350514, 0.004603102126, 0.632455532034),
    (NOMAD_200, 20, 0.637005485343, 0.037281174229, 1.264911064067),
    (NOMAD_200, 40.5, 0.927591179959, 0.112009650478, 1.8),
    (NOMAD_200, 60, 1.198473838703, 0.227442522284, 2.233333333333),
    (NOMAD_200, 90, 1.747761598236, 0.564713120436, 2.9),
    (NOMAD_200, 120, 2.699155905722, 1.326018041350, 3.566666666667),
    (NOMAD_200, 150, 5.298413491807, 3.748140518419, 4.233333333333),
    (SLOWER, 30, 1.016436574711, 0.089903557680, 2.0),
    (SLOWER, 67.5, 1.640753644011, 0.345538635024, 3.0),
]


@pytest.mark.parametrize(("vehicle", "degrees", "g", "e", "T"), TABLE)
def test_the_closed_forms_have_their_tabulated_values(vehicle, degrees, g, e, T):
    theta = np.radians(degrees)
    # The table has twelve decimals, which is more than nine digits of all but its smallest entries.
    assert lead_time(theta, vehicle) == pytest.approx(g, rel=1e-9, abs=1e-12)
    assert cut_time(theta, vehicle) == pytest.approx(e, rel=1e-9, abs=1e-12)
    assert turn_time(theta, vehicle) == pytest.approx(T, rel=1e-9, abs=1e-12)


def random_turns(count):
    rng = np.random.default_rng(0)
    for _ in range(count):
        limits = rng.uniform((0.3, 0.3, 0.2, 0.2), (2, 2, 2, 3))
        yield SynchroDrive("any", *limits, 0.2), rng.uniform(0.01, 2.9), rng.uniform(0.05, limits[0])


def test_the_curve_meets_the_outgoing_line_where_the_closed_form_says():
    for vehicle, theta, v in random_turns(40):
        t = np.linspace(0, float(turn_time(theta, vehicle)), 20_001)
        rate = np.minimum(np.minimum(t, t[-1] - t) * vehicle.alpha_max, vehicle.omega_max)
        heading = cumulative_simpson(rate, x=t, initial=0)
        x, y = (np.trapezoid(v * f(heading), t) for f in (np.cos, np.sin))
        alpha = v * lead_time(theta, vehicle)
        assert_allclose((x, y), alpha * np.array((1 + np.cos(theta), np.sin(theta))), atol=1e-6)
        assert heading[-1] == pytest.approx(theta, abs=1e-6)


def test_the_tangent_length_of_a_driven_curve_is_linear_in_its_speed():
    for vehicle, theta, _ in random_turns(20):
        room = 10 + 2 * vehicle.v_max * float(lead_time(theta, vehicle))  # to get to full speed before the curve
        route = Route.along(Path([(-room, 0), (0, 0), (room * np.cos(theta), room * np.sin(theta))]), vehicle)
        per_speed = []
        for v in np.linspace(0.3, 1, 7)[:, None] * vehicle.v_max:
            trajectory = drive(route, v)
            turning = next(i for i, phase in enumerate(trajectory.phases) if not phase.straight)
            (begin,) = trajectory.at(trajectory.boundaries[turning]).xy
            per_speed.append(-begin[0] / v[0])
        assert_allclose(per_speed, lead_time(theta, vehicle), rtol=1e-12)


def test_the_shape_begins_and_ends_on_the_lines_and_is_cut_at_its_middle():
    for vehicle, theta, _ in random_turns(40):
        g, e = lead_time(theta, vehicle), cut_time(theta, vehicle)
        shape = turn_shape(theta, vehicle)
        assert_allclose(shape[0], (-g, 0), atol=1e-12)
        assert_allclose(shape[-1], (g * np.cos(theta), g * np.sin(theta)), atol=1e-9 * (1 + g))
        middle = shape[len(shape) // 2]
        assert np.hypot(*middle) == pytest.approx(float(e), rel=1e-7)
        assert np.hypot(*shape.T).min() == pytest.approx(float(e), rel=1e-7)


def test_small_turns_and_the_saturation_angle_are_no_seams():
    assert lead_time(0.0, NOMAD_200) == cut_time(0.0, NOMAD_200) == turn_time(0.0, NOMAD_200) == 0
    for f in (lead_time, cut_time, turn_time):
        assert f(1e-12, NOMAD_200) < 1e-5
        s = NOMAD_200.saturation
        assert f(s * (1 - 1e-13), NOMAD_200) == pytest.approx(float(f(s * (1 + 1e-13), NOMAD_200)), abs=1e-9)


@pytest.mark.parametrize("theta", [np.pi, 4.0, -0.1, np.nan, [0.5, np.pi]])
def test_a_turn_of_half_a_circle_has_no_tangent(theta):
    for f in (lead_time, cut_time):
        with pytest.raises(InvalidGeometry, match="180 degrees"):
            f(theta, NOMAD_200)


def test_near_half_a_circle_the_tangent_runs_away_but_stays_finite():
    g = lead_time(np.pi - np.geomspace(1, 1e-9, 10), NOMAD_200)
    assert np.isfinite(g).all()
    assert (np.diff(g) > 0).all()
    assert g[-1] > 1e8


def test_turn_phases_turn_by_the_angle_in_the_time():
    for vehicle, theta, _ in random_turns(20):
        for signed in (theta, -theta):
            heading = omega = 0.0
            for duration, alpha in turn_phases(signed, vehicle):
                heading += omega * duration + alpha * duration**2 / 2
                omega += alpha * duration
                assert abs(omega) <= vehicle.omega_max + 1e-12
            assert heading == pytest.approx(signed, rel=1e-12)
            assert omega == pytest.approx(0, abs=1e-12)
            total = sum(duration for duration, _ in turn_phases(signed, vehicle))
            assert total == pytest.approx(float(turn_time(signed, vehicle)), rel=1e-12)


def test_the_clothoid_equals_its_integral():
    rng = np.random.default_rng(1)
    for _ in range(30):
        theta, omega, alpha, T = rng.uniform((-3, -2, -2, 0.1), (3, 2, 2, 3))
        for w, a in ((omega, alpha), (omega, 0.0), (0.0, alpha), (0.0, 0.0)):
            t = np.linspace(0, T, 20_001)
            z = np.trapezoid(np.exp(1j * (theta + w * t + a * t**2 / 2)), t)
            assert complex(clothoid(theta, w, a, T)) == pytest.approx(z, abs=1e-7)


@pytest.mark.parametrize(
    ("L", "v0", "v1", "T"),
    [(0.5, 0, 0, 1.620083923), (1, 0, 0, 2.291144655), (3, 0, 0, 4.286089239), (2, 0.3, 0.7, 2.364085395)],
)
def test_straights_take_their_tabulated_time(L, v0, v1, T):
    assert straight_time(L, v0, v1, NOMAD_200) == pytest.approx(T, abs=1e-9)
    phases = straight_phases(L, v0, v1, NOMAD_200)
    assert sum(t for t, _ in phases) == pytest.approx(T, abs=1e-9)


def test_a_straight_too_short_to_change_speed_has_no_time():
    needed = (0.7**2 - 0.3**2) / (2 * NOMAD_200.a_max)
    times = straight_time([needed * 0.999, needed, 0.0], [0.3, 0.3, 0.0], [0.7, 0.7, 0.0], NOMAD_200)
    assert_allclose(times, [np.inf, 0.4 / NOMAD_200.a_max, 0], rtol=1e-9)


def test_vehicles_are_found_by_name_and_have_sound_limits():
    assert load_vehicle("nomad200") == NOMAD_200
    assert pytest.approx(1.016) == NOMAD_200.v_max
    assert np.degrees(NOMAD_200.saturation) == pytest.approx(40.5)
    assert np.degrees(load_vehicle("nomad200_driver").saturation) == pytest.approx(67.5)
    with pytest.raises(UnknownName, match="nomad200, nomad200_driver"):
        load_vehicle("nomad")
    for wrong in ({"v_max": 0}, {"a_max": np.nan}, {"omega_max": np.inf}, {"radius": -1}):
        with pytest.raises(InvalidSetting):
            dataclasses.replace(NOMAD_200, **wrong)


def test_a_vehicle_from_a_file_is_the_nomad_but_for_what_the_file_says(tmp_path):
    file = tmp_path / "mine.json"
    file.write_text('{"v_max": 0.508, "alpha_max": 0.5}')
    assert load_vehicle(file) == dataclasses.replace(NOMAD_200, name="mine", v_max=0.508, alpha_max=0.5)
    for text, said in (
        ("{", "not JSON"),
        ("[1]", "is not a vehicle: expected an object with v_max"),
        ('{"v": 1}', "unknown key 'v'; known: name, v_max"),
        ('{"v_max": "fast"}', "v_max must be a number, not 'fast'"),
        ('{"v_max": -1}', "v_max must be a finite number above 0"),
    ):
        file.write_text(text)
        with pytest.raises(InvalidSetting, match=said):
            load_vehicle(file)
    with pytest.raises(InvalidSetting, match="cannot read"):
        load_vehicle(tmp_path / "gone.json")
