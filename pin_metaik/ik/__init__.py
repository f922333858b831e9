"""Inverse kinematics: targets, problems, solvers, refiners and results."""

from pin_metaik.ik import goals
from pin_metaik.ik.all_batch import solve_ik_all_batch
from pin_metaik.ik.any import IKChoice, solve_ik_any
from pin_metaik.ik.batch import IKBatch, solve_ik_batch
from pin_metaik.ik.breaks import BreakReason, PathBreak, Reconfiguration
from pin_metaik.ik.criteria import Weighted
from pin_metaik.ik.goals.pose import Target
from pin_metaik.ik.gravity import gravity_torque
from pin_metaik.ik.path import IKPath, solve_ik_path
from pin_metaik.ik.picture import draw_arm, save_arm
from pin_metaik.ik.problem import IKProblem, Verdict
from pin_metaik.ik.proof import Proof
from pin_metaik.ik.refine import DLS, REFINERS, Refinement, Refiner
from pin_metaik.ik.result import IKResult, IKStatus
from pin_metaik.ik.self_motion import SelfMotionCurve, SelfMotions, self_motions
from pin_metaik.ik.solutions import IKSolutions, solve_ik_all
from pin_metaik.ik.solve import solve_ik
from pin_metaik.ik.solver import IKSolver

__all__ = [
    "DLS",
    "REFINERS",
    "BreakReason",
    "IKBatch",
    "IKChoice",
    "IKPath",
    "IKProblem",
    "IKResult",
    "IKSolutions",
    "IKSolver",
    "IKStatus",
    "PathBreak",
    "Proof",
    "Reconfiguration",
    "Refinement",
    "Refiner",
    "SelfMotionCurve",
    "SelfMotions",
    "Target",
    "Verdict",
    "Weighted",
    "draw_arm",
    "goals",
    "gravity_torque",
    "save_arm",
    "self_motions",
    "solve_ik",
    "solve_ik_all",
    "solve_ik_all_batch",
    "solve_ik_any",
    "solve_ik_batch",
    "solve_ik_path",
]
