"""A mechanism as one keeps it in a file: a platform, its limits, and the settings it is analysed and designed with."""

from __future__ import annotations

from dataclasses import dataclass, field

from pin_metaik.arguments import checked
from pin_metaik.errors import InvalidSetting
from pin_metaik.stewart.kinematics.conditioning import Dexterity
from pin_metaik.stewart.mechanism.task import DesignTask
from pin_metaik.stewart.mechanism.units import Coordinate
from pin_metaik.stewart.platform.geometry import Geometry
from pin_metaik.stewart.platform.limits import Limits, fit
from pin_metaik.stewart.workspace.grid import Grid
from pin_metaik.stewart.workspace.surveying import survey
from pin_metaik.stewart.workspace.workspace import Workspace
from pin_metaik.units import ANGLES, LENGTHS
from pin_metaik.watching import Watch


@checked
@dataclass(frozen=True)
class Mechanism:
    """A named platform with its limits and the settings of its analysis and design.

    Attributes:
        name: Its name.
        geometry: Joints and legs.
        limits: Limits of the legs: ``LegLimits`` for linear actuators, ``ServoLimits`` for servos.
        grid: Grid of poses for its workspace.
        dexterity: How its dexterity is measured.
        task: Settings of its design; None for a mechanism that is only analysed.
        unit: The unit of length its file is written in: m, cm or mm. Everything here is in m.
        description: A sentence about it.
        source: Where its numbers were published.

    Raises:
        InvalidSetting: No name, or no unit of that name.
        InvalidGeometry: Limits of the other kind of legs.
    """

    name: str
    geometry: Geometry
    limits: Limits
    grid: Grid = field(default=Grid())
    dexterity: Dexterity = field(default=Dexterity())
    task: DesignTask | None = None
    unit: str = "mm"
    description: str = ""
    source: str = ""

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not self.name.strip():
            raise InvalidSetting(f"a mechanism has a name, got {self.name!r}")
        if self.unit not in LENGTHS:
            raise InvalidSetting(f"unit is one of {', '.join(LENGTHS)}, got {self.unit!r}")
        fit(self.limits, self.geometry)

    @property
    def metres(self) -> float:
        """Its unit of length in m."""
        return float(LENGTHS[self.unit].factor)

    @property
    def coordinate(self) -> Coordinate:
        """How coordinates of its legs are displayed: lengths in its unit, or angles of servos in degrees."""
        word = self.geometry.actuation.words.coordinate
        if self.geometry.servos is None:
            return Coordinate(word, self.unit, self.metres)
        return Coordinate(word, "deg", float(ANGLES["deg"].factor))

    @checked
    def survey(self, *, watch: Watch | None = None) -> Workspace:
        """Its workspace, by its own settings; see ``survey``."""
        return survey(self.geometry, self.limits, self.grid, self.dexterity, watch=watch)
