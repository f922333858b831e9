"""Means by which it is proved that nothing inside the limits meets a target."""

from __future__ import annotations

from enum import StrEnum


class Proof(StrEnum):
    """What proves that a target has no solution, or that no other one exists than those that were seen."""

    CONTACT = "CONTACT"
    """What collides stands still, or is held by the target where it is: it collides in every solution."""
    LIMITS = "LIMITS"
    """No joint of the chain can move, and where it stands it does not meet the target."""
    REACH = "REACH"
    """The target is farther from, or nearer to, a joint than the links between can span."""
    CLOSED_FORM = "CLOSED_FORM"
    """The branches of the arm's closed form, each judged for every pose within the tolerances."""
    COUNT = "COUNT"
    """As many separate configurations, real and complex, as six joints can have for a pose: no other one is left."""
    BOXES = "BOXES"
    """Boxes of configurations that cover the limits, each excluded by bounds on where it can take the frame."""
