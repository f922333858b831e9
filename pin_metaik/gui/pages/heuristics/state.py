"""What the page of metaheuristics keeps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, Literal

from pin_metaik.arguments import checked
from pin_metaik.compare.papers.path_planning_setup import ITERATIONS, SETTINGS
from pin_metaik.compare.papers.puma_offset import EXAMPLES, METHODS
from pin_metaik.gui.pages.algorithms import made
from pin_metaik.optimize.settings import few, one_of, whole, within

Problem = Literal["path", "arm"]
RANDOM = "random"
WIDTH = 10.0  # of the paper's workspace
PENALTY_17 = 1000.0 / WIDTH  # its penalty in Fig. 17, in widths


@checked
@dataclass(frozen=True)
class HeuristicsState:
    """A problem and what searches.

    Attributes:
        problem: A path among obstacles, or the joints of an arm.
        scene: Name of a map, or random.
        obstacles: Of a random map.
        scene_seed: Of a random map.
        via: Via points of the path.
        fitness: ``paper`` or ``exact``.
        penalty: Collision constant, in widths of the workspace.
        robot: Name of the arm.
        parameters: Of its DH table.
        goal: x, y, z of its tip, m.
        p: Penalty of its distance.
        algorithm: Name.
        settings: Those that were changed.
        against: Name of the one beside it.
        against_settings: Its settings that were changed.
        iterations: Generations of the first one's population.
        seed: Of every random choice.
        pause: s between two generations.
    """

    problem: Problem = "path"
    scene: str = "ten_obstacles"
    obstacles: int = 10
    scene_seed: int = 0
    via: int = 2
    fitness: str = "paper"
    penalty: float = 12.0
    robot: str = "puma_offset"
    parameters: Mapping[str, float] = field(default_factory=dict)
    goal: tuple[float, float, float] = (5.0, 5.0, 10.0)
    p: float = 1000.0
    algorithm: str = "ga"
    settings: Mapping[str, Any] = field(default_factory=dict)
    against: str = "pso"
    against_settings: Mapping[str, Any] = field(default_factory=dict)
    iterations: int = 100
    seed: int = 0
    pause: float = 0.0

    def __post_init__(self) -> None:
        one_of("problem", self.problem, Problem)
        one_of("fitness", self.fitness, Literal["paper", "exact"])
        few("iterations", self.iterations)
        few("obstacles", self.obstacles, 0)
        few("via", self.via)
        whole("seed", self.seed, 0)
        whole("scene_seed", self.scene_seed, 0)
        within("pause", self.pause, 0, 10)
        made(self.algorithm, self.settings)
        made(self.against, self.against_settings)


def figure_17() -> HeuristicsState:
    """The paper's first example: GA, 10 obstacles, two via points, 100 x 100 (Toz et al. 2011, Fig. 17)."""
    setting = SETTINGS["10 obstacles"]
    settings = asdict(setting.algorithm("GA"))  # type: ignore[call-overload]
    return HeuristicsState(
        scene=setting.scene, via=setting.via, penalty=PENALTY_17, settings=settings, iterations=ITERATIONS
    )


def figure_18() -> HeuristicsState:
    """Its second: PSO on the Puma, h = 10, d1 = 4, l = 5, to (5, 5, 10), 100 x 100 (Fig. 18)."""
    example = EXAMPLES["Example B"]
    return HeuristicsState(
        problem="arm",
        parameters=example.lengths,
        goal=example.goal,
        p=example.p,
        algorithm="pso",
        settings=asdict(METHODS["PSO"]),  # type: ignore[call-overload]
        against="ga",
        iterations=example.iterations,
    )


PAPER: dict[str, Any] = {"Fig. 17: GA, 10 obstacles": figure_17, "Fig. 18: PSO on the Puma": figure_18}
"""The examples of the paper, ready to run."""
