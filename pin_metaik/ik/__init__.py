"""Inverse kinematics: targets, problems, solvers, refiners and results."""

from pin_metaik.ik.problem import IKProblem, Verdict
from pin_metaik.ik.refine import DLS, REFINERS, Refinement, Refiner
from pin_metaik.ik.result import IKResult, IKStatus
from pin_metaik.ik.solver import IKSolver, solve_ik
from pin_metaik.ik.target import Target

__all__ = [
    "DLS",
    "REFINERS",
    "IKProblem",
    "IKResult",
    "IKSolver",
    "IKStatus",
    "Refinement",
    "Refiner",
    "Target",
    "Verdict",
    "solve_ik",
]
