"""What the page of Stewart platforms keeps."""

from __future__ import annotations

from dataclasses import dataclass

from pin_metaik.arguments import checked
from pin_metaik.errors import InvalidSetting

LONGEST = 200_000  # characters of a mechanism
FIRST = "stroke_100"


@checked
@dataclass(frozen=True)
class PlatformsState:
    """A mechanism and where its platform is.

    Attributes:
        mechanism: Its TOML; empty: the first of the catalogue.
        xyz: Position of P in the base frame, m; empty: level, with legs half extended.
        rpy: Roll, pitch, yaw of the platform, rad.
    """

    mechanism: str = ""
    xyz: tuple[float, ...] = ()
    rpy: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        if len(self.xyz) not in (0, 3):
            raise InvalidSetting(f"xyz has three numbers, got {len(self.xyz)}")
        if len(self.mechanism) > LONGEST:
            raise InvalidSetting(f"a mechanism has at most {LONGEST:,} characters")
