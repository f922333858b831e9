import warnings

import numpy as np
import pytest
import shapely
from numpy.testing import assert_allclose

from pin_metaik.errors import InvalidGeometry, InvalidSetting
from pin_metaik.mobile import NOMAD_200, Path, Route, fastest_trajectory, load_scene, plan_trajectory, random_scene
from pin_metaik.mobile.motion.speeds import optimal_speeds
from pin_metaik.mobile.motion.turn import cut_time
from tests.mobile.routes import BOX, A, B, C, planned

BEST = [  # path, obstacles, time, speeds
    (A, (), 6.643322, (1.016,)),
    (B, (), 10.715035, (0.78815, 0.78815, 1.016)),
    (C, (BOX,), 10.29176, (0.594435,)),
]
SEEDS = (1, 2, 3, 4, 5)  # with a way for the robot
IDS = ["A", "B", "C"]


@pytest.mark.parametrize(("path", "obstacles", "T", "v"), BEST, ids=IDS)
def test_dynamic_programming_finds_the_known_best_times_and_speeds(path, obstacles, T, v):
    plan = plan_trajectory(path, NOMAD_200, obstacles)
    assert plan.time == pytest.approx(T, abs=1e-3)
    assert_allclose(plan.v, v, atol=1e-3)
    assert plan.success


@pytest.mark.parametrize(("path", "obstacles", "T", "v"), BEST, ids=IDS)
def test_differential_evolution_comes_within_two_thousandths(path, obstacles, T, v):
    plan = plan_trajectory(path, NOMAD_200, obstacles, method="de", rng=1)
    assert plan.time == pytest.approx(T, rel=2e-3)
    assert np.array_equal(plan.v, plan_trajectory(path, NOMAD_200, obstacles, method="de", rng=1).v)


def test_the_largest_free_speed_at_a_corner_is_the_closed_form():
    route = Route.along(Path(C), NOMAD_200, (BOX,))
    q = np.hypot(0.4, 0.4)  # the box's corner from the path's
    cap = (q - NOMAD_200.radius) / cut_time(np.pi / 2, NOMAD_200)
    assert cap == pytest.approx(0.594435, abs=1e-6)
    assert route.caps[0] == pytest.approx(float(cap), abs=1e-4)
    assert route.caps[0] <= cap


def test_a_path_on_the_grown_obstacles_leaves_no_room_and_is_driven_with_stops():
    plan = plan_trajectory([(0, 0.4), (3.6, 0.4), (3.6, 4)], NOMAD_200, (BOX,), radius=0.0)
    assert plan.v[0] == plan.route.caps[0] == 0
    assert plan.time == pytest.approx(plan.stop_and_turn)
    assert plan.success
    assert any("no room to turn while moving at corner 1" in note for note in plan.notes)


@pytest.mark.parametrize("seed", SEEDS)
def test_times_lie_between_what_they_must(seed):
    scene, path = planned(seed)
    plan = plan_trajectory(path, NOMAD_200, scene.obstacles)
    assert path.length / NOMAD_200.v_max <= plan.time <= plan.stop_and_turn
    found = plan_trajectory(path, NOMAD_200, scene.obstacles, method="de")
    assert plan.time - 1e-6 <= found.time <= plan.time * 1.002


def test_no_random_choice_of_speeds_beats_dynamic_programming():
    for seed in SEEDS[:3]:
        scene, path = planned(seed)
        route = Route.along(path, NOMAD_200, scene.obstacles)
        best = optimal_speeds(route)
        rng = np.random.default_rng(seed)
        anywhere = rng.random((20_000, len(route.caps))) * route.caps
        nearby = np.clip(best.v + 0.01 * rng.standard_normal(anywhere.shape), 0, route.caps)
        assert min(route.times(anywhere).min(), route.times(nearby).min()) >= best.time - 1e-6
        assert route.times(best.v[None])[0] == pytest.approx(best.time, abs=1e-9)


SHARP = [[0, 0], [-1.1, 2.6], [-1.47, 0.64], [-1.89, 4.32]]  # corners that share a straight as short as it may be


def test_where_two_corners_share_a_straight_their_speeds_move_together():
    best, found = (plan_trajectory(SHARP, method=method) for method in ("dp", "de"))
    assert best.time == pytest.approx(15.445666, abs=1e-6)
    assert_allclose(best.v, 0.14463635, atol=1e-6)
    assert best.time <= found.time + 1e-6


def test_differential_evolution_beats_dynamic_programming_on_no_sharp_polyline():
    """Of 300 the benchmark tells."""
    rng = np.random.default_rng(1)
    for seed in range(15):
        corners = rng.integers(2, 5)
        path = np.vstack(((0, 0), rng.normal(0, 2, (corners + 1, 2)).cumsum(axis=0)))
        best, found = (plan_trajectory(path, method=method, rng=seed) for method in ("dp", "de"))
        assert best.time - found.time < 1e-4, seed


def test_a_dense_path_is_driven_quicker_when_simplified_and_the_plan_says_so():
    angle = np.linspace(0, 2 * np.pi, 300, endpoint=False)
    circle = Path(5 * np.column_stack((np.cos(angle), np.sin(angle))))
    zigzag = Path(0.05 * np.column_stack((np.arange(200), np.arange(200) % 2)))
    for path, share in ((circle, 1.15), (zigzag, 1.15)):
        dense = plan_trajectory(path)
        (said,) = (note for note in dense.notes if "simplified" in note)
        assert "path.simplified(0.05) has" in said
        simple = plan_trajectory(path.simplified(0.05))
        assert simple.time < share * path.length / NOMAD_200.v_max < dense.time / 2
        tube = shapely.LineString(path.points).buffer(0.05 + 1e-9)
        assert shapely.LineString(path.simplified(0.05).points).within(tube)
        assert not any("simplified" in note for note in simple.notes)
    with pytest.raises(InvalidSetting, match="deviation"):
        circle.simplified(-1)


def test_straight_paths_and_no_paths_at_all_have_trajectories():
    plan = plan_trajectory([(0, 0), (1, 0), (3, 0)])
    assert len(plan.v) == 0
    assert plan.time == pytest.approx(4.286089239)
    assert plan_trajectory([(0, 0), (3, 0)], method="de").time == pytest.approx(4.286089239)
    standing = plan_trajectory([(1, 2), (1, 2)])
    assert standing.time == 0
    assert standing.trajectory.end[:2] == (1, 2)


def test_nearly_turning_back_is_driven_with_a_stop_or_close_to_it_and_turning_back_is_refused():
    plan = plan_trajectory([(0, 0), (3, 0), (0, 1e-4)])
    assert plan.success
    assert plan.time <= plan.stop_and_turn + 1e-9
    with pytest.raises(InvalidGeometry, match=r"turns back by 180 degrees at \(3, 0\)"):
        plan_trajectory([(0, 0), (3, 0), (1, 0)])


def test_a_colliding_path_is_no_success_whatever_its_speeds():
    plan = plan_trajectory([(0, 1), (6, 1)], NOMAD_200, (BOX,))
    assert not plan.success
    assert plan.clearance == 0
    assert any("not a solution" in note for note in plan.notes)
    assert not plan_trajectory([(0, 1), (6, 1)], NOMAD_200, (BOX,), radius=0.0).success


@pytest.mark.parametrize("wrong", [{"method": "toppra"}, {"radius": -0.1}, {"radius": np.nan}])
def test_settings_that_make_no_sense_are_refused(wrong):
    with pytest.raises(InvalidSetting):
        plan_trajectory(A, **wrong)


@pytest.mark.parametrize("path", [[(0, 0)], [(0, 0, 0), (1, 1, 1)], [(0, np.nan), (1, 1)], "path"])
def test_what_is_no_path_is_refused(path):
    with pytest.raises(InvalidGeometry, match="a path is at least two points"):
        plan_trajectory(Path(path))


def test_the_fastest_of_several_paths_is_at_least_as_fast_as_the_shortest():
    scene = random_scene(15, 3, gap=0.75)
    best = fastest_trajectory(scene, margins=(0.1, 0.2), paths=3)
    _, path = planned(3)
    assert best.success
    assert best.time <= plan_trajectory(path, NOMAD_200, scene.obstacles).time
    with pytest.raises(InvalidSetting):
        fastest_trajectory(scene, margins=())


def test_the_fastest_path_names_what_blocks_it():
    from pin_metaik.mobile import Blocked

    with pytest.raises(Blocked):
        fastest_trajectory(load_scene("ten_obstacles"))


def test_an_interrupted_search_is_driven_with_its_best():
    heard = []

    def stop(at):
        heard.append(at)
        if len(heard) == 5:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt) as press:
        plan_trajectory(B, method="de", watch=stop)
    plan = press.value.result
    assert plan.interrupted
    assert plan.success
    assert plan.time <= plan.stop_and_turn
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert plan.as_dict()["success"] is True
