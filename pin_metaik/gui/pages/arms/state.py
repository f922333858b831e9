"""What the page of arms keeps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from pin_metaik.arguments import checked
from pin_metaik.errors import InvalidSetting
from pin_metaik.gui.look.pieces import Drawn
from pin_metaik.optimize.settings import one_of

LONGEST = 2_000_000  # characters of a table or a URDF


@checked
@dataclass(frozen=True)
class ArmsState:
    """A robot, where it shall be, and what stands around it.

    Attributes:
        robot: Name of a robot, if neither of the next two is given.
        table: TOML of a DH table.
        urdf: Text of a URDF.
        parameters: Values in place of those of the table.
        drawn: How the robot is drawn.
        orientation: Whether the target's orientation counts.
        avoid: Whether the robot must not collide.
        target: x, y, z (m) and quaternion x, y, z, w of the target; empty: where the robot is.
        q: Configuration (nq,); empty: the chain's reference.
        obstacles: As a scene's file has them.
    """

    robot: str = "panda"
    table: str = ""
    urdf: str = ""
    parameters: Mapping[str, float] = field(default_factory=dict)
    drawn: Drawn = "links"
    orientation: bool = True
    avoid: bool = False
    target: tuple[float, ...] = ()
    q: tuple[float, ...] = ()
    obstacles: tuple[Mapping[str, Any], ...] = ()

    def __post_init__(self) -> None:
        one_of("drawn", self.drawn, Drawn)
        if len(self.target) not in (0, 7):
            raise InvalidSetting(f"target has x, y, z and a quaternion x, y, z, w, got {len(self.target)} numbers")
        if max(len(self.table), len(self.urdf)) > LONGEST:
            raise InvalidSetting(f"a table or a URDF has at most {LONGEST:,} characters")
