"""Polygons in, from whatever holds them: vertex lists, shapely, WKT, GeoJSON and files of the last two."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from pin_metaik.arguments import checked
from pin_metaik.errors import InvalidGeometry

ACCEPTED = "Polygon, MultiPolygon, GeometryCollection, Feature or FeatureCollection"


@checked
def read_polygons(source: Any) -> tuple[shapely.Polygon, ...]:
    """The polygons of a source, checked one by one.

    Args:
        source: A polygon as vertices (n, 2), as a shapely geometry, as WKT or as a GeoJSON mapping; the path of a
            ``.geojson``, ``.json`` or ``.wkt`` file; or a sequence of any of these. Geometries of several polygons
            become several obstacles; holes are kept; heights (z) are dropped.

    Raises:
        InvalidGeometry: A polygon crosses itself, has no area, fewer than three vertices or numbers that are not
            finite; or the source holds something that is not a polygon.
    """
    return tuple(_checked(polygon, place) for polygon, place in _walk(source, "polygons"))


def _walk(source: Any, place: str) -> Iterator[tuple[shapely.Polygon, str]]:
    """Polygons of a source, each with the words that say where it was found."""
    match source:
        case BaseGeometry():
            yield from _parts(source, place)
        case Path():
            yield from _walk(_read(source), str(source))
        case str() if source.lower().endswith((".geojson", ".json", ".wkt")):
            yield from _walk(Path(source), place)
        case str():
            yield from _parts(_wkt(source, place), place)
        case Mapping():
            yield from _geojson(source, place)
        case _ if _is_ring(source):
            yield _ring(source, place), place
        case Iterable():
            for i, item in enumerate(source):
                yield from _walk(item, f"{place}[{i}]")
        case _:
            raise InvalidGeometry(
                f"{place} is {source!r}: give vertices (n, 2), shapely, WKT, GeoJSON or a sequence of them"
            )


def _read(path: Path) -> Any:
    try:
        text = path.read_text(encoding="utf-8-sig")
        return text.strip() if path.suffix.lower() == ".wkt" else json.loads(text)
    except OSError as error:
        raise InvalidGeometry(f"cannot read {path}: {error.strerror}") from None
    except ValueError as error:
        raise InvalidGeometry(f"{path} is not GeoJSON: {error}") from None


def _wkt(text: str, place: str) -> BaseGeometry:
    try:
        return shapely.from_wkt(text)
    except shapely.errors.GEOSException as error:
        raise InvalidGeometry(f"{place} is neither WKT nor a .geojson, .json or .wkt file: {error}") from None


def _geojson(mapping: Mapping[str, Any], place: str) -> Iterator[tuple[shapely.Polygon, str]]:
    match mapping.get("type") if isinstance(mapping, Mapping) else mapping:
        case "FeatureCollection":
            for i, feature in enumerate(_members(mapping, "features", place)):
                yield from _geojson(feature, f"{place} feature {i}")
        case "Feature":
            yield from _geojson(mapping.get("geometry") or {}, place)
        case "GeometryCollection":
            for i, geometry in enumerate(_members(mapping, "geometries", place)):
                yield from _geojson(geometry, f"{place} geometry {i}")
        case "Polygon" | "MultiPolygon":
            try:
                geometry = shapely.from_geojson(json.dumps(mapping))
            except (shapely.errors.GEOSException, TypeError, ValueError) as error:
                raise InvalidGeometry(f"{place} is not a GeoJSON {mapping['type']}: {error}") from None
            yield from _parts(geometry, place)
        case kind:
            raise InvalidGeometry(f"{place} is GeoJSON of type {kind!r}: an obstacle is a {ACCEPTED}")


def _members(mapping: Mapping[str, Any], key: str, place: str) -> list[Any]:
    members = mapping.get(key)
    if not isinstance(members, list):
        raise InvalidGeometry(f"{place} is a GeoJSON {mapping['type']} without a list of {key}")
    return members


def _parts(geometry: BaseGeometry, place: str) -> Iterator[tuple[shapely.Polygon, str]]:
    match geometry.geom_type:
        case "Polygon":
            yield shapely.force_2d(geometry), place
        case "MultiPolygon" | "GeometryCollection":
            for i, part in enumerate(geometry.geoms):
                yield from _parts(part, f"{place} part {i}")
        case kind:
            raise InvalidGeometry(f"{place} is a {kind}: an obstacle is a Polygon or a MultiPolygon")


def _is_ring(source: Any) -> bool:
    """Whether it is one list of vertices: what its first element holds first is a number."""
    try:
        return np.ndim(source[0][0]) == 0 and not isinstance(source[0], (str, Mapping, BaseGeometry))
    except (TypeError, IndexError, KeyError, ValueError):
        return False


def _ring(source: Any, place: str) -> shapely.Polygon:
    try:
        vertices = np.asarray(source, dtype=float)
    except (TypeError, ValueError):
        vertices = np.empty(0)
    if vertices.ndim != 2 or vertices.shape[1] != 2 or len(vertices) < 3:
        raise InvalidGeometry(f"{place} is not a polygon: it takes at least three vertices (x, y), got {source!r}")
    if not np.isfinite(vertices).all():
        raise InvalidGeometry(f"{place} has vertices that are not finite: {source!r}")
    return shapely.Polygon(vertices)


def _checked(polygon: shapely.Polygon, place: str) -> shapely.Polygon:
    if polygon.is_empty:
        raise InvalidGeometry(f"{place} is empty: it takes at least three vertices")
    if not np.isfinite(shapely.get_coordinates(polygon)).all():
        raise InvalidGeometry(f"{place} has vertices that are not finite")
    if not polygon.is_valid:
        why = shapely.is_valid_reason(polygon)
        raise InvalidGeometry(f"{place} is not a simple polygon ({why}); split it, or pass shapely.make_valid of it")
    if not polygon.area > 0:
        raise InvalidGeometry(f"{place} has no area: a wall needs a thickness")
    return polygon
