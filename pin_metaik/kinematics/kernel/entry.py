"""The compiled loops under one roof. Importing it takes half a second: ``Chain`` does so when the first one is made."""

from pin_metaik.kinematics.kernel.closed_form import all_branches
from pin_metaik.kinematics.kernel.direct import solve_directly
from pin_metaik.kinematics.kernel.forward import costs, poses
from pin_metaik.kinematics.kernel.layout import pack
from pin_metaik.kinematics.kernel.multistart import descend, descend_all, linearize, neighbours
from pin_metaik.kinematics.kernel.pose_solver import (
    POSITION,
    distances,
    is_out_of_reach,
    settle_pose,
    solve_pose,
    solve_poses,
)
from pin_metaik.kinematics.kernel.warm_starts import gains_of

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
