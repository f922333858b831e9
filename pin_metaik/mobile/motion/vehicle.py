"""Limits of robots: synchro-drives, with independent speed and turning rate, and differential drives."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidSetting
from pin_metaik.files import known_keys, read_json
from pin_metaik.lookup import lookup
from pin_metaik.mobile.files import number

INCH = 0.0254  # m
STILL = 1e-12  # m/s; kept of the wheel speed for turning: negligible, and above zero, so that it can be divided by


@checked
@dataclass(frozen=True)
class SynchroDrive:
    """Wheels that roll and steer together: ``x' = v cos theta``, ``y' = v sin theta``, ``theta' = omega``, four limits.

    Attributes:
        name: What to call it.
        v_max: Largest speed, m/s.
        a_max: Largest acceleration, m/s^2.
        omega_max: Largest turning rate, rad/s.
        alpha_max: Largest angular acceleration, rad/s^2.
        radius: Radius of the circle around the robot, m.

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
        _limits(self, ("v_max", "a_max", "omega_max", "alpha_max"))

    @property
    def saturation(self) -> float:
        """The least angle of a turn, rad, in which the robot reaches its largest turning rate."""
        return self.omega_max**2 / self.alpha_max

    @property
    def coupled(self) -> bool:
        """Whether the largest turning rate depends on the speed."""
        return False

    def omega_at(self, v: ArrayLike) -> Array:
        """Largest turning rate (...), rad/s, at speeds v (...), m/s: the same at every speed."""
        return np.full(array("v", v, "...").shape, float(self.omega_max))


@checked
@dataclass(frozen=True)
class DifferentialDrive:
    """Two driven wheels on one axis: ``v = (r + l) / 2``, ``omega = (r - l) / track`` for their speeds r and l.

    Speed and turning rate share one limit, ``|v| + |omega| track / 2 <= wheel_speed``, and likewise the accelerations.

    Attributes:
        name: What to call it.
        track: Distance of the wheels, m.
        wheel_speed: Largest speed of a wheel over the ground, m/s: its rate in rad/s times its radius.
        wheel_acceleration: Largest acceleration of a wheel over the ground, m/s^2.
        radius: Radius of the circle around the robot, m, centred between the wheels.

    Raises:
        InvalidSetting: A limit that is not a number above zero, or a radius below zero.
    """

    name: str
    track: float
    wheel_speed: float
    wheel_acceleration: float
    radius: float

    def __post_init__(self) -> None:
        _limits(self, ("track", "wheel_speed", "wheel_acceleration"))

    @property
    def v_max(self) -> float:
        """Largest speed, m/s, straight ahead."""
        return self.wheel_speed

    @property
    def a_max(self) -> float:
        """Largest acceleration, m/s^2, straight ahead."""
        return self.wheel_acceleration

    @property
    def omega_max(self) -> float:
        """Largest turning rate, rad/s, on the spot."""
        return 2 * self.wheel_speed / self.track

    @property
    def alpha_max(self) -> float:
        """Largest angular acceleration, rad/s^2, at constant speed."""
        return 2 * self.wheel_acceleration / self.track

    @property
    def coupled(self) -> bool:
        """Whether the largest turning rate depends on the speed."""
        return True

    def omega_at(self, v: ArrayLike) -> Array:
        """Largest turning rate (...), rad/s, at speeds v (...), m/s, at which the outer wheel keeps its limit."""
        return np.asarray(2 * np.maximum(self.wheel_speed - np.abs(array("v", v, "...")), STILL) / self.track)

    def wheels(self, v: ArrayLike, omega: ArrayLike) -> Array:
        """Speeds (..., 2) of the left and right wheel over the ground, m/s; for accelerations, their accelerations.

        Args:
            v: Speed (...), m/s.
            omega: Turning rate (...), rad/s.
        """
        ahead = array("v", v, "...")
        across = array("omega", omega, *ahead.shape) * self.track / 2
        return np.stack((ahead - across, ahead + across), axis=-1)


Vehicle = SynchroDrive | DifferentialDrive


def _limits(vehicle: Vehicle, names: tuple[str, ...]) -> None:
    for limit in names:
        value = getattr(vehicle, limit)
        if not 0 < value < math.inf:
            raise InvalidSetting(f"{limit} must be a finite number above 0, not {value!r}")
    if not 0 <= vehicle.radius < math.inf:
        raise InvalidSetting(f"radius must be a finite number of at least 0, not {vehicle.radius!r}")


# The paper gives v_max = 40 in/s only. The rest: a_max and omega_max from the Player plugin for the Nomad 200 (V. Costa
# da Silva Campos 2008), alpha_max from TeamBots' limits of the Nomad 150 (T. Balch). Public drivers of the Nomad 200
# cap its speed at 20 in/s, half of what the paper uses: NOMAD_200_DRIVER is that robot, with the plugin's alpha_max.
NOMAD_200 = SynchroDrive("nomad200", 40 * INCH, 30 * INCH, math.radians(45), math.radians(50), 0.23)
NOMAD_200_DRIVER = SynchroDrive("nomad200_driver", 20 * INCH, 30 * INCH, math.radians(45), math.radians(30), 0.23)

# ROBOTIS' data sheets: 0.22 and 0.26 m/s. Wheels of 33 mm radius 160 and 287 mm apart: burger.yaml and waffle.yaml in
# turtlebot3_bringup/param of github.com/ROBOTIS-GIT/turtlebot3. The sheets' 2.84 and 1.82 rad/s are these wheels on the
# spot at full speed (2.75 and 1.81), so that both at once would ask for twice as much. The sheets give no acceleration:
# 1 m/s^2 is max_linear_acceleration of ROBOTIS' Gazebo models (turtlebot3_simulations); radii are robot_radius of its
# settings of nav2 (turtlebot3_navigation2/param).
TURTLEBOT3_BURGER = DifferentialDrive("turtlebot3_burger", 0.160, 0.22, 1.0, 0.105)
TURTLEBOT3_WAFFLE = DifferentialDrive("turtlebot3_waffle", 0.287, 0.26, 1.0, 0.22)

VEHICLES: dict[str, Vehicle] = {
    vehicle.name: vehicle for vehicle in (NOMAD_200, NOMAD_200_DRIVER, TURTLEBOT3_BURGER, TURTLEBOT3_WAFFLE)
}


LIMITS = ("v_max", "a_max", "omega_max", "alpha_max", "radius")
WHEELS = ("track", "wheel_speed", "wheel_acceleration", "radius")


@checked
def load_vehicle(source: str | Path) -> Vehicle:
    """A robot by name, or from a JSON file.

    Args:
        source: ``nomad200``, ``nomad200_driver``, ``turtlebot3_burger``, ``turtlebot3_waffle``, or the path of a
            ``.json``: of a differential drive with track, wheel_speed, wheel_acceleration (m) and radius; of a
            synchro-drive with any of v_max, a_max, omega_max, alpha_max (m and rad) and radius; values left out are
            those of the Nomad 200.

    Raises:
        UnknownName: There is no robot of that name.
        InvalidSetting: The file is missing or malformed, or a limit makes no sense.
    """
    if Path(source).suffix.lower() == ".json":
        return _read(Path(source))
    return lookup("vehicle", str(source), VEHICLES)


def _read(path: Path) -> Vehicle:
    given = read_json(path, InvalidSetting)
    wheeled = isinstance(given, dict) and any(key in given for key in WHEELS[:3])
    keys = WHEELS if wheeled else LIMITS
    if not isinstance(given, dict):
        raise InvalidSetting(f"{path} is not a vehicle: expected an object with {', '.join(LIMITS)}")
    known_keys(given, path, InvalidSetting, (), ("name", *keys))
    name = str(given.get("name", path.stem))
    values = {key: number(given, key, str(path), InvalidSetting) for key in keys if key in given}
    if not wheeled:
        return replace(NOMAD_200, name=name, **values)
    if missing := [key for key in WHEELS if key not in values]:
        raise InvalidSetting(f"{path}: a differential drive has {', '.join(WHEELS)}; missing: {', '.join(missing)}")
    return DifferentialDrive(name, **values)
