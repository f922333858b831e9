import numpy as np
import pytest
import shapely

from pin_metaik.errors import InvalidSetting
from pin_metaik.mobile import FreeSpace, Scene
from pin_metaik.mobile.world.growth import grow, rings

ROUNDING = 1e-9  # corners lie on a grid


def stars(rng):
    """A star with random radii: concave, with needles; where it crosses itself, its parts."""
    angles = np.sort(rng.uniform(0, 2 * np.pi, 9))
    star = shapely.make_valid(shapely.Polygon(5 + rng.uniform(0.3, 3, (9, 1)) * np.c_[np.cos(angles), np.sin(angles)]))
    return tuple(part for part in shapely.get_parts(star) if part.geom_type == "Polygon")


def scene_of(polygons):
    return Scene((0, 0), (10, 10), polygons, (0, 0, 10, 10))


@pytest.mark.parametrize("join", ["mitre", "round"])
def test_the_border_of_grown_polygons_keeps_the_clearance_and_little_more(join):
    rng = np.random.default_rng(0)
    for _ in range(60):
        polygons = stars(rng)
        space, solid = FreeSpace.of(scene_of(polygons), 0.3, join), shapely.union_all(polygons)
        for ring in rings(space.region):
            assert solid.distance(shapely.LinearRing(ring)) >= 0.3 - ROUNDING
            corners = ring[(ring > 0.31).all(axis=1) & (ring < 9.69).all(axis=1)]
            furthest = shapely.distance(shapely.points(corners), solid).max(initial=0)
            assert furthest <= (0.3 * 5 if join == "mitre" else 0.3 * 1.005) + ROUNDING


@pytest.mark.parametrize("join", ["mitre", "round"])
def test_a_larger_clearance_frees_nothing(join):
    rng = np.random.default_rng(1)
    for _ in range(30):
        scene = scene_of(stars(rng))
        small, large = (FreeSpace.of(scene, r, join).region for r in (0.1, 0.25))
        assert large.difference(small).area < ROUNDING


def test_holes_are_grown_into_and_stay_holes():
    frame = shapely.box(0, 0, 10, 10).difference(shapely.box(2, 2, 8, 8))
    grown = shapely.union_all(grow((frame,), 1.0))
    expected = shapely.box(-1, -1, 11, 11).difference(shapely.box(3, 3, 7, 7))
    assert grown.symmetric_difference(expected).area < ROUNDING


def test_without_a_clearance_polygons_stay_as_they_are():
    square = shapely.box(0, 0, 1, 1)
    assert grow((square,), 0.0) == [square]


@pytest.mark.parametrize(("clearance", "join"), [(-1.0, "mitre"), (np.nan, "mitre"), (np.inf, "round"), (1.0, "bevel")])
def test_nonsense_is_refused(clearance, join):
    with pytest.raises(InvalidSetting):
        grow((shapely.box(0, 0, 1, 1),), clearance, join)
