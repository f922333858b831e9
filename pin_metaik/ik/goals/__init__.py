"""Goals: the conditions that a configuration shall meet (one file each), and their names."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from pin_metaik.ik.goals.centre_of_mass import CentreOfMass
from pin_metaik.ik.goals.custom import Custom
from pin_metaik.ik.goals.distance import Distance
from pin_metaik.ik.goals.frame_pose import FramePose
from pin_metaik.ik.goals.goal import Goal, Goals, Outcome
from pin_metaik.ik.goals.in_box import InBox
from pin_metaik.ik.goals.look_at import LookAt
from pin_metaik.ik.goals.loop import Loop
from pin_metaik.ik.goals.manipulability import Manipulability
from pin_metaik.ik.goals.mid_range import MidRange
from pin_metaik.ik.goals.on_line import OnLine
from pin_metaik.ik.goals.on_plane import OnPlane
from pin_metaik.ik.goals.placed import Placed
from pin_metaik.ik.goals.pointing import Pointing
from pin_metaik.ik.goals.pose import Target
from pin_metaik.ik.goals.posture import Posture
from pin_metaik.ik.goals.wish import Wish

GOALS: dict[str, Callable[..., Any]] = {
    "centre_of_mass": CentreOfMass,
    "custom": Custom,
    "distance": Distance,
    "frame_pose": FramePose,
    "in_box": InBox,
    "look_at": LookAt,
    "loop": Loop,
    "manipulability": Manipulability,
    "mid_range": MidRange,
    "on_line": OnLine,
    "on_plane": OnPlane,
    "pointing": Pointing,
    "pose": Target,
    "posture": Posture,
}

__all__ = [
    "GOALS",
    "CentreOfMass",
    "Custom",
    "Distance",
    "FramePose",
    "Goal",
    "Goals",
    "InBox",
    "LookAt",
    "Loop",
    "Manipulability",
    "MidRange",
    "OnLine",
    "OnPlane",
    "Outcome",
    "Placed",
    "Pointing",
    "Posture",
    "Target",
    "Wish",
]
