"""The planners of others by name: one line each."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from pin_metaik.mobile.paths.planners.grid import GridAStar
from pin_metaik.mobile.paths.planners.protocol import PathPlanner
from pin_metaik.mobile.paths.planners.sampling import RandomTree, Roadmap

PLANNERS: dict[str, Callable[[], PathPlanner]] = {
    "astar": GridAStar,
    "rrt": partial(RandomTree, "RRT"),
    "rrtconnect": partial(RandomTree, "RRTConnect"),
    "rrtstar": partial(RandomTree, "RRTstar"),
    "informed": partial(RandomTree, "InformedRRTstar"),
    "prm": Roadmap,
}
