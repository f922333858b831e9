"""The robots that laws of kinematics and inverse kinematics are tested on."""

from functools import cache

import pin_metaik as mik

CATALOGUE = ["rv7fl_paper", "rv7fl", "aerial_arm", "puma_offset", "puma560", "cobra600"]
ARMS = ["panda", "ur5", "ur10", "kinova", "tiago", "baxter", "pr2", "talos", "talos_arm", "xarm7", "z1"]


@cache
def chain_of(name: str) -> mik.Chain:
    """A robot's chain to its default frame, built once a process."""
    robot = mik.load_robot(name)
    return mik.Chain(robot.model, robot.frame)
