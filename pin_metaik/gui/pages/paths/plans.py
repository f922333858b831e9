"""What the page says of a path, and of a map without any."""

from __future__ import annotations

from pin_metaik.errors import InvalidGeometry
from pin_metaik.mobile import PathPlan, PathProblem


def needed(problem: PathProblem | None) -> PathProblem:
    """The problem of a map that one can plan on.

    Raises:
        InvalidGeometry: There is none.
    """
    if problem is None:
        raise InvalidGeometry("nobody can plan on this map: the robot does not fit in at its start or its goal")
    return problem


def in_a_line(plan: PathPlan) -> str:
    """Its length, whether it is free, and how much longer than the shortest."""
    if not plan.collision_free:
        return f"**{plan.status}**: length {plan.length:.6f}, goes through an obstacle or too near to one"
    gap = "" if plan.gap is None else f"; {100 * plan.gap:.2f} % longer than the shortest"
    return f"**{plan.status}**: length {plan.length:.6f}, free by the exact test{gap}"
