"""Robots: DH tables, URDF and Pinocchio models, by name or by file."""

from pin_metaik.robots.description import Description, description_of
from pin_metaik.robots.dh import DHRow, DHTable, Placement
from pin_metaik.robots.robot import Robot, RobotName, load_robot, robot_names
from pin_metaik.robots.table import read_table
from pin_metaik.robots.urdf import to_urdf, write_urdfs

__all__ = [
    "DHRow",
    "DHTable",
    "Description",
    "Placement",
    "Robot",
    "RobotName",
    "description_of",
    "load_robot",
    "read_table",
    "robot_names",
    "to_urdf",
    "write_urdfs",
]
