"""The mobile robot in Pinocchio: a planar joint and a cylinder, so that it moves in the same viewer as the arms."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arguments import checked
from pin_metaik.mobile.motion.trajectory import Samples
from pin_metaik.mobile.motion.vehicle import Vehicle
from pin_metaik.robots import Description, Robot

HEIGHT = 0.8  # m, the Nomad 200's; where it matters to somebody it is an argument
SMALLEST = 0.05  # m; a robot without a radius is drawn with this one

URDF = """<?xml version="1.0"?>
<robot name="{name}">
  <link name="base">
    <visual>
      <origin xyz="0 0 {middle}"/>
      <geometry><cylinder radius="{radius}" length="{height}"/></geometry>
      <material name="body"><color rgba="0.35 0.40 0.47 1"/></material>
    </visual>
    <visual>
      <origin xyz="{nose} 0 {height}"/>
      <geometry><box size="{radius} {width} {width}"/></geometry>
      <material name="nose"><color rgba="0.84 0.37 0.00 1"/></material>
    </visual>
    <collision>
      <origin xyz="0 0 {middle}"/>
      <geometry><cylinder radius="{radius}" length="{height}"/></geometry>
    </collision>
  </link>
</robot>
"""


@checked
def mobile_robot(vehicle: Vehicle, height: float = HEIGHT) -> Robot:
    """The robot as a Pinocchio model; its frame ``base`` is on the floor below its centre, with x ahead.

    Its configuration is (x, y, cos heading, sin heading), its velocity (forwards, sideways, turning) in its own frame.

    Args:
        vehicle: The robot.
        height: Height of its cylinder, m.
    """
    radius = max(vehicle.radius, SMALLEST)
    numbers = {"middle": height / 2, "height": height, "radius": radius, "nose": radius / 2, "width": radius / 4}
    urdf = URDF.format(name=vehicle.name, **{key: f"{value:.6g}" for key, value in numbers.items()})
    description = Description(urdf, Path(__file__), base="planar")
    return Robot(vehicle.name, description.model(), "base", description)


@checked
def configurations(samples: Samples) -> NDArray[np.float64]:
    """Pinocchio's configurations (n, 4) along a trajectory."""
    return np.column_stack((samples.x, samples.y, np.cos(samples.heading), np.sin(samples.heading)))


@checked
def velocities(samples: Samples) -> NDArray[np.float64]:
    """Pinocchio's velocities (n, 3) along a trajectory, in the robot's own frame."""
    return np.column_stack((samples.v, np.zeros_like(samples.v), samples.omega))
