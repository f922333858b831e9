"""Methods by which it is proved that no configuration inside the limits meets a target."""

from __future__ import annotations

from enum import StrEnum


class Proof(StrEnum):
    """How it is proved that a target has no solution, or none but those that were found."""

    CONTACT = "CONTACT"
    """The colliding bodies cannot move, or the target fixes where they are: they collide in every solution."""
    LIMITS = "LIMITS"
    """No joint of the chain can move, and its only configuration does not meet the target."""
    REACH = "REACH"
    """The target is farther from, or nearer to, a joint than the links between can span."""
    CLOSED_FORM = "CLOSED_FORM"
    """Each branch of the arm's closed form, judged for every pose within the tolerances."""
    COUNT = "COUNT"
    """As many distinct real and complex configurations were found as six joints can have for a pose: no other."""
    BOXES = "BOXES"
    """Boxes that cover all configurations inside the limits, each excluded by bounds on where it places the frame."""
