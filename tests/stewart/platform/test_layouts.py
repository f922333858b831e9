import numpy as np
import pytest

from pin_metaik.errors import InvalidSetting, UnknownName
from pin_metaik.stewart import NAMED, Dexterity, conditioning, jacobian, pose_at, standard_geometry

EVERY = [(f"{b}x{m}", legs) for legs in range(3, 7) for b in range(3, legs + 1) for m in range(3, legs + 1)]
HOME = pose_at((0, 0, 0.3))


@pytest.mark.parametrize(("type", "legs"), EVERY)
def test_every_type_with_three_to_six_legs_holds_its_platform(type, legs):  # A13
    geometry = standard_geometry(type, 0.25, 0.12, legs=legs)
    assert geometry.type == type
    assert jacobian(geometry, HOME).shape == (legs, 6)
    assert np.linalg.matrix_rank(jacobian(geometry, HOME)) == legs
    for norm in ("frobenius", "two"):
        assert conditioning(geometry, HOME, Dexterity(norm)) > 0.03


def test_the_ten_named_types_are_among_them():
    assert set(NAMED) <= {type for type, legs in EVERY if legs == 6}
    assert len(NAMED) == 10


def test_the_octahedron_has_its_vertices_between_each_others():
    geometry = standard_geometry("3x3", 0.2, 0.2)
    np.testing.assert_allclose(np.degrees(geometry.base_angles), [30, 150, 270])
    np.testing.assert_allclose(np.degrees(geometry.platform_angles), [90, 210, 330])


def test_three_legs_stand_120_degrees_apart():
    geometry = standard_geometry("3x3", 0.2, 0.1, legs=3)
    np.testing.assert_allclose(np.degrees(geometry.base_angles), [0, 120, 240], atol=1e-12)


def test_an_unknown_type_names_those_there_are():
    with pytest.raises(UnknownName, match=r"no type of platform with 6 legs named '7x3'.* 6x6"):
        standard_geometry("7x3", 0.2, 0.1)
    with pytest.raises(UnknownName, match="with 4 legs named '6x6'"):
        standard_geometry("6x6", 0.2, 0.1, legs=4)
    with pytest.raises(InvalidSetting, match="3 to 6 legs, got 7"):
        standard_geometry("3x3", 0.2, 0.1, legs=7)
    with pytest.raises(InvalidSetting, match="split"):
        standard_geometry("6x6", 0.2, 0.1, split=1.0)
