"""Reading obstacles: vertex lists, shapely geometries, WKT, GeoJSON, and files of the last two."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from numbers import Real
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from pin_metaik.arguments import checked, shown
from pin_metaik.errors import InvalidGeometry
from pin_metaik.files import read_json, read_text
from pin_metaik.mobile.errors import LooksLikeDegrees
from pin_metaik.said import warn

SIMPLE = ("Polygon", "LineString", "Point")
COLLECTED = tuple(f"Multi{kind}" for kind in SIMPLE)
GEOJSON = (*SIMPLE, *COLLECTED, "GeometryCollection", "Feature", "FeatureCollection")
ACCEPTED = "Polygon, LineString or Point, Multi... of these, GeometryCollection, Feature or FeatureCollection"
FAR = 10  # extents from the origin: where a map of a few hundredths is likelier to be of degrees than of metres
FARTHEST = 1e100  # products of larger coordinates are no numbers any more

Found = tuple[BaseGeometry, str]


@checked
def read_obstacles(source: Any) -> tuple[BaseGeometry, ...]:
    """The polygons, lines and points of a source, checked one by one.

    Args:
        source: A polygon as vertices (n, 2); a shapely geometry, or an object with ``__geo_interface__``; WKT, one
            geometry or one a line; a GeoJSON mapping; the path of a ``.geojson``, ``.json`` or ``.wkt`` file; or a
            sequence of any of these. Geometries of several parts become several obstacles; holes are kept; heights (z)
            are dropped; GeoJSON features without a geometry are ignored.

    Raises:
        InvalidGeometry: A polygon crosses itself, has no area, fewer than three vertices or numbers that are not
            finite (or beyond 1e100); a line has no length; or the source holds something else.

    Warns:
        LooksLikeDegrees: GeoJSON whose coordinates look like longitudes and latitudes; lengths are then in degrees.
    """
    return tuple(_checked(geometry, place) for geometry, place in _found(source, "obstacles"))


@checked
def read_polygons(source: Any) -> tuple[shapely.Polygon, ...]:
    """The polygons of a source, checked one by one; see ``read_obstacles``.

    Raises:
        InvalidGeometry: As there; and for lines and points.
    """
    found = []
    for geometry, place in _found(source, "polygons"):
        if geometry.geom_type != "Polygon":
            raise InvalidGeometry(f"{place} is a {geometry.geom_type}: an obstacle is a Polygon or a MultiPolygon here")
        found.append(_checked(geometry, place))
    return tuple(found)


def _found(source: Any, place: str) -> list[Found]:
    """All that is in a source; what is GeoJSON as a whole may be in degrees."""
    try:
        found = list(_walk(source, place))
    except RecursionError:
        raise InvalidGeometry(f"{place} is nested too deeply: give a sequence of obstacles, not of sequences") from None
    named = str(source).lower().endswith((".geojson", ".json")) if isinstance(source, (str, Path)) else False
    if named or isinstance(source, Mapping) or _interface(source, place) is not None:
        _say_if_degrees([geometry for geometry, _ in found], str(source) if named else place)
    return found


def _walk(source: Any, place: str) -> Iterator[Found]:
    """Simple geometries of a source, each with the words that say where it was found."""
    match source:
        case BaseGeometry():
            yield from _parts(source, place)
        case Path():
            text = source.suffix.lower() == ".wkt"
            yield from _walk(read_text(source, InvalidGeometry) if text else _read_geojson(source), str(source))
        case str() if source.lower().endswith((".geojson", ".json", ".wkt")):
            yield from _walk(Path(source), place)
        case str():
            yield from _wkt(source, place)
        case Mapping():
            yield from _geojson(source, place)
        case _ if (mapping := _interface(source, place)) is not None:
            yield from _geojson(mapping, place)
        case _ if _is_ring(source):
            yield _ring(source, place), place
        case Iterable() if not isinstance(source, np.ndarray) or source.ndim:
            for i, item in enumerate(source):
                yield from _walk(item, f"{place}[{i}]")
        case _:
            raise InvalidGeometry(
                f"{place} is {source!r}: give vertices (n, 2), shapely, WKT, GeoJSON or a sequence of them"
            )


def _read_geojson(path: Path) -> Mapping[str, Any]:
    content = read_json(path, InvalidGeometry, "GeoJSON")
    if not isinstance(content, Mapping):
        raise InvalidGeometry(f"{path} is not GeoJSON: expected an object with a type, not {content!r:.80}")
    return content


def _interface(source: Any, place: str) -> Mapping[str, Any] | None:
    """What an object of another library says that it is, as GeoJSON; None for one that says nothing."""
    if isinstance(source, BaseGeometry):
        return None
    try:
        mapping = getattr(source, "__geo_interface__", None)
    except Exception as error:  # of anybody's class
        raise InvalidGeometry(f"{place} has a __geo_interface__ that cannot be read: {error}") from None
    if mapping is not None and not isinstance(mapping, Mapping):
        raise InvalidGeometry(f"{place} has a __geo_interface__ that is not a GeoJSON mapping: {shown(mapping)}")
    return mapping


def _wkt(text: str, place: str) -> Iterator[Found]:
    """One geometry after the other, each of one line or more."""
    pieces = list(_pieces(text))
    for line, piece in pieces:
        where = place if len(pieces) == 1 else f"{place} line {line}"
        try:
            with np.errstate(invalid="ignore"):
                geometry = shapely.from_wkt(piece)
        except (shapely.errors.GEOSException, NotImplementedError) as error:
            raise InvalidGeometry(f"{where} is neither WKT nor a .geojson, .json or .wkt file: {error}") from None
        yield from _parts(geometry, where)
    if not pieces:
        raise InvalidGeometry(f"{place} is empty: give WKT, e.g. POLYGON ((0 0, 1 0, 1 1, 0 0)), one after the other")


def _pieces(text: str) -> Iterator[tuple[int, str]]:
    """The geometries of a WKT text, each with its first line: one ends with a line that closes all its brackets."""
    begun, piece, depth = 0, "", 0
    for number, line in enumerate(text.splitlines(), 1):
        if line.strip():
            begun = begun if piece else number
            piece += f"{line.strip()} "
            depth += line.count("(") - line.count(")")
            if depth <= 0 and piece.endswith((") ", "EMPTY ")):
                yield begun, piece
                piece, depth = "", 0
    if piece:
        yield begun, piece


def _geojson(mapping: Any, place: str) -> Iterator[Found]:
    kind = mapping.get("type") if isinstance(mapping, Mapping) else mapping
    match kind if isinstance(mapping, Mapping) else None:
        case "FeatureCollection":
            for i, feature in enumerate(_members(mapping, "features", place)):
                yield from _geojson(feature, f"{place} feature {i}")
        case "Feature":
            if mapping.get("geometry") is not None:
                yield from _geojson(mapping["geometry"], place)
        case "GeometryCollection":
            for i, geometry in enumerate(_members(mapping, "geometries", place)):
                yield from _geojson(geometry, f"{place} geometry {i}")
        case str() if kind in SIMPLE or kind in COLLECTED:
            try:
                geometry = shapely.from_geojson(json.dumps(mapping, allow_nan=False))
            except (shapely.errors.GEOSException, TypeError, ValueError, RecursionError) as error:
                raise InvalidGeometry(f"{place} is not a GeoJSON {kind}: {error}") from None
            yield from _parts(geometry, place)
        case _:
            raise InvalidGeometry(f"{place} is GeoJSON of type {kind!r}: an obstacle is a {ACCEPTED}")


def _members(mapping: Mapping[str, Any], key: str, place: str) -> Iterable[Any]:
    members = mapping.get(key)
    if not isinstance(members, (list, tuple)):
        raise InvalidGeometry(f"{place} is a GeoJSON {mapping['type']} without a list of {key}")
    return members


def _parts(geometry: BaseGeometry, place: str) -> Iterator[Found]:
    match geometry.geom_type:
        case kind if kind in SIMPLE:
            yield shapely.force_2d(geometry), place
        case "LinearRing":
            yield shapely.LineString(shapely.force_2d(geometry)), place
        case kind if kind in COLLECTED or kind == "GeometryCollection":
            for i, part in enumerate(geometry.geoms):
                yield from _parts(part, f"{place} part {i}")
        case kind:
            raise InvalidGeometry(f"{place} is a {kind}: an obstacle is a {ACCEPTED}")


def _is_ring(source: Any) -> bool:
    """Whether it is one list of vertices: what its first element holds first is a number."""
    try:
        return isinstance(source[0][0], Real) and not isinstance(source[0], (Mapping, bytes))
    except (TypeError, IndexError, KeyError, ValueError):
        return False


def _ring(source: Any, place: str) -> shapely.Polygon:
    try:
        vertices = np.asarray(source, dtype=float)
    except (TypeError, ValueError, OverflowError):
        vertices = np.empty(0)
    if vertices.ndim != 2 or vertices.shape[1] != 2 or len(vertices) < 3:
        raise InvalidGeometry(f"{place} is not a polygon: it takes at least three vertices (x, y), got {source!r}")
    if not np.isfinite(vertices).all():
        raise InvalidGeometry(f"{place} has vertices that are not finite: {source!r}")
    return shapely.Polygon(vertices)


def _checked(geometry: BaseGeometry, place: str) -> BaseGeometry:
    kind = geometry.geom_type
    if geometry.is_empty:
        raise InvalidGeometry(f"{place} is empty: a {kind} has at least one vertex, a Polygon three")
    vertices = shapely.get_coordinates(geometry)
    if not np.isfinite(vertices).all():
        raise InvalidGeometry(f"{place} has vertices that are not finite")
    if np.abs(vertices).max() > FARTHEST:
        raise InvalidGeometry(f"{place} has vertices beyond {FARTHEST:g}: give lengths in a larger unit")
    if kind == "LineString" and not geometry.length > 0:
        raise InvalidGeometry(f"{place} is a line without length: give a Point")
    if kind != "Polygon":
        return geometry
    if not geometry.convex_hull.area > 0:
        raise InvalidGeometry(f"{place} has no area: a wall needs a thickness, or is a LineString")
    if not geometry.is_valid:
        why = shapely.is_valid_reason(geometry)
        raise InvalidGeometry(f"{place} is not a simple polygon ({why}); split it, or pass shapely.make_valid of it")
    return geometry


def _say_if_degrees(geometries: list[BaseGeometry], place: str) -> None:
    """Warn if coordinates look like longitudes and latitudes: less than a degree in all, and far from the origin."""
    if not geometries:
        return
    x_min, y_min, x_max, y_max = shapely.total_bounds(geometries)
    extent = max(x_max - x_min, y_max - y_min)
    if not 0 < extent < 1:
        return
    x, y = max(abs(x_min), abs(x_max)), max(abs(y_min), abs(y_max))
    if x <= 180 and y <= 90 and max(x, y) > FAR * extent:
        warn(
            f"the coordinates of {place} look like longitudes and latitudes, as GeoJSON's are: lengths are then in "
            "degrees; project them to metres first",
            LooksLikeDegrees,
        )
