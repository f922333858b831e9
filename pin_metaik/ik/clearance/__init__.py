"""Solutions free of collisions: a check of a result, a search from one that collides, and its quadratic program."""

from pin_metaik.ik.clearance.check import keep_clear

__all__ = ["keep_clear"]
