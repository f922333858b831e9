"""Global inverse kinematics for Pinocchio that decides: it solves what is reachable, and proves what is unreachable.

import pin_metaik as mik

robot = mik.load_robot("panda")
chain = mik.Chain(robot.model, robot.frame)
result = mik.solve_ik(chain, target)      # pin.SE3, 4x4, a position (3,) or a mik.Target
result.success, result.q, result.status
"""

from pin_metaik.collision import CollisionWorld
from pin_metaik.errors import MetaIKError
from pin_metaik.ik import (
    DLS,
    REFINERS,
    IKBatch,
    IKChoice,
    IKPath,
    IKProblem,
    IKResult,
    IKSolutions,
    IKSolver,
    IKStatus,
    Proof,
    Refinement,
    Refiner,
    SelfMotionCurve,
    SelfMotions,
    Target,
    Weighted,
    goals,
    gravity_torque,
    self_motions,
    solve_ik,
    solve_ik_all,
    solve_ik_all_batch,
    solve_ik_any,
    solve_ik_batch,
    solve_ik_path,
)
from pin_metaik.kinematics import Chain, Limits
from pin_metaik.motion import Follower, FollowerStatus, FollowerStep
from pin_metaik.optimize import ALGORITHMS, AskTell, Box, Budget, Metaheuristic, Search, minimize
from pin_metaik.reachable import BasePlacement, Reachability, place_base, reachability
from pin_metaik.robots import Robot, load_robot, robot_names
from pin_metaik.timing import MotionLimits, TimedPath, time_path

__version__ = "0.1.0"

__all__ = [
    "ALGORITHMS",
    "DLS",
    "REFINERS",
    "AskTell",
    "BasePlacement",
    "Box",
    "Budget",
    "Chain",
    "CollisionWorld",
    "Follower",
    "FollowerStatus",
    "FollowerStep",
    "IKBatch",
    "IKChoice",
    "IKPath",
    "IKProblem",
    "IKResult",
    "IKSolutions",
    "IKSolver",
    "IKStatus",
    "Limits",
    "MetaIKError",
    "Metaheuristic",
    "MotionLimits",
    "Proof",
    "Reachability",
    "Refinement",
    "Refiner",
    "Robot",
    "Search",
    "SelfMotionCurve",
    "SelfMotions",
    "Target",
    "TimedPath",
    "Weighted",
    "goals",
    "gravity_torque",
    "load_robot",
    "minimize",
    "place_base",
    "reachability",
    "robot_names",
    "self_motions",
    "solve_ik",
    "solve_ik_all",
    "solve_ik_all_batch",
    "solve_ik_any",
    "solve_ik_batch",
    "solve_ik_path",
    "time_path",
]
