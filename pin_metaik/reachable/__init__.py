"""The workspace of a chain: maps of reachable positions and orientations, and the best place for its base."""

from pin_metaik.reachable.grid import Grid, spread_rotations
from pin_metaik.reachable.picture import draw_reachability, save_reachability
from pin_metaik.reachable.place import BasePlacement, place_base
from pin_metaik.reachable.result import Reachability
from pin_metaik.reachable.survey import reachability

__all__ = [
    "BasePlacement",
    "Grid",
    "Reachability",
    "draw_reachability",
    "place_base",
    "reachability",
    "save_reachability",
    "spread_rotations",
]
