"""Export to ROS: paths and motions as ``nav_msgs/Path``, in YAML for ``ros2 topic pub``, or in JSON."""

from __future__ import annotations

from pathlib import Path as File
from typing import Any

import numpy as np

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.mobile.curves.curve import STEP, Curve
from pin_metaik.mobile.motion.trajectory import Trajectory
from pin_metaik.mobile.paths.path import Path
from pin_metaik.optimize.settings import within
from pin_metaik.ros import LAST_STAMP, header, message_file, write_message

FRAME = "map"
EVERY = 0.1  # s

Driven = Path | Curve | Trajectory


@checked
def nav_path(of: Driven, frame: str = FRAME, *, stamp: float = 0.0, every: float | None = None) -> dict[str, Any]:
    """A path or motion as the plain values of a ``nav_msgs/Path``.

    Every pose has its heading as a quaternion; for a polyline, that of the segment that begins there. Poses of a
    trajectory are stamped with their times, others all with ``stamp``.

    Args:
        of: A ``Path``, a ``Curve`` or a ``Trajectory``.
        frame: ``frame_id`` of all headers.
        stamp: Time at which it begins, s since the ROS epoch.
        every: Distance between poses: s for a trajectory (default 0.1), m for a curve (default 0.05); not used for a
            path, which has its points.

    Raises:
        InvalidSetting: A stamp below zero, or a distance between poses that is not above zero.
    """
    within("stamp", stamp, 0, LAST_STAMP)
    poses, times = _poses(of, every)
    return {
        "header": header(frame, stamp),
        "poses": [
            {"header": header(frame, stamp + t), "pose": _pose(*pose)}
            for t, pose in zip(times.tolist(), poses.tolist(), strict=True)
        ],
    }


@checked
def write_nav_path(
    file: str | File, of: Driven, frame: str = FRAME, *, stamp: float = 0.0, every: float | None = None
) -> None:
    """Write a path or motion as a ``nav_msgs/Path``: ``.yaml`` or ``.json``; see ``nav_path``.

    Raises:
        InvalidSetting: Another suffix; see ``nav_path``.
        CannotWrite: The file cannot be written.
        MissingExtra: YAML is wanted and PyYAML is not installed.
    """
    where = ros_file(file)
    write_message(where, nav_path(of, frame, stamp=stamp, every=every))


def ros_file(file: str | File) -> File:
    """The path of a file that a ``nav_msgs/Path`` can be written to."""
    return message_file(file, "nav_msgs/Path")


def _poses(of: Driven, every: float | None) -> tuple[Array, Array]:
    """Poses (n, 3) and their times (n,), s after the beginning."""
    match of:
        case Trajectory():
            samples = of.sample(EVERY if every is None else every)
            return np.column_stack((samples.x, samples.y, samples.heading)), samples.t
        case Curve():
            poses = of.poses(of.places(STEP if every is None else every))
            return poses, np.zeros(len(poses))
        case Path():
            along = np.diff(of.points, axis=0)
            headings = np.arctan2(along[:, 1], along[:, 0])
            return np.column_stack((of.points, np.append(headings, headings[-1]))), np.zeros(len(of.points))


def _pose(x: float, y: float, heading: float) -> dict[str, Any]:
    return {
        "position": {"x": x, "y": y, "z": 0.0},
        "orientation": {"x": 0.0, "y": 0.0, "z": float(np.sin(heading / 2)), "w": float(np.cos(heading / 2))},
    }
