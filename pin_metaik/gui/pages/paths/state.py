"""What the page of path planning keeps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from pin_metaik.arguments import checked
from pin_metaik.gui.pages.algorithms import made
from pin_metaik.lookup import lookup
from pin_metaik.mobile import VEHICLES, Scene
from pin_metaik.mobile.motion.result import Method
from pin_metaik.mobile.world.scene import scene_of
from pin_metaik.optimize.settings import few, one_of, whole, within

FIRST: Mapping[str, Any] = {
    "start": (0.5, 0.5),
    "goal": (9.5, 9.5),
    "bounds": (0.0, 0.0, 10.0, 10.0),
    "obstacles": (((3.0, 2.0), (5.0, 2.5), (4.5, 6.0), (2.5, 5.0)), ((6.0, 5.0), (8.0, 4.5), (8.5, 8.0), (6.5, 7.5))),
}


@checked
@dataclass(frozen=True)
class PathsState:
    """A map, a robot and what searches.

    Attributes:
        scene: As a scene's JSON file has it.
        radius: Of the robot, m.
        margin: That its path keeps on top of that, m.
        algorithm: Name of the metaheuristic beside the exact planner.
        settings: Those of it that were changed.
        via: Via points.
        fitness: ``exact`` or ``paper``.
        penalty: Collision constant, in widths of the workspace.
        iterations: Generations.
        seed: Of every random choice.
        vehicle: Whose limits the motion keeps.
        speeds: How its speeds are found: ``dp``, ``de`` or ``ann``.
        hand: Via points of the way by hand, m.
        ways: Ways round that are looked for.
    """

    scene: Mapping[str, Any] = field(default_factory=lambda: dict(FIRST))
    radius: float = 0.23
    margin: float = 0.1
    algorithm: str = "pso"
    settings: Mapping[str, Any] = field(default_factory=dict)
    via: int = 3
    fitness: str = "exact"
    penalty: float = 12.0
    iterations: int = 100
    seed: int = 0
    vehicle: str = "nomad200"
    speeds: Method = "dp"
    hand: tuple[tuple[float, float], ...] = ()
    ways: int = 3

    def __post_init__(self) -> None:
        within("radius", self.radius, 0)
        within("margin", self.margin, 0)
        few("via", self.via)
        few("iterations", self.iterations)
        few("ways", self.ways)
        one_of("speeds", self.speeds, Method)
        whole("seed", self.seed, 0)
        one_of("fitness", self.fitness, Literal["paper", "exact"])
        lookup("vehicle", self.vehicle, VEHICLES)
        made(self.algorithm, self.settings)
        _ = self.world

    @property
    def world(self) -> Scene:
        """The map.

        Raises:
            InvalidGeometry: It makes no sense.
        """
        return scene_of(self.scene, "the map")
