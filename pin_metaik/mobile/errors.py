"""Errors of planning: a position where the robot cannot be, two positions without a path between; and a warning."""

from __future__ import annotations

from pin_metaik.errors import MetaIKError

Point = tuple[float, float]


class LooksLikeDegrees(UserWarning):
    """Coordinates that look like longitudes and latitudes, where lengths in metres are expected."""


class Blocked(MetaIKError):
    """A start or goal inside an obstacle, or outside the workspace.

    Attributes:
        role: ``"start"`` or ``"goal"``; ``"curve"`` in ``Obstructed``.
        point: Where it is (x, y).
        clearance: Distance to be kept from obstacles and walls.
        nearest: The nearest free position (x, y); None if there is none.
        join: How corners of grown obstacles are joined, if the position keeps the clearance and only such a join covers
            it; otherwise None.
    """

    def __init__(
        self, role: str, point: Point, clearance: float, nearest: Point | None, join: str | None = None
    ) -> None:
        self.role, self.point, self.clearance, self.nearest, self.join = role, point, clearance, nearest, join
        where = f"is inside an obstacle{f' grown by {clearance:g}' if clearance else ''} or outside the workspace"
        if join is not None:
            where = f"keeps the clearance of {clearance:g}, but {_grown(join)} cover it"
        hint = f"the nearest free place is {_shown(nearest)}" if nearest else "no place is free"
        super().__init__(f"the {role} {_shown(point)} {where}; {hint}")


class Obstructed(Blocked):
    """Every curve that was tried meets an obstacle.

    Attributes:
        pose: Pose (x, y, heading) at which the best of them first meets an obstacle, m and rad.
        point: The obstacle's point there (x, y).
    """

    def __init__(self, pose: tuple[float, float, float], point: Point) -> None:
        self.role, self.clearance, self.nearest, self.join = "curve", 0.0, None, None
        self.pose, self.point = pose, point
        x, y, heading = pose
        MetaIKError.__init__(
            self,
            f"every curve that was tried meets an obstacle; the best with the vehicle at {_shown((x, y))}, heading "
            f"{heading:.3f} rad, at {_shown(point)}. Points farther from the obstacles may help, a smaller turning "
            "radius, or reverse=True",
        )


class NoPath(MetaIKError):
    """Start and goal are in different parts of the free space.

    Attributes:
        start: (x, y).
        goal: (x, y).
        clearance: Distance the path had to keep from obstacles and walls.
        nearly: A slightly smaller clearance with which there is a path, if there is one: then one may exist between the
            corners of the grown obstacles and the arcs that they approximate. Otherwise None.
        join: How corners of grown obstacles were joined.
    """

    def __init__(
        self, start: Point, goal: Point, clearance: float, nearly: float | None = None, join: str = "mitre"
    ) -> None:
        self.start, self.goal, self.clearance, self.nearly, self.join = start, goal, clearance, nearly, join
        where = f"no path from {_shown(start)} to {_shown(goal)}"
        why = f"obstacles or walls close every way that keeps a clearance of {clearance:g}"
        hint = "; try a smaller radius or margin" if clearance else ""
        if nearly is not None:
            why = f"{_grown(join)} close every way with a clearance of {clearance:g}, and {nearly:.6g} leaves one"
            hint = "; try join='round'" if join == "mitre" else hint
        super().__init__(f"{where}: {why}{hint}")


class NoTimedPath(NoPath):
    """No motion of the kind searched for leads to the goal among the moving obstacles.

    Attributes:
        why: The reason, in words.
    """

    def __init__(self, start: Point, goal: Point, clearance: float, why: str) -> None:
        self.start, self.goal, self.clearance, self.nearly, self.join, self.why = start, goal, clearance, None, "", why
        MetaIKError.__init__(
            self,
            f"no motion from {_shown(start)} to {_shown(goal)} that keeps a clearance of {clearance:g}: {why}; more "
            "places (cells=...), another speed or another time to start may help",
        )


class NoRoom(MetaIKError):
    """A moving robot, for which none of the motions tried keeps clear of the obstacles.

    Attributes:
        place: Where it is (x, y).
        v: Its speed, m/s.
        stop: Where it would stop if it braked straight ahead at once (x, y).
        radius: Distance to keep from obstacles, m.
    """

    def __init__(self, place: Point, v: float, stop: Point, radius: float) -> None:
        self.place, self.v, self.stop, self.radius = place, v, stop, radius
        super().__init__(
            f"from {_shown(place)} at {v:g} m/s nothing that was tried keeps {radius:g} m from the obstacles; braking "
            f"ends at {_shown(stop)}. A lower speed may, or more paths, or another margin"
        )


def _shown(point: Point) -> str:
    """A place with the digits that tell it from its neighbours, in maps with large coordinates, too."""
    return f"({point[0]:.12g}, {point[1]:.12g})"


def _grown(join: str) -> str:
    return {"mitre": "the mitred corners of grown obstacles", "round": "the corners of grown obstacles"}[join]
