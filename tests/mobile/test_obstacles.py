"""Obstacles of every kind and from every source: polygons, lines and points, grown alike; what is none is named."""

import json
import warnings

import numpy as np
import pytest
import shapely

from pin_metaik.errors import InvalidGeometry
from pin_metaik.mobile import (
    NOMAD_200,
    Blocked,
    FreeSpace,
    LooksLikeDegrees,
    NoPath,
    PathProblem,
    Scene,
    load_scene,
    plan_path,
    plan_trajectory,
    plots,
    read_obstacles,
    read_polygons,
)

RADIUS = 0.5
LINE, POINT, BOX = shapely.LineString([(2, -1), (2, 1)]), shapely.Point(2, 0), shapely.box(1, -1, 3, 1)


def geojson(shape) -> dict:
    return json.loads(shapely.to_geojson(shape))


def feature(shape) -> dict:
    return {"type": "Feature", "properties": {"name": "x"}, "geometry": None if shape is None else geojson(shape)}


class Foreign:
    """An object of some other library, e.g. geopandas or fiona."""

    def __init__(self, mapping) -> None:
        self.__geo_interface__ = mapping


@pytest.mark.parametrize("shape", [LINE, POINT, BOX, shapely.LineString([(1, -1), (2, 1), (3, -1)])])
def test_lines_and_points_are_grown_by_the_radius_like_polygons(shape):
    """Below or above, whichever is shorter: the string round the upper half or the lower one, of a finer buffer."""
    problem = PathProblem.of(Scene((-1, 0), (5, 0), [shape]), RADIUS, join="round")
    plan = plan_path(problem)
    assert plan.clearance >= RADIUS - 1e-9
    whole = shape.buffer(RADIUS, quad_segs=2000)
    halves = [shapely.clip_by_rect(whole, -9, low, 9, high) for low, high in ((0, 9), (-9, 0))]
    strings = [
        shapely.union_all([half, shapely.LineString([(-1, 0), (5, 0)])]).convex_hull.exterior.length - 6
        for half in halves
    ]
    assert min(strings) <= plan.length + 1e-6
    assert plan.length <= 1.005 * min(strings)  # round joins keep half a percent of the radius more


@pytest.mark.parametrize("join", ["mitre", "round"])
def test_a_grown_line_and_a_thin_wall_along_it_are_the_same(join):
    thin = LINE.buffer(1e-7, cap_style="flat")
    of_line, of_wall = (plan_path(PathProblem.of(Scene((-1, 0), (5, 0), [o]), RADIUS, join=join)) for o in (LINE, thin))
    assert of_line.length == pytest.approx(of_wall.length, abs=1e-5)


def test_without_a_radius_a_line_cannot_be_crossed_and_a_point_is_hardly_there():
    over = plan_path(Scene((-1, 0), (5, 0), [LINE]))
    assert over.length == pytest.approx(2 * np.hypot(3, 1), abs=1e-6)
    assert plan_path(Scene((-1, 0), (5, 0), [POINT])).length == pytest.approx(6, abs=1e-6)
    assert not FreeSpace.of(Scene((-1, 0), (5, 0), [POINT])).holds([(-1, 0), (5, 0)])
    ring = shapely.LineString(BOX.exterior.coords)
    with pytest.raises(NoPath):
        plan_path(Scene((2, 0), (5, 0), [ring]))  # inside what a line encloses is free, and closed
    with pytest.raises(Blocked, match=r"the nearest free place is \((1\.99|2\.00)\d+, "):
        plan_path(Scene((2, 0.5), (5, 0), [LINE]))


@pytest.mark.parametrize("margin", [0.0, 0.1])
def test_trajectories_and_pictures_know_lines_and_points(tmp_path, margin):
    scene = Scene((-1, 0), (9, 0), [LINE, shapely.Point(5, -0.6), BOX.buffer(-0.4).exterior], (-2, -4, 10, 4))
    radius = NOMAD_200.radius if margin else 0.0
    plan = plan_path(PathProblem.of(scene, radius, margin))
    motion = plan_trajectory(plan.path, NOMAD_200, scene.obstacles, radius=radius)
    assert motion.success
    assert motion.clearance == pytest.approx(
        shapely.union_all(scene.obstacles).distance(shapely.LineString(motion.trajectory.sample(1e-3).xy)), abs=1e-6
    )
    assert not plan_trajectory([(-1, 0), (9, 0)], NOMAD_200, scene.obstacles, radius=radius).success
    plots.save(tmp_path / "plan.svg", lambda figure: plots.draw_plan(figure, plan))
    plots.save(tmp_path / "motion.svg", lambda figure: plots.draw_trajectory(figure, motion, scene))
    assert (tmp_path / "motion.svg").stat().st_size > 10_000


@pytest.mark.parametrize("fitness", ["exact", "paper"])
def test_searches_know_lines_and_points(fitness):
    problem = PathProblem.of(Scene((-1, 0), (5, 0), [LINE, shapely.Point(4, 0)], (-2, -3, 6, 3)), 0.2)
    plan = plan_path(problem, "pso", fitness=fitness, via=3)
    assert plan.success
    assert plan.verify()
    assert plan.gap < 0.1


MANY = shapely.MultiLineString([[(0, 0), (1, 1)], [(2, 2), (3, 3)]])
NESTED = shapely.GeometryCollection([POINT, shapely.GeometryCollection([MANY, shapely.MultiPolygon([BOX])])])
ALL = ["Point", "LineString", "LineString", "Polygon"]
SOURCES = {  # all hold NESTED
    "shapely": NESTED,
    "parts": list(shapely.get_parts(NESTED)),
    "wkt": NESTED.wkt,
    "lines": "\n".join(part.wkt for part in (POINT, MANY, BOX)),
    "blank lines": "\n\n".join(part.wkt for part in (POINT, MANY, BOX)) + "\n\n",
    "broken lines": "\n".join(part.wkt.replace(", ", ",\n ") for part in (POINT, MANY, BOX)),
    "words apart": "\r\n".join(part.wkt.replace(" (", "\r\n(", 1) for part in (POINT, MANY, BOX)),
    "geojson": geojson(NESTED),
    "feature": feature(NESTED),
    "features": {"type": "FeatureCollection", "features": [feature(POINT), feature(MANY), feature(BOX)]},
    "with null": {"type": "FeatureCollection", "features": [feature(None), feature(NESTED), feature(None)]},
    "no geometry": {"type": "FeatureCollection", "features": [{"type": "Feature"}, feature(NESTED)]},
    "foreign": Foreign(geojson(NESTED)),
    "foreign features": Foreign({"type": "FeatureCollection", "features": [feature(NESTED)]}),
    "several foreign": [Foreign(geojson(POINT)), Foreign(feature(MANY)), Foreign(geojson(BOX))],
    "mixed": [Foreign(geojson(POINT)), MANY.wkt, [(1, -1), (3, -1), (3, 1), (1, 1)]],
    "nested": [[POINT, [MANY]], (shapely.get_coordinates(BOX)[:-1],)],
    "heights": shapely.force_3d(NESTED, 7.0),
    "generator": (part for part in shapely.get_parts(NESTED)),
}


@pytest.mark.parametrize("name", SOURCES)
def test_the_same_obstacles_come_from_every_source(name):
    found = read_obstacles(SOURCES[name])
    assert [each.geom_type for each in found] == ALL
    assert not any(each.has_z for each in found)
    assert [each.equals(other) for each, other in zip(found, read_obstacles(NESTED), strict=True)] == [True] * 4


@pytest.mark.parametrize("suffix", ["geojson", "json", "wkt"])
def test_files_hold_lines_points_and_features_without_geometry(tmp_path, suffix):
    file = tmp_path / f"map.{suffix}"
    held = SOURCES["broken lines"] if suffix == "wkt" else json.dumps(SOURCES["with null"])
    file.write_text(f"\ufeff{held}", encoding="utf-8")
    scene = load_scene(file, (-5, 0), (9, 0))
    assert [each.geom_type for each in scene.obstacles] == ALL
    assert [each.geom_type for each in read_obstacles(file)] == ALL
    again = Scene(**{key: scene.as_dict()[key] for key in ("start", "goal", "obstacles", "bounds")})
    assert all(one.equals(other) for one, other in zip(again.obstacles, scene.obstacles, strict=True))


def test_a_world_without_obstacles_may_be_written_in_many_ways():
    empty = [(), [], [[]], shapely.GeometryCollection(), feature(None), {"type": "FeatureCollection", "features": []}]
    assert [read_obstacles(source) for source in empty] == [()] * len(empty)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_coordinates_that_are_no_numbers_are_refused_in_every_form(bad):
    ring = [(0, 0), (bad, 0), (1, 1)]
    with np.errstate(invalid="ignore"):  # shapely warns while it makes them
        shapes = shapely.Polygon(ring), shapely.LineString(ring), shapely.Point(bad, 0)
    sources = [
        ring,
        *shapes,
        f"POLYGON ((0 0, {bad} 0, 1 1, 0 0))",
        f"LINESTRING (0 0, {bad} 0)",
        {"type": "Point", "coordinates": [bad, 0]},
        {"type": "Polygon", "coordinates": [[*ring, ring[0]]]},
        Foreign({"type": "LineString", "coordinates": ring}),
    ]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for source in sources:
            for given in (source, [source]):
                with pytest.raises(InvalidGeometry, match=r"not finite|not JSON compliant"):
                    read_obstacles(given)
    for ends in (((bad, 0), (1, 1)), ((0, 0), (1, bad))):
        with pytest.raises(InvalidGeometry, match="must be finite"):
            Scene(*ends)
    with pytest.raises(InvalidGeometry, match="finite"):
        Scene((0, 0), (1, 1), (), (0, 0, abs(bad), 1))


def test_numbers_too_large_to_multiply_are_refused():
    for huge in (1e101, 1e160, 1e308):
        with pytest.raises(InvalidGeometry, match="beyond 1e\\+100: give lengths in a larger unit"):
            read_obstacles([[(0, 0), (huge, 0), (huge, huge)]])
        with pytest.raises(InvalidGeometry, match="within 1e\\+100"):
            Scene((0, 0), (huge, 0))
        with pytest.raises(InvalidGeometry, match="within 1e\\+100"):
            Scene((0, 0), (1, 0), (), (-huge, 0, huge, 1))


CROSSED = [
    [(0, 0), (2, 2), (2, 0), (0, 2)],
    "POLYGON ((0 0, 2 2, 2 0, 0 2, 0 0))",
    shapely.Polygon([(0, 0), (4, 4), (4, 0), (0, 3)]),
]
FLAT = [[(0, 0), (1, 1), (2, 2)], "POLYGON ((0 0, 1 0, 2 0, 0 0))", shapely.Polygon([(0, 0), (1, 0), (1, 0)])]


@pytest.mark.parametrize("source", CROSSED)
def test_polygons_that_cross_themselves_are_refused_and_made_valid_are_taken(source):
    with pytest.raises(InvalidGeometry, match=r"not a simple polygon \(Self-intersection.*make_valid"):
        read_obstacles([source])
    shape = shapely.from_wkt(source) if isinstance(source, str) else shapely.Polygon(source)
    assert read_obstacles(shapely.make_valid(shape))


@pytest.mark.parametrize("source", FLAT)
def test_polygons_without_area_are_refused_and_as_lines_are_taken(source):
    with pytest.raises(InvalidGeometry, match="has no area: a wall needs a thickness, or is a LineString"):
        read_obstacles([source])
    shape = shapely.from_wkt(source) if isinstance(source, str) else shapely.Polygon(source)
    assert [each.geom_type for each in read_obstacles(shape.exterior)] == ["LineString"]


LOOP: list = []
LOOP.append(LOOP)


class Raising:
    @property
    def __geo_interface__(self):
        raise RuntimeError("the file is closed")


@pytest.mark.parametrize(
    ("source", "said"),
    [
        (LOOP, "nested too deeply"),
        (Raising(), "cannot be read: the file is closed"),
        (Foreign("POINT (1 1)"), "not a GeoJSON mapping: 'POINT"),
        (Foreign(None), "give vertices"),
        ("LINESTRING (1 1, 1 1)", "line without length: give a Point"),
        ("CIRCULARSTRING (0 0, 1 1, 2 0)", "neither WKT nor"),
        ("POINT (1 1)\nPOINT (2 2", "line 2 is neither WKT nor"),
        ("POINT (1 1)\nnonsense\n", "line 2 is neither WKT nor"),
        ("", "is empty: give WKT, e.g. POLYGON"),
        ("POLYGON EMPTY", "is empty"),
        (shapely.LineString(), "is empty"),
        ({"type": "Topology"}, "GeoJSON of type 'Topology': an obstacle is a Polygon, LineString or Point"),
        ({"type": "Feature", "geometry": {"type": "Circle"}}, "GeoJSON of type 'Circle'"),
        ({"type": "FeatureCollection", "features": [feature(BOX), 7]}, "feature 1 is GeoJSON of type 7"),
        ({"type": "LineString", "coordinates": [[0, 0]]}, "not a GeoJSON LineString"),
        (None, "is None: give vertices"),
        (object(), "give vertices"),
    ],
)
def test_what_is_no_obstacle_is_named(source, said):
    with pytest.raises(InvalidGeometry, match=said):
        read_obstacles(source)


def test_only_geojson_as_a_whole_may_be_in_degrees():
    near_zurich = {"type": "Feature", "geometry": geojson(shapely.box(8.54, 47.37, 8.55, 47.38))}
    with pytest.warns(LooksLikeDegrees, match="look like longitudes and latitudes") as said:
        read_obstacles(near_zurich)
    assert said[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        holed = shapely.box(8.5, 4.3, 8.6, 4.4).difference(shapely.box(8.52, 4.32, 8.54, 4.34))
        scene = Scene((0, 0), (10, 10), [holed])
        assert Scene(scene.start, scene.goal, scene.as_dict()["obstacles"]).obstacles[0].equals(holed)


def test_polygons_only_where_only_polygons_are_wanted():
    for source in (LINE, POINT, SOURCES["features"]):
        with pytest.raises(InvalidGeometry, match="an obstacle is a Polygon or a MultiPolygon here"):
            read_polygons(source)
