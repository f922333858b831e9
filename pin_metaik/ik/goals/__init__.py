"""Goals: what a robot shall do, a file a goal. A registry anyone can read."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from pin_metaik.ik.goals.goal import Goal, Goals, Placed
from pin_metaik.ik.goals.pose import Target

GOALS: dict[str, Callable[..., Any]] = {
    "pose": Target,
}

__all__ = ["GOALS", "Goal", "Goals", "Placed", "Target"]
