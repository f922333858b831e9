import numpy as np
import pinocchio as pin
from numpy.testing import assert_allclose

from pin_metaik.stewart import (
    Grid,
    LegLimits,
    Trajectory,
    Verdict,
    crossings,
    pose_at,
    singularities,
    standard_geometry,
    straight,
    survey,
)
from tests.stewart.cases import cube, reference, similar_hexagons

ANYWHERE = LegLimits(0.001, 10.0)


def test_turning_an_octahedron_crosses_its_singularity_at_90_degrees():
    (found,) = crossings(cube(0.1), straight(pose_at((0, 0, 0.1)), pose_at((0, 0, 0.1), (0, 0, 2.5)), 1.0))
    assert found.crosses
    assert_allclose(pin.rpy.matrixToRpy(found.pose[:3, :3])[2], np.pi / 2, atol=1e-9)


def test_a_sample_on_the_singularity_is_a_crossing_like_any_other():
    yaws = np.pi / 2 + np.array([-0.4, -0.2, 0.0, 0.2])
    (found,) = crossings(cube(0.1), Trajectory.through(np.arange(4), [pose_at((0, 0, 0.1), (0, 0, a)) for a in yaws]))
    assert found.crosses is True
    assert found.time == 2.0


def test_turning_to_the_singularity_and_back_touches_it():
    angles = np.pi / 2 - (np.linspace(-1, 1, 40)) ** 2  # no sample at the turning point
    way = Trajectory.through(np.linspace(0, 1, 40), [pose_at((0, 0, 0.1), (0, 0, angle)) for angle in angles])
    found = crossings(cube(0.1), way)
    assert not any(crossing.crosses for crossing in found)  # never beyond it
    exact = Trajectory.through([0, 1, 2], [pose_at((0, 0, 0.1), (0, 0, a)) for a in (1.0, np.pi / 2, 1.1)])
    (touch,) = crossings(cube(0.1), exact)
    assert not touch.crosses
    assert touch.time == 1.0


def test_fewer_legs_have_no_determinant_but_singular_poses_all_the_same():
    star = standard_geometry("3x3", 0.2, 0.1, legs=3)  # joint above joint: in the base's plane its legs meet in a point
    (found,) = crossings(star, straight(pose_at((0, 0, 0.1)), pose_at((0, 0, -0.15)), 1.0))
    assert not found.crosses
    assert_allclose(found.pose[2, 3], 0.0, atol=1e-7)


def test_a_way_without_singularities_has_none():
    assert crossings(reference().geometry, straight(pose_at((-0.05, 0, 0.36)), pose_at((0.05, 0.02, 0.4)), 1.0)) == []


def test_a_singular_mechanism_is_singular_all_along():
    found = crossings(similar_hexagons(), straight(pose_at((0, 0, 0.3)), pose_at((0, 0, 0.4)), 1.0, 5))
    assert len(found) == 5


def test_the_singular_surface_is_found_between_the_cells_of_a_workspace():
    grid = Grid((3, 3, 3), (-0.01, 0.01), (-0.01, 0.01), (0.08, 0.1), steps=(1, 1, 10), yaw=(0, 2.5))
    found = singularities(survey(cube(0.1), ANYWHERE, grid))
    assert found.verdict is Verdict.CROSSES_SINGULARITY
    yaw = [pin.rpy.matrixToRpy(pose[:3, :3])[2] for pose in found.crossings]
    assert len(yaw) >= 27  # over each position, and more where the surface slants
    half_a_step = 2.5 / 9 / 2
    assert np.abs(np.array(yaw) - np.pi / 2).max() < half_a_step + 0.2
    assert 0 < found.nu < 0.2


def test_a_regular_workspace_has_no_singularities_and_a_worst_pose():
    found = singularities(survey(reference().geometry, LegLimits(0.35, 0.47), Grid((20, 20, 20))))
    assert found.verdict is Verdict.REGULAR
    assert len(found.poses) == len(found.crossings) == 0
    assert 0.6 < found.nu < 0.65
    assert found.nearest.shape == (4, 4)


def test_every_pose_of_a_singular_mechanism_is_listed():
    workspace = survey(similar_hexagons(), LegLimits(0.35, 0.47), Grid((10, 10, 10)))
    found = singularities(workspace)
    assert found.verdict is Verdict.SINGULAR
    assert len(found.poses) == workspace.reached.sum() > 0
    assert found.nu == 0.0
