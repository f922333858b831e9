"""The compiled loops under one roof. Importing it takes half a second: ``Chain`` does so when the first one is made."""

from pin_metaik.kinematics.branches import all_branches
from pin_metaik.kinematics.direct import solve_directly
from pin_metaik.kinematics.guesses import gains_of
from pin_metaik.kinematics.kernels import costs, poses
from pin_metaik.kinematics.lane import POSITION, distances, is_out_of_reach, settle_pose, solve_pose, solve_poses
from pin_metaik.kinematics.packing import pack
from pin_metaik.kinematics.searches import descend, descend_all, linearize, neighbours

__all__ = [
    "POSITION",
    "all_branches",
    "costs",
    "descend",
    "descend_all",
    "distances",
    "gains_of",
    "is_out_of_reach",
    "linearize",
    "neighbours",
    "pack",
    "poses",
    "settle_pose",
    "solve_directly",
    "solve_pose",
    "solve_poses",
]
