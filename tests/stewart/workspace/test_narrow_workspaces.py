"""Workspaces however narrow: the box they lie in, the cells that carry their figures, and designs that live on them."""

import pickle
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from pin_metaik.stewart import (
    DesignTask,
    EmptyWorkspace,
    Geometry,
    Grid,
    LegLimits,
    Mechanism,
    PoseState,
    Ranges,
    design,
    leg_lengths,
    load_mechanism,
    pose_at,
    standard_geometry,
    survey,
)
from pin_metaik.stewart.workspace.cells import room
from pin_metaik.stewart.workspace.surveying import LEAST
from tests.stewart.cases import reference

MM3 = 1e9


def reached_by(geometry, limits, P, R):
    """Which positions (k, 3) the lengths of the legs allow, in plain numpy."""
    d = np.linalg.norm(P[:, None] + geometry.m @ R.T - geometry.b, axis=2)
    return ((d >= limits.shortest) & (d <= limits.longest)).all(axis=1)


def volume_by_plain_grid(geometry, limits, low, high, count=60):
    """Volume in m^3 of the level workspace on a grid of our own, over a box that holds it."""
    centres = [a + (np.arange(count) + 0.5) * (b - a) / count for a, b in zip(low, high, strict=True)]
    P = np.stack(np.meshgrid(*centres, indexing="ij"), axis=-1).reshape(-1, 3)
    inside = reached_by(geometry, limits, P, np.eye(3))
    shell = P[inside]
    assert (shell.min(axis=0) > low).all()
    return inside.sum() * np.prod((np.array(high) - low) / count)


def random_platform(rng):
    kind = rng.choice(["6x6", "3x3", "6x3", "4x4", "5x4", "3x6"])
    geometry = standard_geometry(str(kind), *rng.uniform(0.1, 0.5, 2), split=rng.uniform(0.05, 0.5))
    stroke = 0.4 * 10 ** rng.uniform(-2.5, -0.3)
    return geometry, LegLimits(0.4 - stroke / 2, 0.4 + stroke / 2)


@pytest.mark.parametrize(
    ("stroke", "volume", "gdi"),
    [(0.12, 3.242e6, 0.6710), (0.02, 14760, 0.6788), (0.01, 1844, 0.6789), (0.005, 230.5, 0.6789)],
)
def test_the_reference_is_measured_at_every_stroke(stroke, volume, gdi):  # N1
    found = survey(reference().geometry, LegLimits(0.41 - stroke / 2, 0.41 + stroke / 2))
    assert_allclose(MM3 * found.volume, volume, rtol=0.003)
    assert_allclose(found.gdi, gdi, atol=0.0005)
    assert found.cells_reached > 10 * LEAST


def test_a_camera_hexapod_of_a_few_millimetres_is_measured():
    """Nearly equal circles, joints in pairs, legs of half a metre that move by 28 mm."""
    base = np.radians([-15, 15, 105, 135, 225, 255])
    platform = np.radians([-45, 45, 75, 165, 195, 285])
    geometry = Geometry(0.692250, 0.697044, base, platform, tuple((i, i) for i in range(6)))
    limits = LegLimits(0.492963 - 0.0141, 0.492963 + 0.0141)
    found = survey(geometry, limits)
    low, high = found.positions.min(axis=0), found.positions.max(axis=0)
    aside = 0.04 * (high - low)
    plain = volume_by_plain_grid(geometry, limits, low - aside, high + aside, 80)
    assert_allclose(found.volume, plain, rtol=0.015)
    assert found.cells_reached > 10 * LEAST


def test_the_camera_hexapod_of_the_rubin_observatory_has_its_workspace():  # N2
    mechanism = load_mechanism("rubin_camera")
    assert_allclose(leg_lengths(mechanism.geometry, pose_at((0, 0, -2.7584))).mean(), 0.492963, atol=1e-6)
    assert_allclose(1e6 * mechanism.survey().volume, 31.80, rtol=0.005)  # cm3


def test_the_box_holds_what_the_lengths_allow_and_no_more():
    rng = np.random.default_rng(0)
    touched = []
    for k in range(40):
        geometry, limits = random_platform(rng)
        grid = Grid(roll=(r := rng.uniform(-0.3, 0.3), r), pitch=(p := rng.uniform(-0.3, 0.3), p)) if k % 2 else Grid()
        R = grid.rotations[0]
        spheres = geometry.b - geometry.m @ R.T
        box = room(grid, geometry, limits)
        low, high = spheres.max(axis=0) - limits.longest, spheres.min(axis=0) + limits.longest
        low[2] = max(low[2], spheres[:, 2].max())
        if box is not None:
            aside = 0.3 * np.ptp(box, axis=0)
            low, high = np.maximum(low, box[0] - aside), np.minimum(high, box[1] + aside)
        if not (low < high).all():
            assert box is None
            continue
        P = rng.uniform(low, high, (100_000, 3))
        P = P[reached_by(geometry, limits, P, R)]
        if box is None:
            assert not len(P)
        elif len(P) > 1000:
            assert (box[0] - 1e-12 <= P).all()
            assert (box[1] + 1e-12 >= P).all()
            slack = np.maximum(P.min(axis=0) - box[0], box[1] - P.max(axis=0)) / np.ptp(box, axis=0)
            touched.append(slack.max())
    assert len(touched) > 15
    assert max(touched) < 0.2  # what a sample of some thousand leaves at a corner


def test_ranges_that_are_given_cut_the_box():
    geometry, limits = reference().geometry, LegLimits(0.35, 0.47)
    whole = room(Grid(), geometry, limits)
    half = room(Grid(x=(0.0, 1.0)), geometry, limits)
    assert_allclose(half[0, 0], 0.0, atol=1e-12)
    assert_allclose(half[1, 0], whole[1, 0], rtol=1e-12)
    thin = room(Grid(x=(0.05, 0.05), y=(0.02, 0.02)), geometry, limits)
    assert_allclose(thin[:, :2], [[0.05, 0.02]] * 2, atol=1e-12)
    d = np.linalg.norm(thin[0] + geometry.m - geometry.b, axis=1)
    assert_allclose(min(d.min() - 0.35, 0.47 - d.max()), 0.0, atol=1e-9)
    assert room(Grid(z=(2.0, 3.0)), geometry, limits) is None


@pytest.mark.parametrize(
    "limits",
    [
        LegLimits(0.35, 0.47, base_angle=0.45),
        LegLimits(0.35, 0.47, platform_angle=0.5),
        LegLimits(0.35, 0.47, distance=0.041),
        LegLimits(0.35, 0.47, base_angle=0.06, platform_angle=0.06, home=(0.02, 0.0, 0.37)),
    ],
)
def test_the_room_that_joints_and_distances_leave_holds_all_that_is_reached(limits):
    geometry = reference().geometry
    lengths = room(Grid(), geometry, LegLimits(0.35, 0.47))
    box = room(Grid(), geometry, limits)
    fine = survey(geometry, limits, Grid((70, 70, 70), *map(tuple, lengths.T)))
    cell = np.ptp(lengths, axis=0) / 70
    assert (fine.positions >= box[0] - 1e-12).all()
    assert (fine.positions <= box[1] + 1e-12).all()
    assert (np.ptp(box, axis=0) <= 1.5 * np.ptp(fine.positions, axis=0) + 2 * cell).all()
    found = survey(geometry, limits)
    assert found.cells_reached >= LEAST
    assert_allclose(found.volume, fine.volume, rtol=0.1)


def test_too_few_cells_are_made_more():
    geometry, limits = reference().geometry, LegLimits(0.35, 0.47)
    found = survey(geometry, limits, Grid((4, 4, 4)))
    assert found.cells_reached >= LEAST
    assert_allclose(1e6 * found.volume, 3.242e3, rtol=0.02)
    flat = survey(geometry, limits, Grid((4, 4, 1)))
    assert flat.cells.shape[2] == 1
    assert flat.cells_reached >= LEAST
    by_hand = survey(geometry, limits, Grid((4, 4, 4), (-0.1, 0.1), (-0.1, 0.1), (0.3, 0.45)))
    assert by_hand.cells.shape == (4, 4, 4, 1)  # a grid that is given whole is taken as it is
    tilted = survey(geometry, limits, Grid((4, 4, 4), steps=(3, 1, 1), roll=(-0.1, 0.1)))
    assert tilted.cells_reached >= LEAST


def test_an_empty_workspace_is_proved_or_said_to_be_between_the_poses():
    geometry = reference().geometry
    with pytest.raises(EmptyWorkspace, match="the workspace is empty") as proved:
        survey(geometry, LegLimits(0.01, 0.02))
    assert proved.value.room is None
    ranges = (-0.1, 0.1), (-0.1, 0.1), (0.3, 0.45)
    with pytest.raises(EmptyWorkspace, match=r"no pose of the grid is within the limits.*finer grid at x ") as missed:
        survey(geometry, LegLimits(0.4085, 0.4115), Grid((6, 6, 6), *ranges))
    assert missed.value.reasons[PoseState.TOO_LONG] > 0
    box = missed.value.room
    assert survey(geometry, LegLimits(0.4085, 0.4115), Grid((40, 40, 40), *map(tuple, box.T))).volume > 0
    again = pickle.loads(pickle.dumps(missed.value))
    assert str(again) == str(missed.value)


def test_legs_without_stroke_leave_room_for_a_point():
    geometry = reference().geometry
    length = leg_lengths(geometry, pose_at((0, 0, 0.37)))[0]
    assert_allclose(room(Grid(), geometry, LegLimits(length, length)), [[0, 0, 0.37]] * 2, atol=1e-7)


@pytest.mark.parametrize(
    ("kind", "radius", "span", "legs"),
    [
        ("6x6", 0.69, (0.3, 0.8), (0.488, 0.498)),
        ("6x6", 0.69, (0.3, 0.8), (0.492, 0.494)),
        ("3x3", 0.3, (0.15, 0.45), (0.396, 0.404)),
    ],
)
def test_a_design_is_as_large_as_a_fine_grid_round_it_says(kind, radius, span, legs):  # N4, N5
    task = DesignTask(Ranges(base_radius=span, platform_radius=span), evaluations=400, algorithm="pso")
    mechanism = Mechanism("narrow", standard_geometry(kind, radius, radius), LegLimits(*legs), task=task)
    found = design(mechanism)
    assert found.success
    geometry, limits = found.mechanism.geometry, found.mechanism.limits
    box = room(Grid(), geometry, limits)
    aside = 0.02 * np.ptp(box, axis=0)
    plain = volume_by_plain_grid(geometry, limits, box[0] - aside, box[1] + aside)
    assert_allclose(found.score.workspace, plain / (2 * limits.stroke) ** 3, rtol=0.03)


def test_a_grid_given_whole_is_made_finer_for_designs_too():
    ranges = Ranges(base_radius=(0.2, 0.3))
    wide = Grid((8, 8, 8), (-0.4, 0.4), (-0.4, 0.4), (0.2, 0.6))
    task = DesignTask(ranges, grid=wide, evaluations=60, algorithm="pso")
    found = design(replace(reference(), limits=LegLimits(0.4, 0.42), task=task))
    assert found.success
    geometry = found.mechanism.geometry
    plain = survey(geometry, LegLimits(0.4, 0.42))
    assert_allclose(found.score.workspace * 0.04**3, plain.volume, rtol=0.03)
