from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from pin_metaik.errors import InvalidBounds, InvalidGeometry, InvalidSetting
from pin_metaik.stewart import (
    Dexterity,
    EmptyWorkspace,
    Geometry,
    Grid,
    LegLimits,
    PoseState,
    Verdict,
    conditioning,
    judge_poses,
    leg_distances,
    leg_lengths,
    leg_vectors,
    standard_geometry,
    survey,
)
from tests.stewart.cases import STROKES, cube, reference, similar_hexagons, stroke

PAPER_GDI = {50: 0.918, 100: 0.829, 150: 0.821, 200: 0.784, 250: 0.785}
GDI = {50: 0.927, 100: 0.876, 150: 0.874, 200: 0.780, 250: 0.788}
GDI_TWO = {50: 0.559, 100: 0.475, 150: 0.475, 200: 0.356, 250: 0.367}
VOLUME = {50: 24.9, 100: 745, 150: 3465, 200: 7978, 250: 15451}  # cm3
GRID = Grid((60, 60, 60))


@pytest.mark.parametrize("mm", STROKES)
def test_dexterity_and_volume_of_the_printed_designs(mm):  # A6, A7
    mechanism = stroke(mm)
    found = survey(mechanism.geometry, mechanism.limits, GRID)
    assert_allclose(found.gdi, GDI[mm], rtol=0, atol=0.003)
    assert_allclose(1e6 * found.volume, VOLUME[mm], rtol=0.03 if mm == 50 else 0.015)
    assert (abs(found.gdi / PAPER_GDI[mm] - 1) < 0.015) == (mm in (50, 200, 250))  # the others are not reproduced
    assert found.verdict is Verdict.REGULAR
    finer = survey(mechanism.geometry, mechanism.limits, replace(GRID, counts=(120, 120, 120)))
    assert_allclose(finer.volume, found.volume, rtol=0.01)
    two = survey(mechanism.geometry, mechanism.limits, GRID, Dexterity("two"))
    assert_allclose(two.gdi, GDI_TWO[mm], rtol=0, atol=0.004)


def test_dexterity_and_volume_of_the_6x6_reference():  # A8
    mechanism = reference()
    found = survey(mechanism.geometry, mechanism.limits, Grid((100, 100, 100)))
    assert_allclose(1e6 * found.volume, 3245, rtol=0.01)
    assert_allclose(found.gdi, 0.6710, rtol=0, atol=0.002)
    two = survey(mechanism.geometry, mechanism.limits, GRID, Dexterity("two"))
    assert_allclose(two.gdi, 0.2906, rtol=0, atol=0.002)


def test_three_million_grid_points_have_the_known_figures():  # A15; how fast: benchmarks/stewart.py
    mechanism = stroke(100)
    grid = Grid((150, 150, 125), (-0.15, 0.15), (-0.15, 0.15), (0.1, 0.35))
    found = survey(mechanism.geometry, mechanism.limits, grid)
    assert abs(int(found.reached.sum()) - 93229) <= 2  # a point or two may lie on the border
    assert_allclose(1e6 * found.volume, 745.8, atol=0.1)
    assert_allclose(found.gdi, 0.8763, atol=5e-5)


HEXAPOD = (reference().geometry, Grid((6, 6, 6), (-0.1, 0.1), (-0.1, 0.1), (0.3, 0.42)))
OCTAHEDRON = (stroke(100).geometry, Grid((6, 6, 6), (-0.06, 0.06), (-0.06, 0.06), (0.2, 0.27)))


@pytest.mark.parametrize(
    ("platform", "limits"),
    [
        (HEXAPOD, LegLimits(0.35, 0.47)),
        (HEXAPOD, LegLimits(0.35, 0.47, base_angle=0.6)),
        (HEXAPOD, LegLimits(0.35, 0.47, platform_angle=0.7)),
        (HEXAPOD, LegLimits(0.35, 0.47, base_angle=0.25, platform_angle=0.3, home=(0.0, 0.0, 0.37))),
        (OCTAHEDRON, LegLimits(0.25, 0.35, distance=0.064)),
    ],
)
def test_the_survey_judges_as_numpy_does(platform, limits):
    geometry, grid = platform
    found = survey(geometry, limits, replace(grid, steps=(2, 1, 2), roll=(-0.2, 0.2), yaw=(-0.3, 0.3)))
    poses = found.poses(np.ones_like(found.reached))
    v, d = leg_vectors(geometry, poses), leg_lengths(geometry, poses)
    z = v / d[:, :, None]
    if limits.home is None:
        base, platform = np.array([0, 0, 1]), np.array([0, 0, -1])
    else:
        base = z_home = (np.array(limits.home) + geometry.m - geometry.b) / np.linalg.norm(
            np.array(limits.home) + geometry.m - geometry.b, axis=1, keepdims=True
        )
        platform = -z_home
    turned = np.broadcast_to(platform, (6, 3)) @ poses[:, :3, :3].transpose(0, 2, 1)
    allowed = ((d >= limits.shortest) & (d <= limits.longest)).all(axis=1)
    allowed &= (np.sum(z * base, axis=-1) >= np.cos(limits.base_angle)).all(axis=1)
    allowed &= (np.sum(-z * turned, axis=-1) >= np.cos(limits.platform_angle)).all(axis=1)
    allowed &= (leg_distances(geometry, poses) >= limits.distance).all(axis=1)
    assert 0 < allowed.sum() < len(allowed)
    assert_array_equal(found.reached.ravel(), allowed)
    assert_allclose(found.nu.ravel()[allowed], conditioning(geometry, poses[allowed]), rtol=1e-10)
    assert_array_equal(found.states.ravel(), judge_poses(geometry, limits, poses))
    forbidden = {state for state in found.counts if not state.reached}
    assert forbidden  # and each is named
    assert all(state.words for state in forbidden)


def test_tighter_limits_never_enlarge_the_workspace():
    geometry, loose = stroke(100).geometry, LegLimits(0.25, 0.35)
    cells = survey(geometry, loose, GRID).cells
    volume = survey(geometry, loose, cells).volume
    for change in ({"base_angle": 0.7}, {"platform_angle": 0.7}, {"distance": 0.064}, {"longest": 0.34}):
        assert 0 < survey(geometry, replace(loose, **change), cells).volume < volume


def test_orientations_include_both_ends_and_all_of_them_is_less_than_any():
    mechanism = reference()
    level = survey(mechanism.geometry, mechanism.limits, Grid((30, 30, 30)))
    tilting = survey(
        mechanism.geometry, mechanism.limits, Grid((30, 30, 30), steps=(3, 3, 1), roll=(-0.2, 0.2), pitch=(-0.2, 0.2))
    )
    assert_allclose(tilting.cells.rpy[0], [-0.2, -0.2, 0])
    assert_allclose(tilting.cells.rpy[-1], [0.2, 0.2, 0])
    assert tilting.volume_of_all < level.volume < tilting.volume
    assert 0 < tilting.orientations.max() <= 1


def test_the_orientation_workspace_at_one_position():
    mechanism = reference()
    grid = Grid.at((0.0, 0.0, 0.37), steps=(21, 21, 1), roll=(-0.6, 0.6), pitch=(-0.6, 0.6))
    found = survey(mechanism.geometry, mechanism.limits, grid)
    assert found.volume == 0.0
    assert found.orientations.shape == (1, 1, 1)
    assert 0 < found.orientations[0, 0, 0] < 1
    share = found.reached.reshape(21, 21)
    assert share[10, 10]  # level
    assert_array_equal(share, share[::-1])  # the mechanism is the same left and right


def test_an_empty_workspace_says_why():
    geometry = reference().geometry
    with pytest.raises(
        EmptyWorkspace, match=r"of 27 poses of the grid 27 are too far for a leg; move the grid"
    ) as caught:
        survey(geometry, LegLimits(0.35, 0.47), Grid((3, 3, 3), z=(2.0, 3.0), x=(0, 0.1), y=(0, 0.1)))
    assert caught.value.reasons == {PoseState.TOO_LONG: 27}
    assert issubclass(EmptyWorkspace, InvalidGeometry)
    with pytest.raises(EmptyWorkspace, match=r"too near for a leg|too far for a leg"):
        survey(geometry, LegLimits(0.01, 0.02), Grid((5, 5, 5)))


def test_a_singular_mechanism_has_a_verdict_and_no_number():
    found = survey(similar_hexagons(), LegLimits(0.35, 0.47), Grid((20, 20, 20)))
    assert found.verdict is Verdict.SINGULAR
    assert found.gdi is None
    assert found.volume > 0
    assert found.counts[PoseState.SINGULAR] == found.reached.sum()
    assert "no GDI" in str(found)


def test_singular_poses_are_left_out_of_the_mean_and_told():
    grid = Grid.at((0, 0, 0.09), steps=(1, 1, 3), yaw=(0, np.pi))  # an octahedron at 0, 90 and 180 degrees
    found = survey(cube(0.1), LegLimits(0.01, 1.0), grid)
    assert found.states.ravel()[1] == PoseState.SINGULAR
    assert found.verdict is Verdict.CROSSES_SINGULARITY
    assert_allclose(found.gdi, found.nu.ravel()[[0, 2]].mean())


def test_the_best_length_has_the_best_gdi():
    mechanism = stroke(200)
    grid = Grid((30, 30, 30))
    best = survey(mechanism.geometry, mechanism.limits, grid, Dexterity(length="best"))
    assert_allclose(best.gdi, 0.781, atol=0.003)
    assert_allclose(best.length, 0.0578, atol=0.001)
    for length in (0.95 * best.length, 1.05 * best.length):
        assert survey(mechanism.geometry, mechanism.limits, grid, Dexterity(length=length)).gdi < best.gdi


def test_lci_counts_only_poses_above_the_threshold():
    mechanism = stroke(100)
    found = survey(mechanism.geometry, mechanism.limits, GRID)
    volumes = [found.dexterous_volume(threshold) for threshold in (0.0, 0.85, 0.9, 0.999)]
    assert volumes[0] == found.volume
    assert sorted(volumes, reverse=True) == volumes
    assert volumes[0] > volumes[1] > volumes[2] > volumes[3] == 0.0


def test_ctrl_c_goes_through_with_what_was_seen():
    mechanism = reference()

    def press(at):
        if at.done > at.total / 2:
            raise KeyboardInterrupt

    grid = Grid((100, 60, 60))
    whole = survey(mechanism.geometry, mechanism.limits, grid)
    with pytest.raises(KeyboardInterrupt) as stop:
        survey(mechanism.geometry, mechanism.limits, grid, watch=press)
    part = stop.value.result
    assert whole.complete
    assert not part.complete
    assert 0 < part.volume < whole.volume
    seen = part.states != PoseState.UNSEEN
    assert_array_equal(part.nu[seen], whole.nu[seen])


def test_ctrl_c_before_anything_was_seen_goes_through():
    mechanism = reference()

    def press(at):
        raise KeyboardInterrupt

    grid = Grid((100, 60, 60), x=(-0.5, -0.4), y=(0, 0.1), z=(0.3, 0.4))
    with pytest.raises(KeyboardInterrupt):
        survey(mechanism.geometry, mechanism.limits, grid, watch=press)


def test_a_watch_ends_a_survey_that_says_so_whether_or_not_anything_was_reached():
    mechanism = reference()
    part = survey(mechanism.geometry, mechanism.limits, Grid((100, 60, 60)), watch=lambda at: at.done > at.total / 2)
    assert part.volume > 0
    assert not part.complete
    nowhere = Grid((100, 60, 60), x=(-0.5, -0.4), y=(0, 0.1), z=(0.3, 0.4))
    none = survey(mechanism.geometry, mechanism.limits, nowhere, watch=lambda at: True)
    assert not none.reached.any()
    assert not none.complete


def test_the_watch_hears_of_every_pose():
    heard = []
    mechanism = reference()
    survey(
        mechanism.geometry, mechanism.limits, Grid((100, 60, 60)), watch=lambda at: heard.append((at.done, at.total))
    )
    assert heard[-1] == (360_000, 360_000)
    assert len(heard) > 1


def test_open_ranges_hold_the_whole_workspace():
    for mechanism in (reference(), stroke(50), stroke(250)):
        tight = survey(mechanism.geometry, mechanism.limits, Grid((120, 120, 120)))
        side = 2 * mechanism.limits.longest
        wide = survey(
            mechanism.geometry, mechanism.limits, Grid((120, 120, 120), (-side, side), (-side, side), (0.0, side))
        )
        assert_allclose(wide.volume, tight.volume, rtol=0.25)  # its cells are coarse
        low, high = tight.positions.min(axis=0), tight.positions.max(axis=0)
        cell = np.array([2 * side, 2 * side, side]) / 120
        assert (wide.positions >= low - cell).all()
        assert (wide.positions <= high + cell).all()


def test_platforms_with_fewer_legs_have_workspaces_too():
    for legs in (3, 4, 5):
        found = survey(standard_geometry("3x3", 0.2, 0.1, legs=legs), LegLimits(0.25, 0.35), Grid((20, 20, 20)))
        assert found.volume > 0
        assert 0 < found.gdi < 1
        assert PoseState.NEGATIVE not in found.counts


@pytest.mark.parametrize(
    ("kind", "values", "error", "message"),
    [
        (LegLimits, (0.4, 0.3), InvalidGeometry, "the shortest leg, 0.4 m, is longer than the longest, 0.3 m"),
        (LegLimits, (0.0, 0.3), InvalidGeometry, "longer than zero"),
        (LegLimits, (0.1, np.inf), InvalidGeometry, "longest of the legs is a finite number"),
        (LegLimits, (0.1, 0.2, 0.0), InvalidGeometry, "base_angle lies above 0"),
        (LegLimits, (0.1, 0.2, 1.0, 4.0), InvalidGeometry, "platform_angle lies above 0 and up to pi"),
        (LegLimits, (0.1, 0.2, 1.0, 1.0, -0.1), InvalidGeometry, "not below zero"),
        (LegLimits, (0.1, 0.2, 1.0, 1.0, 0.0, (0, 1)), InvalidGeometry, "home is the position"),
        (Grid, ((4, 4),), InvalidBounds, "counts of a grid are three"),
        (Grid, ((4, 4, 0),), InvalidSetting, "counts of a grid must be a whole number"),
        (Grid, ((4, 4, 4), (1, 0)), InvalidBounds, "range of x is two finite numbers, the lower first, got 1 and 0"),
        (Grid, ((4, 4, 4), (0, np.nan)), InvalidBounds, "range of x"),
        (Grid, ((4, 4, 4), 3), InvalidBounds, "range of x is two numbers, got 3"),
    ],
)
def test_limits_and_grids_that_make_no_sense_are_refused(kind, values, error, message):
    with pytest.raises(error, match=message):
        kind(*values)


def test_a_home_at_which_a_leg_has_no_length_is_refused():
    geometry = Geometry(0.2, 0.1, (0.0, 2.0, 4.0), (0.0, 2.0, 4.0), ((0, 0), (1, 1), (2, 2)))
    home = tuple(geometry.b[1] - geometry.m[1])
    with pytest.raises(InvalidGeometry, match="leg 2 has no length at home"):
        survey(geometry, LegLimits(0.1, 0.3, base_angle=1.0, home=home))
