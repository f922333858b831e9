"""Robots by name: the DH tables of the catalogue, the files of example-robot-data, and their usual tips."""

from __future__ import annotations

from functools import cache
from importlib import resources
from pathlib import Path
from typing import NamedTuple

# Names of example-robot-data that are no robot here, and why.
LEFT_OUT = {
    "cassie": "it is an SDF with closed loops, which Pinocchio's wheels cannot read",
    "hector": "it is a flying body without a joint",
    "iris": "it is a flying body without a joint",
    "talos_legs": "it is the URDF of talos; load that, with left_sole_link or right_sole_link for its legs",
}

# The frame one means when none is named, where the names of links do not say it (see ``tips``).
TIPS = {
    "alex_sake_hands": "LeftGripperYawLink",
    "b1_z1": "link06",
    "pr2": "r_gripper_tool_frame",
    "talos": "gripper_left_base_link",
    "talos_arm": "gripper_left_base_link",
    "talos_box": "gripper_left_base_link",
    "talos_full": "gripper_left_base_link",
    "talos_full_box": "gripper_left_base_link",
    "z1": "link06",
}


class Files(NamedTuple):
    """Files of one robot.

    Attributes:
        urdf: Its description.
        srdf: Its reference configurations and disabled collisions, or None.
    """

    urdf: Path
    srdf: Path | None


def catalogue() -> dict[str, Path]:
    """The DH tables that come with the package, by name, sorted."""
    folder = Path(str(resources.files("pin_metaik.robots") / "catalog"))
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}


@cache
def example_robots() -> dict[str, Files]:
    """Every robot of example-robot-data that has a URDF with a joint, by name, sorted.

    The loaders package serves only as a table of file names: its loaders read every mesh at once, and put mobile
    robots on a free-flyer.
    """
    from example_robot_data import robots_loader

    loaders = {**robots_loader.ROBOTS, "ur3": robots_loader.UR3Loader}  # "ur3" is UR5Loader in loaders 5.0.0
    found = {}
    for name, loader in sorted(loaders.items()):
        if name in LEFT_OUT or not loader.urdf_filename:
            continue
        try:
            folder = Path(robots_loader.getModelPath(loader.path), loader.path).resolve()
        except OSError:  # the loaders know a robot that the installed data lacks
            continue
        urdf = folder / loader.urdf_subpath / loader.urdf_filename
        srdf = folder / loader.srdf_subpath / loader.srdf_filename
        if urdf.is_file():
            found[name] = Files(urdf, srdf if srdf.is_file() else None)
    return found
