"""Trajectories from and to CSV files: poses over time in, coordinates and rates of the legs out."""

from __future__ import annotations

import csv
from math import radians
from pathlib import Path

import numpy as np

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidTarget
from pin_metaik.files import read_csv
from pin_metaik.output import writable
from pin_metaik.stewart.kinematics.trajectory import Motion, Trajectory
from pin_metaik.stewart.platform.poses import pose_at
from pin_metaik.stewart.platform.states import PoseState

COLUMNS = ("time", "x", "y", "z", "roll", "pitch", "yaw")
NEEDED = COLUMNS[:4]
DEGREE = radians(1.0)


@checked
def read_trajectory(path: str | Path, metres: float = 1.0, radian: float = DEGREE) -> Trajectory:
    """Read a trajectory from a CSV file with a header: time, x, y, z and, if it rotates, roll, pitch, yaw.

    Times are in s; columns may be in any order. Velocities are differences between neighbouring rows.

    Args:
        path: The file.
        metres: Its unit of length in m: 0.001 for mm.
        radian: Its unit of angles in rad; default: degrees.

    Raises:
        InvalidTarget: It cannot be read, has other columns, values that are not numbers, or times that do not ascend;
            the message names the line.
    """
    rows = read_csv(Path(path), InvalidTarget)
    names = [name.strip().lower() for name in rows[0]] if rows else []
    unknown = [name for name in names if name not in COLUMNS]
    missing = [name for name in NEEDED if name not in names]
    if unknown or missing or len(set(names)) < len(names):
        wrong = (
            f"unknown column {unknown[0]!r}" if unknown else f"no column {missing[0]}" if missing else "a column twice"
        )
        raise InvalidTarget(f"{path}: {wrong}; the first line names {', '.join(COLUMNS)} (the last three if it turns)")
    lines = [line for line, row in enumerate(rows, start=1) if line > 1 and any(row)]
    table = np.array([_numbers(path, line, rows[line - 1], names) for line in lines])
    if len(table) < 2:
        raise InvalidTarget(f"{path}: a trajectory has two or more rows, got {len(table)}")
    of = {name: table[:, column] for column, name in enumerate(names)}
    nothing = np.zeros(len(table))
    xyz = metres * np.column_stack([of[name] for name in COLUMNS[1:4]])
    rpy = radian * np.column_stack([of.get(name, nothing) for name in COLUMNS[4:]])
    for k in np.flatnonzero(np.diff(of["time"]) <= 0.0):
        raise InvalidTarget(f"{path}: the times ascend, but that of line {lines[k + 1]} is not after line {lines[k]}")
    return Trajectory.through(of["time"], [pose_at(p, turn) for p, turn in zip(xyz, rpy, strict=True)])


def _numbers(path: str | Path, line: int, row: list[str], names: list[str]) -> list[float]:
    try:
        numbers = [float(text) for text in row]
    except ValueError:
        numbers = []
    if len(numbers) != len(names) or not np.isfinite(numbers).all():
        raise InvalidTarget(f"{path}: line {line} is not {len(names)} finite numbers: {','.join(row)!r}")
    return numbers


@checked
def save_motion(motion: Motion, path: str | Path, metres: float = 1.0) -> Path:
    """Write coordinates and rates of the legs along a trajectory to a CSV file, with a row for each sample.

    The columns are time in s, the lengths d1 ... and rates v1 ... of the legs, nu, and the state of the pose. With
    servos they are the angles a1 ... and rates w1 ... in degrees and degrees per second; nan where a rod does not
    reach.

    Args:
        motion: The result of ``follow``.
        path: The file.
        metres: The unit of length to write in, m: 0.001 for mm.

    Raises:
        CannotWrite: It cannot be written.
    """
    path = writable(path)
    n = motion.coordinates.shape[1]
    (what, rate), one = motion.geometry.actuation.words.columns, metres if motion.geometry.servos is None else DEGREE
    names = ["time", *(f"{what}{i}" for i in range(1, n + 1)), *(f"{rate}{i}" for i in range(1, n + 1)), "nu", "state"]
    legs: list[Array] = [*(motion.coordinates.T / one), *(motion.rates.T / one)]
    table = np.column_stack([motion.trajectory.times, *legs, motion.nu])
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(names)
        for numbers, state in zip(table, motion.states, strict=True):
            writer.writerow([*(f"{value:.9g}" for value in numbers), PoseState(int(state)).name.lower()])
    return path
