"""Errors of planning: a place the robot cannot be in, and two places with no way between them."""

from __future__ import annotations

from pin_metaik.errors import MetaIKError


class Blocked(MetaIKError):
    """A start or goal inside an obstacle, or outside the workspace.

    Attributes:
        role: ``"start"`` or ``"goal"``.
        point: Where it is (x, y).
        clearance: Distance it should keep from obstacles and walls.
        nearest: The nearest place (x, y) that would have worked; None if there is none at all.
    """

    def __init__(
        self, role: str, point: tuple[float, float], clearance: float, nearest: tuple[float, float] | None
    ) -> None:
        self.role, self.point, self.clearance, self.nearest = role, point, clearance, nearest
        grown = f" grown by {clearance:g}" if clearance else ""
        hint = f"the nearest free place is ({nearest[0]:g}, {nearest[1]:g})" if nearest else "no place is free"
        super().__init__(
            f"the {role} ({point[0]:g}, {point[1]:g}) is inside an obstacle{grown} or outside the workspace; {hint}"
        )


class NoPath(MetaIKError):
    """Start and goal are in different parts of the free space.

    Attributes:
        start: (x, y).
        goal: (x, y).
        clearance: Distance the path had to keep from obstacles and walls.
        join: How grown obstacles ended at their corners.
    """

    def __init__(
        self, start: tuple[float, float], goal: tuple[float, float], clearance: float, join: str = "mitre"
    ) -> None:
        self.start, self.goal, self.clearance, self.join = start, goal, clearance, join
        super().__init__(
            f"no path from ({start[0]:g}, {start[1]:g}) to ({goal[0]:g}, {goal[1]:g}): obstacles or walls close every "
            f"way that keeps a clearance of {clearance:g}"
        )
