"""All assemblies: none missed, and whether none is missing is told."""

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

from pin_metaik.errors import InvalidConfiguration, InvalidGeometry, InvalidSetting
from pin_metaik.stewart import Geometry, all_forward, forward, leg_lengths, pose_at, standard_geometry
from tests.stewart.cases import cube, reference, similar_hexagons, stroke

FOUR = (
    Geometry(
        0.3,
        0.3346,
        (0.5862, 0.6124, 0.6648, 2.4722, 2.723, 2.7542),
        (0.5526, 0.8222, 0.9425, 1.918, 5.6065, 5.6484),
        ((0, 2), (1, 0), (2, 5), (3, 4), (4, 1), (5, 3)),
    ),
    [0.1596, 0.096, 0.3471, 0.1258, 0.5762, 0.7132],
)
SIXTEEN = (
    Geometry(
        0.3,
        0.2721,
        (0.4685, 0.6166, 1.525, 2.1597, 3.393, 6.2616),
        (0.992, 2.6831, 4.3799, 4.8072, 5.6759, 6.1595),
        ((0, 5), (1, 2), (2, 0), (3, 3), (4, 4), (5, 1)),
    ),
    [0.3156, 0.3119, 0.3969, 0.3857, 0.4659, 0.5753],
)
MIRROR = np.diag([1.0, 1.0, -1.0, 1.0])


def random_6x6(rng):
    angles = [np.sort(rng.uniform(0, 2 * np.pi, 6)) for _ in range(2)]
    legs = tuple((i, int(m)) for i, m in enumerate(rng.permutation(6)))
    return Geometry(0.3, rng.uniform(0.1, 0.4), *angles, legs)


@pytest.mark.parametrize(("case", "count"), [(FOUR, 4), (SIXTEEN, 16)])
@pytest.mark.parametrize("seed", [0, 1])
def test_assemblies_with_small_basins_are_found_whatever_the_seed(case, count, seed):  # N6
    geometry, lengths = case
    found = all_forward(geometry, lengths, rng=seed)
    assert len(found) == count
    assert found.complete
    assert (found.solutions, found.bound) == (40, 40)
    assert_allclose(leg_lengths(geometry, found), np.tile(lengths, (count, 1)), atol=1e-13)


def test_random_platforms_have_every_assembly_and_its_mirror_image():  # N8
    rng = np.random.default_rng(0)
    for _ in range(40):
        geometry = random_6x6(rng)
        pose = pose_at((*rng.uniform(-0.25, 0.25, 2), rng.uniform(0.05, 0.55)), rng.uniform(-1, 1, 3))
        lengths = leg_lengths(geometry, pose)
        found = all_forward(geometry, lengths)
        assert found.complete
        assert np.abs(found.poses - pose).max(axis=(1, 2)).min() < 1e-7
        for assembly in found:
            assert np.abs(found.poses - MIRROR @ assembly @ MIRROR).max(axis=(1, 2)).min() < 1e-7
        assert_allclose(leg_lengths(geometry, found), np.tile(lengths, (len(found), 1)), atol=1e-12)


def test_newton_from_many_starts_finds_nothing_more():
    rng = np.random.default_rng(1)
    for _ in range(4):
        geometry = random_6x6(rng)
        lengths = leg_lengths(geometry, pose_at((0.0, 0.05, 0.3), rng.uniform(-1, 1, 3)))
        starts = np.tile(np.eye(4), (3000, 1, 1))
        starts[:, :3, 3] = rng.uniform(-0.6, 0.6, (3000, 3))
        starts[:, :3, :3] = [pin.exp3(rng.uniform(-3, 3, 3)) for _ in range(3000)]
        result = forward(geometry, np.tile(lengths, (3000, 1)), starts)
        found = all_forward(geometry, lengths)
        assert found.complete
        for pose in result.poses[result.solved]:
            assert np.abs(found.poses - pose).max(axis=(1, 2)).min() < 1e-5


@pytest.mark.parametrize(
    ("type", "bound"), [("3x3", 16), ("6x3", 16), ("4x4", 24), ("5x4", 24), ("6x4", 32), ("6x5", 36), ("5x5", 40)]
)
def test_shared_joints_leave_fewer_solutions(type, bound):
    geometry = standard_geometry(type, 0.3, 0.2)
    found = all_forward(geometry, leg_lengths(geometry, pose_at((0.01, 0.02, 0.35), (0.1, -0.2, 0.1))))
    assert found.complete
    assert found.bound == bound
    assert len(found) % 2 == 0


def test_lengths_that_fit_nowhere_have_no_assembly_which_is_certain():
    found = all_forward(reference().geometry, [0.2, 0.9, 0.2, 0.9, 0.2, 0.9])
    assert len(found) == 0
    assert found.complete
    assert "0 assemblies, all of them" in str(found)


def test_where_two_assemblies_become_one_nothing_is_claimed():
    geometry = stroke(100).geometry
    offset = geometry.m - geometry.b
    across = np.linalg.norm(offset[:, :2], axis=1)  # legs that reach their joints only in the plane of the base
    found = all_forward(geometry, across)
    assert not found.complete
    assert "there may be more" in str(found)


def test_the_assemblies_are_an_array_of_poses():
    geometry, lengths = SIXTEEN
    found = all_forward(geometry, lengths)
    assert np.asarray(found).shape == (16, 4, 4)
    assert found[:, 2, 3].shape == (16,)
    assert (np.diff(found[:, 2, 3]) <= 1e-9).all()  # highest first
    assert len(list(found)) == 16


def test_a_platform_that_moves_with_its_legs_held_is_not_enumerated():
    angles = np.radians([0, 60, 120, 180, 240, 300])
    parallelogram = Geometry(0.2, 0.2, angles, angles, tuple((i, i) for i in range(6)))
    with pytest.raises(InvalidGeometry, match="singular: its platform moves"):
        all_forward(parallelogram, [0.3] * 6)
    with pytest.raises(InvalidGeometry, match="singular: its platform moves"):
        all_forward(cube(0.1), [0.1] * 6)
    hexagons = similar_hexagons()
    with pytest.raises(InvalidGeometry, match="singular: its platform moves"):
        all_forward(hexagons, leg_lengths(hexagons, pose_at((0, 0, 0.37))))


def test_one_set_of_lengths_for_six_legs_is_asked_for():
    with pytest.raises(InvalidConfiguration, match="one set"):
        all_forward(cube(0.1), np.full((2, 6), 0.1))
    with pytest.raises(InvalidSetting, match="degrees of freedom"):
        all_forward(standard_geometry("3x3", 0.25, 0.12, legs=4), [0.3] * 4)
