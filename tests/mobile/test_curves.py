"""Curves of bounded curvature against dense searches, and footprints against dense samples."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from pin_metaik.errors import InvalidGeometry, InvalidSetting
from pin_metaik.mobile import (
    Blocked,
    Curve,
    Footprint,
    Obstructed,
    PathProblem,
    curve_through,
    first_contact,
    plan_trajectory,
    random_scene,
    shortest_curve,
)
from pin_metaik.mobile.curves.shortest import shortest_words
from pin_metaik.mobile.curves.words import dubins_words, reeds_shepp_words
from pin_metaik.mobile.motion.trajectory import Phase, Trajectory
from tests.mobile.routes import planned

BENDS = {"L": 1, "S": 0, "R": -1}
GENERATORS = {False: dubins_words, True: reeds_shepp_words}


def driven(word, lengths):
    """Poses (n, 3) after a word with lengths (n,) each, for radius 1, from the origin; written down independently."""
    x, y, h = np.zeros((3, len(lengths[0])))
    for letter, s in zip(word, lengths, strict=True):
        bend = BENDS[letter]
        if bend:
            x = x + (np.sin(h + bend * s) - np.sin(h)) / bend
            y = y - (np.cos(h + bend * s) - np.cos(h)) / bend
        else:
            x, y = x + s * np.cos(h), y + s * np.sin(h)
        h = h + bend * s
    return np.column_stack((x, y, h))


def apart(a, b):
    """Differences (n, 3) of poses, headings in (-pi, pi]."""
    d = a - b
    d[:, 2] = (d[:, 2] + np.pi) % (2 * np.pi) - np.pi
    return np.abs(d)


def random_poses(count, size, seed):
    rng = np.random.default_rng(seed)
    return np.column_stack((rng.uniform(-size, size, (count, 2)), rng.uniform(-np.pi, np.pi, count)))


@pytest.mark.parametrize("reverse", [False, True])
def test_every_word_that_a_formula_yields_leads_to_the_goal(reverse):
    for size in (0.5, 5.0):
        goals = random_poses(500, size, 1)
        yielded = np.zeros(500, dtype=int)
        with np.errstate(invalid="ignore"):
            for word, lengths in GENERATORS[reverse](*goals.T):
                there = ~np.isnan(np.sum(lengths, axis=0))
                assert apart(driven(word, lengths), goals)[there].max(initial=0) < 1e-6
                yielded += there
                if not reverse:
                    assert all((length[there] >= 0).all() for length in lengths)
        assert (yielded >= 2).all()


@pytest.mark.parametrize("reverse", [False, True])
def test_no_random_drive_is_shorter_than_the_shortest(reverse):
    """75,000 drives of up to five pieces, many of them the shortest themselves."""
    rng = np.random.default_rng(2)
    attained = 0
    for _ in range(50):
        word = "".join(rng.choice(list("LSR"), size=rng.integers(2, 6)))
        lengths = rng.uniform(0, 1.6, (len(word), 1500)) * (rng.choice([-1, 1], size=(len(word), 1)) if reverse else 1)
        total = np.abs(lengths).sum(axis=0)
        _, found = shortest_words(np.zeros((1500, 3)), driven(word, lengths), 1.0, reverse)
        shortest = np.abs(found).sum(axis=1)
        assert (shortest <= total + 1e-9).all()
        attained += int((shortest >= total - 1e-9).sum())
    assert attained > 5000


def test_an_arc_beside_a_very_short_straight_is_no_full_circle():
    """Directions of what is 1e-5 long are known to 1e-11 only."""
    for arc in np.linspace(0.1, 1.5, 200):
        for straight in (1e-5, 1e-6):
            lengths = [np.array([arc]), np.array([straight])]
            _, found = shortest_words(np.zeros((1, 3)), driven("RS", lengths), 1.0, False)
            assert np.abs(found).sum() <= arc + straight + 1e-9


def dense_dubins(goal, count=20_000):
    """Least length of three pieces by trying every first arc: the last one follows, and sign changes tell the rest."""
    t = np.linspace(0, 2 * np.pi, count)
    x, y, phi = goal
    best = np.inf
    for first in (1, -1):
        c1 = first * 1j
        for last in (1, -1):  # arc, straight, arc
            c3 = x + 1j * y + last * 1j * np.exp(1j * phi)
            u = np.exp(1j * first * t)
            ahead = ((c3 - last * 1j * u) - (c1 - first * 1j * u)) / u
            rest = np.mod(last * (phi - first * t), 2 * np.pi)
            cross = ahead.imag
            hit = np.flatnonzero((cross[:-1] <= 0) != (cross[1:] <= 0))
            hit = hit[(ahead.real[hit] >= 0) & (np.abs(np.diff(rest))[hit] < 1)]
            best = min(best, (t[hit] + ahead.real[hit] + rest[hit]).min(initial=np.inf))
        c3 = x + 1j * y + first * 1j * np.exp(1j * phi)  # three arcs
        c2 = c1 - 2 * first * 1j * np.exp(1j * first * t)
        gap = np.abs(c3 - c2) - 2
        for i in np.flatnonzero((gap[:-1] <= 0) != (gap[1:] <= 0)):
            turned = np.angle((c3 - c2[i]) / (first * 1j))  # heading where the second arc ends
            middle = np.mod(first * (first * t[i] - turned), 2 * np.pi)
            best = min(best, t[i] + middle + np.mod(first * (phi - turned), 2 * np.pi))
    return best


def test_dubins_shortest_is_what_a_dense_search_finds():
    for goal in random_poses(60, 3.0, 3):
        found = shortest_curve((0, 0, 0), tuple(goal), 1.0).length
        assert found == pytest.approx(dense_dubins(goal), abs=5e-3)


def test_reversing_is_never_longer_and_the_way_back_is_as_long():
    for a, b in zip(random_poses(50, 2.0, 4), random_poses(50, 2.0, 5), strict=True):
        both = shortest_curve(tuple(a), tuple(b), 0.7, reverse=True)
        assert both.length <= shortest_curve(tuple(a), tuple(b), 0.7).length + 1e-9
        assert both.length == pytest.approx(shortest_curve(tuple(b), tuple(a), 0.7, reverse=True).length, abs=1e-9)
        assert apart(np.array([both.end]), b[None]).max() < 1e-9
    beside = shortest_curve((0, 0, 0), (0, 1, 0), 1.0, reverse=True)  # parking
    assert len(beside.cusps) >= 1
    assert beside.length < shortest_curve((0, 0, 0), (0, 1, 0), 1.0).length / 2


def test_a_curve_is_continuous_and_its_curvature_bounded():
    curve = shortest_curve((1, 2, 0.3), (2, 2.5, -2.0), 0.8, reverse=True)
    s = np.linspace(0, curve.length, 5001)
    poses = curve.poses(s)
    steps = np.hypot(*np.diff(poses[:, :2], axis=0).T)
    assert (steps <= s[1] + 1e-12).all()
    assert steps.sum() == pytest.approx(curve.length, abs=1e-3)  # at a cusp a chord is shorter
    assert np.abs(np.diff(poses[:, 2])).max() <= s[1] / 0.8 + 1e-9
    assert shortest_curve((1, 2, 3), (1, 2, 3), 1.0).length == 0
    assert_allclose(shortest_curve((1, 2, 3), (1, 2, 3), 1.0).poses([0.0, 1.0]), [(1, 2, 3)] * 2)
    with pytest.raises(InvalidSetting, match="turning_radius"):
        shortest_curve((0, 0, 0), (1, 1, 1), 0.0)
    with pytest.raises(InvalidSetting, match="lengths"):
        Curve((0, 0, 0), 1.0, "LS", (1.0,))


def test_curves_go_through_the_points_and_keep_the_footprint_clear():
    outline = Footprint.rectangle(0.7, 0.4, behind=0.2)
    for seed in (3, 4):
        scene = random_scene(10, seed, gap=1.0)
        path = PathProblem.of(scene, 0.3, 0.19).optimum
        curve = curve_through(path, 0.4, scene.obstacles, footprint=outline)
        assert path.length <= curve.length < 1.02 * path.length
        places = curve.poses(np.linspace(0, curve.length, 20_001))
        track = shapely.LineString(places[:, :2])
        assert max(track.distance(shapely.Point(point)) for point in path.points) < 1e-3
        assert np.abs(np.diff(places[:, 2])).max() <= curve.length / 20_000 / 0.4 + 1e-9
        assert shapely.distance(outline.at(places), shapely.union_all(scene.obstacles)).min() > 0


def test_headings_at_the_ends_are_kept_and_walls_are_named():
    curve = curve_through([(0, 0), (3, 0), (3, 3)], 0.5, start_heading=2.0, goal_heading=-1.0, reverse=True)
    assert curve.start[2] == 2.0
    assert apart(np.array([curve.end]), np.array([[3, 3, -1.0]])).max() < 1e-9
    wall = [[(2, -9), (2.2, -9), (2.2, 9), (2, 9)]]
    with pytest.raises(Obstructed, match="every curve that was tried meets an obstacle") as named:
        curve_through([(0, 0), (4, 0)], 0.5, wall, footprint=Footprint.rectangle(1.0, 0.4))
    assert isinstance(named.value, Blocked)
    assert named.value.point[0] == pytest.approx(2.0, abs=1e-5)


@settings(max_examples=40, deadline=None, derandomize=True)
@given(st.integers(0, 10**6))
def test_the_first_contact_is_where_dense_samples_have_it(seed):
    rng = np.random.default_rng(seed)
    outline = Footprint.rectangle(rng.uniform(0.2, 1.2), rng.uniform(0.1, 0.8), rng.uniform(0.0, 0.2))
    start, goal = random_poses(2, 2.0, seed)
    curve = shortest_curve(tuple(start), tuple(goal), rng.uniform(0.2, 1.0), reverse=bool(rng.integers(2)))
    obstacles = [shapely.Point(*rng.uniform(-3, 3, 2)).buffer(rng.uniform(0.02, 0.3), quad_segs=3) for _ in range(2)]
    contact = first_contact(curve, outline, obstacles)
    s = np.linspace(0, curve.length, 3001)
    gaps = shapely.distance(outline.at(curve.poses(s)), shapely.union_all(obstacles))
    if contact is None:
        assert (gaps > 0).all()
    else:
        assert (gaps[s < contact.s - 1e-5] > 0).all()
        at = outline.at(np.array([contact.pose]))[0]
        assert at.distance(obstacles[contact.obstacle]) <= 1e-6
        assert at.distance(shapely.Point(contact.point)) <= 1e-6


def test_a_thin_post_between_samples_is_met():
    """A rectangle passes it in a tenth of a millimetre; no sampling of the usual kind sees it."""
    curve = Curve((0, 0, 0), 1.0, "S", (10.0,))
    post = shapely.box(5.0, 0.1999, 5.0001, 0.3)
    contact = first_contact(curve, Footprint.rectangle(0.0, 0.4), [post])
    assert contact.s == pytest.approx(5.0, abs=2e-6)
    assert first_contact(curve, Footprint.rectangle(0.0, 0.3996), [post]) is None


def test_trajectories_turn_rectangles_on_the_spot_too():
    scene, path = planned(3)
    plan = plan_trajectory(path, obstacles=scene.obstacles)
    assert first_contact(plan.trajectory, Footprint.disc(plan.clearance - 1e-5), scene.obstacles) is None
    contact = first_contact(plan.trajectory, Footprint.disc(plan.clearance + 1e-3), scene.obstacles)
    at = plan.trajectory.at(contact.s)
    assert_allclose(contact.pose[:2], at.xy[0], atol=1e-9)
    turning = Trajectory([Phase(2.0, 0.0, 0.5)], (2.0, 0.0, 0.0))  # by 1 rad
    bar, post = Footprint.rectangle(1.0, 0.0), shapely.Point(2.3, 0.35)
    met = first_contact(turning, bar, [post])
    assert met.pose[2] == pytest.approx(np.arctan2(0.35, 0.3), abs=5e-6)
    assert first_contact(turning, Footprint.rectangle(0.9, 0.0), [post]) is None


def test_footprints_that_are_none_are_refused():
    with pytest.raises(InvalidGeometry):
        Footprint([[0, 0, 0]])
    with pytest.raises(InvalidSetting, match="around"):
        Footprint.disc(-0.1)
    with pytest.raises(InvalidSetting, match="tolerance"):
        first_contact(Curve((0, 0, 0), 1.0, "S", (1.0,)), Footprint.disc(0.1), [], 0.0)
