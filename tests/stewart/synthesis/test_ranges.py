import numpy as np
import pytest
from numpy.testing import assert_allclose

from pin_metaik.errors import InvalidBounds
from pin_metaik.stewart import LegLimits, Ranges
from pin_metaik.stewart.mechanism.ranges import Variables
from tests.stewart.cases import cube

GEOMETRY, LIMITS = cube(0.1), LegLimits(0.1, 0.15)


def test_only_what_has_a_range_is_searched():
    ranges = Ranges(platform_radius=(0.05, 0.1), base_angles=(0.0, (1.0, 3.0), 4.0), longest=(0.15, 0.2))
    variables = Variables.of(ranges, GEOMETRY, LIMITS)
    assert_allclose(variables.box.lower, [0.05, 1.0, 0.15])
    assert_allclose(variables.box.upper, [0.1, 3.0, 0.2])
    found = variables.dimensions(np.array([0.06, 2.0, 0.16]))
    assert (found.base_radius, found.platform_radius) == (GEOMETRY.base_radius, 0.06)
    assert_allclose(found.base_angles, [0.0, 2.0, 4.0])
    assert_allclose(found.platform_angles, GEOMETRY.platform_angles)
    assert (found.shortest, found.longest) == (0.1, 0.16)
    assert variables.longest_stroke == pytest.approx(0.1)


def test_a_platform_has_its_point_among_the_variables():
    variables = Variables.of(Ranges(base_radius=(0.01, 1.0), shortest=(0.05, 0.2)), GEOMETRY, LIMITS)
    assert_allclose(variables.point(GEOMETRY, LIMITS), [GEOMETRY.base_radius, 0.1])


@pytest.mark.parametrize(
    ("ranges", "message"),
    [
        ({"base_radius": (0.2, 0.1)}, "range of base_radius is two finite numbers, the lower first"),
        ({"base_radius": (0.0, 0.1)}, "base_radius is above zero, its range begins at 0 m"),
        ({"shortest": np.nan}, "shortest is a finite number, got nan"),
        ({"base_angles": 1.0}, "one value or range for each joint"),
        ({"base_angles": ((1.0, 2.0, 3.0),)}, "range of base_angles is two numbers"),
        ({"longest": "long"}, "range of longest is two numbers"),
    ],
)
def test_ranges_that_are_none_are_refused(ranges, message):
    with pytest.raises(InvalidBounds, match=message):
        Ranges(**ranges)


def test_ranges_must_fit_the_mechanism_and_leave_something_free():
    with pytest.raises(InvalidBounds, match="base_angles has 2 ranges for 3 joints"):
        Variables.of(Ranges(base_angles=((0.0, 1.0), 2.0)), GEOMETRY, LIMITS)
    with pytest.raises(InvalidBounds, match="every dimension is fixed"):
        Variables.of(Ranges(base_radius=0.1), GEOMETRY, LIMITS)
