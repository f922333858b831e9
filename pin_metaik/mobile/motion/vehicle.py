"""Synchro-drive robots: all wheels roll and steer together, so speed and turning rate are free of each other."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path

from pin_metaik.arguments import checked
from pin_metaik.errors import InvalidSetting
from pin_metaik.files import known_keys, read_json
from pin_metaik.lookup import lookup
from pin_metaik.mobile.files import number

INCH = 0.0254  # m


@checked
@dataclass(frozen=True)
class SynchroDrive:
    """What a robot can do: ``x' = v cos theta``, ``y' = v sin theta``, ``theta' = omega``, and four limits.

    Attributes:
        name: What to call it.
        v_max: Largest speed, m/s.
        a_max: Largest acceleration, m/s^2.
        omega_max: Largest turning rate, rad/s.
        alpha_max: Largest angular acceleration, rad/s^2.
        radius: Of the circle around it, m.

    Raises:
        InvalidSetting: A limit that is not a number above zero, or a radius below zero.
    """

    name: str
    v_max: float
    a_max: float
    omega_max: float
    alpha_max: float
    radius: float

    def __post_init__(self) -> None:
        for limit in ("v_max", "a_max", "omega_max", "alpha_max"):
            value = getattr(self, limit)
            if not 0 < value < math.inf:
                raise InvalidSetting(f"{limit} must be a finite number above 0, not {value!r}")
        if not 0 <= self.radius < math.inf:
            raise InvalidSetting(f"radius must be a finite number of at least 0, not {self.radius!r}")

    @property
    def saturation(self) -> float:
        """The turn, in rad, from which on the robot reaches its largest turning rate."""
        return self.omega_max**2 / self.alpha_max


# The paper gives v_max = 40 in/s only. The rest: a_max and omega_max from the Player plugin for the Nomad 200 (V. Costa
# da Silva Campos 2008), alpha_max from TeamBots' limits of the Nomad 150 (T. Balch). Public drivers of the Nomad 200
# cap its speed at 20 in/s, half of what the paper uses: NOMAD_200_DRIVER is that robot, with the plugin's alpha_max.
NOMAD_200 = SynchroDrive("nomad200", 40 * INCH, 30 * INCH, math.radians(45), math.radians(50), 0.23)
NOMAD_200_DRIVER = SynchroDrive("nomad200_driver", 20 * INCH, 30 * INCH, math.radians(45), math.radians(30), 0.23)

VEHICLES = {vehicle.name: vehicle for vehicle in (NOMAD_200, NOMAD_200_DRIVER)}


LIMITS = ("v_max", "a_max", "omega_max", "alpha_max", "radius")


@checked
def load_vehicle(source: str | Path) -> SynchroDrive:
    """A robot by name, or from a JSON file.

    Args:
        source: ``nomad200``, ``nomad200_driver``, or the path of a ``.json`` with any of v_max, a_max, omega_max,
            alpha_max (m and rad) and radius; what it leaves out is the Nomad 200's.

    Raises:
        UnknownName: None of that name.
        InvalidSetting: The file is missing or malformed, or a limit makes no sense.
    """
    if Path(source).suffix.lower() == ".json":
        return _read(Path(source))
    return lookup("vehicle", str(source), VEHICLES)


def _read(path: Path) -> SynchroDrive:
    given = read_json(path, InvalidSetting)
    if not isinstance(given, dict):
        raise InvalidSetting(f"{path} is not a vehicle: expected an object with {', '.join(LIMITS)}")
    known_keys(given, path, InvalidSetting, (), ("name", *LIMITS))
    limits = {key: number(given, key, str(path), InvalidSetting) for key in LIMITS if key in given}
    return replace(NOMAD_200, name=str(given.get("name", path.stem)), **limits)
