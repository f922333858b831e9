from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from pin_metaik.errors import InvalidGeometry, MetaIKError
from pin_metaik.stewart import Geometry, conditioning, leg_lengths, legs_of, standard_geometry
from tests.stewart.cases import OCTAHEDRON, cube, reference, some_poses

GOOD = {
    "base_radius": 0.2,
    "platform_radius": 0.1,
    "base_angles": tuple(np.radians([0, 120, 240])),
    "platform_angles": tuple(np.radians([60, 180, 300])),
    "legs": OCTAHEDRON,
}


def test_joints_lie_on_their_circles_and_legs_join_them():
    geometry = Geometry(**GOOD)
    assert geometry.type == "3x3"
    assert geometry.n == 6
    assert_allclose(np.linalg.norm(geometry.base_joints, axis=1), 0.2)
    assert_allclose(geometry.platform_joints[1], [-0.1, 0, 0], atol=1e-16)
    assert_array_equal(geometry.b[2], geometry.base_joints[1])
    assert_array_equal(geometry.m[2], geometry.platform_joints[0])


def test_the_reference_point_moves_the_platform_joints():
    moved = Geometry(**GOOD, reference=(0.01, 0, -0.02))
    assert_allclose(moved.m, Geometry(**GOOD).m - [0.01, 0, -0.02])


def test_the_connection_matrix_has_a_one_for_each_leg_and_gives_the_legs_back():
    geometry = Geometry(**GOOD)
    assert_array_equal(geometry.connection, [[1, 0, 1], [1, 1, 0], [0, 1, 1]])
    assert sorted(legs_of(geometry.connection)) == sorted(geometry.legs)


def test_legs_that_share_a_joint_are_no_pair():
    assert len(Geometry(**GOOD).pairs) == 9  # 15 less 3 a side
    assert len(reference().geometry.pairs) == 15


def test_the_joint_gap_is_the_nearest_pair_of_neighbours_also_across_the_first():
    near = replace(Geometry(**GOOD), platform_angles=tuple(np.radians([5, 180, 355])))
    assert_allclose(near.joint_gap, 2 * 0.1 * np.sin(np.radians(5)))


@pytest.mark.parametrize("type", ["3x3", "4x3", "4x4", "5x3", "5x4", "5x5", "6x3", "6x4", "6x5", "6x6"])
def test_numbering_the_joints_otherwise_changes_nothing(type):  # A13
    geometry = standard_geometry(type, 0.25, 0.12)
    poses = some_poses(20, (0, 0, 0.35), (0.05, 0.05, 0.05), 0.2)
    rng = np.random.default_rng(1)
    first_b, first_m = rng.integers(len(geometry.base_angles)), rng.integers(len(geometry.platform_angles))

    def start_at(angles, first):
        return (*angles[first:], *(angle + 2 * np.pi for angle in angles[:first]))

    order = rng.permutation(6)
    renumbered = replace(
        geometry,
        base_angles=start_at(geometry.base_angles, first_b),
        platform_angles=start_at(geometry.platform_angles, first_m),
        legs=[
            ((b - first_b) % len(geometry.base_angles), (m - first_m) % len(geometry.platform_angles))
            for b, m in np.array(geometry.legs)[order]
        ],
    )
    assert_allclose(leg_lengths(renumbered, poses), leg_lengths(geometry, poses)[:, order], rtol=1e-12)
    assert_allclose(conditioning(renumbered, poses), conditioning(geometry, poses), rtol=1e-12)


WRONG = {
    "a radius of zero": ({"base_radius": 0.0}, "base_radius is above zero"),
    "a radius below zero": ({"platform_radius": -0.1}, "platform_radius is above zero"),
    "a radius that is no number": ({"base_radius": "wide"}, "base_radius is a finite number, got 'wide'"),
    "a radius that is NaN": ({"base_radius": np.nan}, "base_radius is a finite number"),
    "angles out of order": (
        {"base_angles": np.radians([172.6, 293.2, 53])},
        r"B3 at 53 deg does not come after B2 at 293.2 deg; write 413 deg",
    ),
    "equal angles": ({"platform_angles": np.radians([60, 60, 300])}, "M2 at 60 deg does not come after M1"),
    "angles beyond a turn": ({"base_angles": np.radians([0, 120, 361])}, "B3 at 361 deg is a turn or more after B1"),
    "an angle that is no number": ({"base_angles": (0.0, "a", 2.0)}, "base_angles is a finite number, got 'a'"),
    "angles that are no list": ({"base_angles": 3.0}, "base_angles is a list of numbers"),
    "one joint": ({"base_angles": (0.0,)}, "at least two joints"),
    "a leg to a base joint that does not exist": (
        {"legs": (*OCTAHEDRON[:5], (3, 2))},
        "leg 6 is joined to B4, which does not exist: there are B1 to B3",
    ),
    "a leg to a platform joint that does not exist": ({"legs": (*OCTAHEDRON[:5], (2, 5))}, "leg 6 is joined to M6"),
    "a leg to joint minus one": ({"legs": ((-1, 0), *OCTAHEDRON[1:])}, "leg 1 is joined to B0, which does not exist"),
    "two legs between two joints": ({"legs": (*OCTAHEDRON[:5], OCTAHEDRON[0])}, "legs 1 and 6 both join B1 and M3"),
    "a joint without a leg": (
        {"base_angles": tuple(np.radians([0, 120, 240, 300]))},
        "joint B4 has no leg",
    ),
    "two legs": ({"legs": OCTAHEDRON[:2]}, "3 to 6 legs, got 2"),
    "seven legs": ({"legs": (*OCTAHEDRON, (0, 1))}, "3 to 6 legs, got 7"),
    "legs that are no pairs": ({"legs": (1, 2, 3)}, "legs are pairs"),
    "a reference of two": ({"reference": (0.0, 0.0)}, "reference is three lengths"),
}


@pytest.mark.parametrize("what", WRONG)
def test_what_is_no_platform_is_refused_by_name(what):
    changes, message = WRONG[what]
    with pytest.raises(InvalidGeometry, match=message):
        Geometry(**(GOOD | changes))


@pytest.mark.parametrize("matrix", [[[1, 0, 2]], [1, 0], "10", [[0.5]], None])
def test_a_connection_matrix_is_zeros_and_ones(matrix):
    with pytest.raises(InvalidGeometry, match="zeros and ones"):
        legs_of(matrix)


def test_all_its_errors_are_of_the_family():
    assert issubclass(InvalidGeometry, MetaIKError)


def test_a_geometry_equals_another_with_the_same_numbers():
    assert cube(0.1) == cube(0.1)
    assert hash(cube(0.1)) == hash(cube(0.1))
