"""The aerial arm paper's experiment: its target, objective J and the settings and results of its Table 3."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.compare.papers.arm import ArmCase
from pin_metaik.ik import IKProblem, Target
from pin_metaik.kinematics import Chain
from pin_metaik.kinematics.pose import rpy_matrix
from pin_metaik.optimize.sfla import SFLA, Leapers
from pin_metaik.robots import load_robot

CM = 100.0  # in a metre
G = np.array([-20.0, 3.0, 40.0, 0.0, 10.0, 15.0])  # x, y, z in cm; roll, pitch, yaw in degrees
SIGMA, EPSILON = 0.7, 0.3  # the only weights that give the J of its rows 1 and 2
MEMEPLEXES = 3
SOLVED = 1e-2  # J of a run that found the right region
EXACT = 1e-12  # m and rad, for the hybrids


class Row(NamedTuple):
    """A row of Table 3: frogs NP, shuffles iN, leaps iM between two; J, total error and time in ms as printed."""

    NP: int
    iN: int
    iM: int
    J: float
    total: float
    ms: float

    @property
    def leaps(self) -> int:
        """Leaps of all memeplexes together."""
        return MEMEPLEXES * self.iN * self.iM

    @property
    def frog_steps(self) -> int:
        """Frogs times steps: the leaps if every frog leapt at every step."""
        return self.NP * self.iN * self.iM


ROWS = {
    1: Row(20, 30, 10, 11.618, 29.71, 729),
    2: Row(30, 30, 10, 7.6614, 12.08, 1045),
    3: Row(40, 30, 15, 10.5382, 19.21, 1685),
    4: Row(40, 40, 30, 18.4625, 18.46, 4526),
    5: Row(60, 40, 30, 8.2925, 8.292, 6645),
    6: Row(80, 50, 40, 11.024, 11.02, 13540),
    7: Row(100, 60, 60, 29.774, 29.77, 24191),
    8: Row(130, 70, 60, 0.1511, 0.649, 46282),
    9: Row(170, 60, 50, 0.6168, 2.168, 40459),
    10: Row(200, 90, 40, 0.1139, 0.298, 57362),
    11: Row(200, 100, 60, 0.0729, 0.378, 92779),
    12: Row(200, 120, 80, 2.7672, 5.8164, 150246),
    13: Row(200, 200, 100, 2.6713, 1.9339, 318481),
    14: Row(250, 90, 40, 0.003, 0.016, 69818),
    15: Row(250, 140, 80, 1.266, 6.553, 215027),
    16: Row(250, 140, 100, 4.647e-9, 1.05e-8, 260325),
    17: Row(300, 140, 80, 1.01e-9, 3.33e-9, 255989),
    18: Row(500, 90, 40, 5.49e-10, 9.9e-10, 136888),
    19: Row(500, 200, 100, 3.02e-15, 1.56e-14, 681646),
    20: Row(1000, 30, 45, 0.0968, 0.025, 95197),
}


@dataclass(frozen=True)
class Reading:
    """One reading of the settings that the paper does not print.

    Attributes:
        leapers: Which frogs leap at each of the iM steps.
        half_range: Joints move from minus this to this, degrees; the paper says that they are limited, not how.
    """

    leapers: Leapers
    half_range: float

    def __str__(self) -> str:
        return f"SFLA {self.leapers}, +-{self.half_range:g} deg"

    def evaluations(self, row: Row) -> int:
        """One a frog, and then as its text or its times have it.

        The worst frogs get three evaluations a leap, all that the fall-backs may need, so there are at least as many
        leaps as printed. If every frog leaps the printed times pay for one a frog and step, at 67 to 122 us.
        """
        match self.leapers:
            case "worst":
                return row.NP + 3 * row.leaps
            case "all":
                return row.NP + row.frog_steps

    def sfla(self, row: Row) -> SFLA:
        """The modified SFLA: leap C_L = 1.3, three memeplexes, with the fall-backs of SFLA as published."""
        return SFLA(frogs=row.NP, memeplexes=MEMEPLEXES, leaps=row.iM, leap=1.3, leapers=self.leapers)


WALLS, FREE = 180.0, 270.0  # degrees; within 270 every posture has a copy at least 90 from the ends of every joint
TEXT, TIMES = Reading("worst", WALLS), Reading("all", FREE)
READINGS = (TEXT, Reading("worst", FREE), Reading("all", WALLS), TIMES)


def poses(chain: Chain, X: Array) -> Array:
    """Tip poses (k, 6) in cm and degrees at joint angles X (k, 6); R = Rz(yaw) Ry(pitch) Rx(roll)."""
    T = chain.poses(X)[:, 0]
    R = T[:, :3, :3]
    roll = np.arctan2(R[:, 2, 1], R[:, 2, 2])
    pitch = np.arctan2(-R[:, 2, 0], np.hypot(R[:, 2, 1], R[:, 2, 2]))
    yaw = np.arctan2(R[:, 1, 0], R[:, 0, 0])
    return np.concatenate((CM * T[:, :3, 3].T, np.degrees((roll, pitch, yaw)))).T


def differences(poses: Array) -> Array:
    """Errors to the target (k, 6), in cm and degrees; angles in (-180, 180]."""
    e = G - poses
    e[:, 3:] -= 360 * np.rint(e[:, 3:] / 360)
    return e


def J(poses: Array) -> Array:
    """J = sigma |p_G - p| + epsilon |rpy_G - rpy| of poses (k, 6) in cm and degrees."""
    e2 = differences(poses) ** 2
    cost: Array = SIGMA * np.sqrt(e2[:, :3].sum(axis=1)) + EPSILON * np.sqrt(e2[:, 3:].sum(axis=1))
    return cost


def total_error(poses: Array) -> Array:
    """Sum of the six absolute differences (k,), cm and degrees added up."""
    total: Array = np.abs(differences(poses)).sum(axis=1)
    return total


def J_at(chain: Chain, X: Array) -> Array:
    """J (k,) at joint angles X (k, 6)."""
    return J(poses(chain, X))


def arm(half_range: float = WALLS) -> Chain:
    """The arm, with joints from minus to plus so many degrees."""
    robot = load_robot("aerial_arm")
    end = float(np.radians(half_range))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that the limits are wider than the table's is what is tried
        return Chain(robot.model, robot.frame, limits=dict.fromkeys(robot.model.names[1:], (-end, end)))


def case(chain: Chain, row: int) -> ArmCase:
    """The one target, under the name of a row of Table 3: rows differ in their settings only."""
    pose = np.eye(4)
    pose[:3, :3] = rpy_matrix(*np.radians(G[3:]))
    pose[:3, 3] = G[:3] / CM
    target = Target(pose, position_tolerance=EXACT, orientation_tolerance=EXACT)
    return ArmCase(f"row {row}", IKProblem.of(chain, target), partial(J_at, chain))
