"""The settings of a design: weights of the fitness, and the budget of the search."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal, TypeAlias

from pin_metaik.arguments import checked
from pin_metaik.errors import InvalidSetting
from pin_metaik.optimize import Metaheuristic, make
from pin_metaik.optimize.pso import PSO
from pin_metaik.optimize.settings import one_of, whole, within
from pin_metaik.stewart.mechanism.ranges import Ranges
from pin_metaik.stewart.workspace.grid import Grid

Index: TypeAlias = Literal["gdi", "lci"]


@checked
@dataclass(frozen=True)
class DesignTask:
    """The settings of a design: maximise ``weights[0] D + weights[1] V / cube^3``.

    With the index ``"gdi"`` (a new mechanism) D is the GDI and V the volume the platform reaches. With ``"lci"`` (more
    dexterous workspace for an existing one) only poses with nu >= threshold count: D is their share of the poses
    reached and V their volume. With several orientations, V is the mean over them; at a single position, V / cube^3 is
    the share of the orientations.

    A design with joints closer than ``joint_gap``, with legs that are longer retracted than extended, with a workspace
    that is empty or smaller than ``least_workspace``, or with a singularity in it is infeasible, and always worse than
    a feasible one.

    Attributes:
        ranges: Ranges of the dimensions that may change.
        index: ``"gdi"`` or ``"lci"``.
        threshold: Least nu of a dexterous pose, for the index ``"lci"``.
        weights: Weights of dexterity and workspace. The paper prints 78 % and 12 %; the second is read as 22 %.
        cube: Side in m of a cube whose volume counts as 1. The paper does not say how it made volumes comparable;
            None: twice the longest stroke within the ranges; with servos, four horns.
        least_workspace: Lower bound of V / cube^3. Without it, and with much weight on dexterity, the best workspace
            may be tiny: for stroke 150 and the paper's weights one of 6 cm3 beats one of 2800 cm3.
        joint_gap: Least distance between the centres of neighbouring joints, m.
        grid: Poses on which designs are compared. It is coarse, because thousands of designs are evaluated.
        algorithm: A metaheuristic's name or object; the default is the paper's swarm of 60.
        evaluations: How many designs to evaluate; the default is the paper's 60 generations of 60.
        seed: Seed of every random choice.
        from_current: Whether the current mechanism is one of the designs that the search starts from.

    Raises:
        InvalidSetting: A weight below zero, both zero, or another setting outside its range.
        UnknownName: No metaheuristic of that name.
    """

    ranges: Ranges
    index: Index = "gdi"
    threshold: float = 0.5
    weights: tuple[float, float] = (0.78, 0.22)
    cube: float | None = None
    least_workspace: float = 0.0
    joint_gap: float = 0.0
    grid: Grid = field(default=Grid((14, 14, 14)))
    algorithm: str | Metaheuristic = field(default=PSO(agents=60))
    evaluations: int = 3600
    seed: int = 0
    from_current: bool = False

    def __post_init__(self) -> None:
        one_of("index", self.index, Index)
        within("threshold", self.threshold, 0.0, 1.0)
        if not isinstance(self.weights, (tuple, list)) or len(self.weights) != 2:
            raise InvalidSetting(f"weights are two numbers, of dexterity and workspace, got {self.weights!r}")
        for weight in self.weights:
            within("a weight", weight, 0.0, 1e6)
        if sum(self.weights) == 0.0:
            raise InvalidSetting("one of the weights is above zero, got 0 and 0")
        object.__setattr__(self, "weights", (float(self.weights[0]), float(self.weights[1])))
        if self.cube is not None and not self.cube > 0.0:
            raise InvalidSetting(f"cube is a length above zero in m, got {self.cube!r}")
        within("least_workspace", self.least_workspace, 0.0, 1e6)
        within("joint_gap", self.joint_gap, 0.0, 1e6)
        make(self.algorithm)
        whole("evaluations", self.evaluations, 1)
        whole("seed", self.seed, 0)
        if not isinstance(self.from_current, bool):
            raise InvalidSetting(f"from_current is True or False, got {self.from_current!r}")
