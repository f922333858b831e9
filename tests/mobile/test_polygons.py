import json

import numpy as np
import pytest
import shapely

from pin_metaik.errors import InvalidGeometry
from pin_metaik.mobile import read_polygons

SQUARE = [(0, 0), (2, 0), (2, 2), (0, 2)]
BOX = shapely.box(0, 0, 2, 2)
GEOJSON = json.loads(shapely.to_geojson(BOX))


@pytest.mark.parametrize(
    "source",
    [
        SQUARE,
        np.array(SQUARE),
        [SQUARE],
        BOX,
        [BOX],
        shapely.MultiPolygon([BOX]),
        shapely.GeometryCollection([shapely.MultiPolygon([BOX])]),
        BOX.wkt,
        GEOJSON,
        {"type": "Feature", "properties": {}, "geometry": GEOJSON},
        {"type": "FeatureCollection", "features": [{"type": "Feature", "geometry": GEOJSON}]},
        {"type": "GeometryCollection", "geometries": [GEOJSON]},
        shapely.force_3d(BOX),
    ],
    ids=lambda source: type(source).__name__,
)
def test_a_square_comes_in_whatever_form_it_has(source):
    (polygon,) = read_polygons(source)
    assert polygon.equals(BOX)
    assert not polygon.has_z


@pytest.mark.parametrize("suffix", ["geojson", "json", "wkt"])
def test_a_file_is_read_by_its_path(tmp_path, suffix):
    file = tmp_path / f"map.{suffix}"
    file.write_text(BOX.wkt if suffix == "wkt" else json.dumps(GEOJSON))
    assert read_polygons(file)[0].equals(BOX)
    assert read_polygons(str(file))[0].equals(BOX)


def test_several_forms_may_be_mixed_and_parts_become_polygons():
    two = shapely.MultiPolygon([BOX, shapely.box(5, 5, 6, 6)])
    assert len(read_polygons([SQUARE, two, GEOJSON, BOX.wkt])) == 5
    assert read_polygons([]) == ()


def test_holes_are_kept():
    ring = BOX.difference(shapely.box(0.5, 0.5, 1, 1))
    assert read_polygons(json.loads(shapely.to_geojson(ring)))[0].area == pytest.approx(3.75)


@pytest.mark.parametrize(
    ("source", "said"),
    [
        ([SQUARE, [(0, 0), (2, 2), (2, 0), (0, 2)]], r"polygons\[1\] is not a simple polygon \(Self-intersection"),
        ([[(0, 0), (1, 1)]], "at least three vertices"),
        ([[(0, 0), (1, 1), (2, 2)]], "not a simple polygon|no area"),
        ([[(0, 0), (1, np.nan), (2, 2)]], "not finite"),
        ([[(0, 0, 1), (1, 0, 1), (2, 2, 1)]], "at least three vertices"),
        ([[(0, 0), (1, "a"), (2, 2)]], "at least three vertices"),
        (shapely.Polygon(), "empty"),
        (shapely.LineString([(0, 0), (1, 1)]), "is a LineString: an obstacle is"),
        ("POINT (1 1)", "is a Point"),
        ("not wkt", "neither WKT nor"),
        ({"type": "Point", "coordinates": [0, 0]}, "is a Point: an obstacle is a Polygon"),
        ({"type": "Polygon", "coordinates": "nonsense"}, "not a GeoJSON Polygon"),
        ({"nothing": 1}, "GeoJSON of type None"),
        ({"type": "FeatureCollection"}, "without a list of features"),
        ({"type": "GeometryCollection", "geometries": [3]}, "geometry 0 is GeoJSON of type 3"),
        ("missing.geojson", "cannot read missing.geojson"),
        (7, "give vertices"),
    ],
)
def test_what_is_no_polygon_is_refused_by_name(source, said):
    with pytest.raises(InvalidGeometry, match=said):
        read_polygons(source)


def test_a_file_that_is_not_json_is_refused(tmp_path):
    (tmp_path / "map.geojson").write_text("{")
    with pytest.raises(InvalidGeometry, match="is not GeoJSON"):
        read_polygons(tmp_path / "map.geojson")
