"""How good a design is: Eq. 10-11 weighed against the volume, and by how much a design that makes no sense fails."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidSetting
from pin_metaik.stewart.mechanism.mechanism import Mechanism
from pin_metaik.stewart.mechanism.ranges import Dimensions, Variables
from pin_metaik.stewart.mechanism.task import DesignTask
from pin_metaik.stewart.platform.geometry import Geometry, chords, gaps
from pin_metaik.stewart.platform.limits import LegLimits, Limits, excess
from pin_metaik.stewart.platform.servos import turned
from pin_metaik.stewart.platform.states import PoseState
from pin_metaik.stewart.workspace.surveying import explored, with_best_length
from pin_metaik.stewart.workspace.workspace import Workspace

UNUSABLE = 1.0  # cost of a singular, small or empty workspace, before counting how much of it is; others cost at most 0
UNBUILDABLE = 3.0  # cost of legs or joints that are in each other's way, before counting by how much
CELLS = 150
"""Cells that must be reached for a design to be compared by them: they measure a volume to a few percent."""
FINE_CELLS = 2000
"""Cells by which a design is measured before it counts as the best: a volume is good to a percent."""
POSES, FINE_POSES = 300_000, 4_000_000
"""Poses of the finest grids that are laid for these."""


@dataclass(frozen=True)
class Score:
    """The fitness of a workspace and its two parts.

    Attributes:
        fitness: The weighted sum, which is maximised.
        dexterity: D, 0 ... 1.
        workspace: V / cube^3.
    """

    fitness: float
    dexterity: float
    workspace: float


@checked
class Fitness:
    """The objective of a design: costs (k,) of points (k, v); the cost of a feasible design is minus its fitness.

    Attributes:
        variables: The mapping between points of the search and dimensions.
        cube: Side in m of the cube whose volume counts as 1.
    """

    def __init__(self, mechanism: Mechanism) -> None:
        """The objective of this mechanism's task.

        Raises:
            InvalidSetting: The mechanism has no task, or no stroke to make volumes comparable with.
            InvalidBounds: Ranges that do not fit the mechanism.
        """
        self.mechanism, self.task = mechanism, task_of(mechanism)
        self.variables = Variables.of(self.task.ranges, mechanism.geometry, mechanism.limits)
        self.cube = self.task.cube or 2.0 * self.variables.longest_stroke
        if not self.cube > 0.0:
            raise InvalidSetting("these legs have no stroke: give the design a cube for volumes to be measured by")

    def __call__(self, X: Array) -> Array:
        """Costs (k,) of the designs at points X (k, v)."""
        return np.array([self.cost(x) for x in array("X", X, "k", self.variables.box.dimension)])

    def cost(self, x: Array, *, fine: bool = False) -> float:
        """Minus the fitness; for infeasible designs 1 to 2, 2 with an empty workspace, more if it cannot be built.

        A workspace too thin to be measured by the finest grid is infeasible.

        Args:
            x: The design (v,).
            fine: Whether to measure its workspace with a few thousand cells instead of a few hundred.
        """
        dimensions = self.variables.dimensions(array("x", x, self.variables.box.dimension))
        if missing := self.missing(dimensions):
            return UNBUILDABLE + missing / self.cube
        workspace = self.workspace(*self.build(dimensions), fine=fine)
        if not workspace.regular.any():
            return UNUSABLE + 1.0
        if (wrong := _wrong_side(workspace)) > 0.0:
            return UNUSABLE + wrong
        if max(workspace.cells.shape[:3]) > 1 and workspace.cells_reached < CELLS:
            return UNUSABLE + 1.0 - workspace.cells_reached / CELLS
        score, least = self.score(workspace), self.task.least_workspace
        return UNUSABLE + 1.0 - score.workspace / least if score.workspace < least else -score.fitness

    @checked
    def missing(self, dimensions: Dimensions) -> float:
        """By how much, m, the joints miss their gap and the legs their stroke in sum; 0 if a design can be built."""
        between = np.concatenate(
            [
                gaps(joints) if len(joints) else chords(radius, angles)
                for joints, radius, angles in (
                    (dimensions.base, dimensions.base_radius, dimensions.base_angles),
                    (dimensions.platform, dimensions.platform_radius, dimensions.platform_angles),
                )
            ]
        )
        short = np.maximum(self.task.joint_gap - between, 0.0).sum() + max(
            dimensions.shortest - dimensions.longest, 0.0
        )
        if isinstance(limits := self.mechanism.limits, LegLimits) and limits.dead_length is not None:
            short += excess(dimensions.shortest, dimensions.longest, limits.dead_length)
        return float(short) if between.min() > 0.0 else float(short) + self.cube

    @checked
    def build(self, dimensions: Dimensions) -> tuple[Geometry, Limits]:
        """The platform with these dimensions.

        Raises:
            InvalidGeometry: If it cannot be built (``missing`` is above 0).
        """
        geometry, limits = self.mechanism.geometry, self.mechanism.limits
        servos = geometry.servos
        if servos is not None:
            own = {name: getattr(dimensions, name).tolist() for name in ("horn", "rod", "directions")}
            horn, rod = (each[0] if len(each) == 1 else tuple(each) for each in (own["horn"], own["rod"]))
            servos = replace(servos, horn=horn, rod=rod, directions=tuple(own["directions"]))
            if dimensions.base_angles.size:
                gone = dimensions.base_angles - geometry.base_angles
                servos = turned(servos, gone[[base for base, _ in geometry.legs]])
        geometry = replace(
            geometry,
            base_radius=dimensions.base_radius,
            platform_radius=dimensions.platform_radius,
            base_angles=tuple(dimensions.base_angles.tolist()),
            platform_angles=tuple(dimensions.platform_angles.tolist()),
            base=tuple(map(tuple, dimensions.base.tolist())) or None,
            platform=tuple(map(tuple, dimensions.platform.tolist())) or None,
            servos=servos,
        )
        if isinstance(limits, LegLimits):
            limits = replace(limits, shortest=dimensions.shortest, longest=dimensions.longest)
        return geometry, limits

    @checked
    def workspace(self, geometry: Geometry, limits: Limits, *, fine: bool = False) -> Workspace:
        """The workspace on the task's grid, or on a finer one in its ranges if too few of its cells are reached.

        Unlike that of ``survey`` it may be empty.
        """
        least, most = (FINE_CELLS, FINE_POSES) if fine else (CELLS, POSES)
        found, _ = explored(geometry, limits, self.task.grid, self.mechanism.dexterity, least, most)
        return with_best_length(found)

    @checked
    def score(self, workspace: Workspace) -> Score:
        """The fitness of a workspace without singularities, and its two parts."""
        counted = workspace.reached
        dexterity = float(workspace.nu[workspace.regular].mean())
        if self.task.index == "lci":
            counted = workspace.dexterous(self.task.threshold)
            dexterity = float(counted.sum() / workspace.reached.sum())
        volume = float(counted.sum()) * workspace.cells.volume / len(workspace.cells.rpy)
        share = volume / self.cube**3 if workspace.cells.volume > 0.0 else float(counted.mean())
        dexterous, large = self.task.weights
        return Score(dexterous * dexterity + large * share, dexterity, share)


def task_of(mechanism: Mechanism) -> DesignTask:
    """The mechanism's task.

    Raises:
        InvalidSetting: It has none.
    """
    if mechanism.task is None:
        raise InvalidSetting(f"{mechanism.name} has no design settings: give it a task, or its file a [design] table")
    return mechanism.task


def _wrong_side(workspace: Workspace) -> float:
    """Share of the poses that are singular, or on the side of a singularity where fewer are."""
    counts = workspace.counts
    positive, negative = counts.get(PoseState.POSITIVE, 0), counts.get(PoseState.NEGATIVE, 0)
    return (min(positive, negative) + counts.get(PoseState.SINGULAR, 0)) / int(workspace.reached.sum())
