"""The narrow phase: what coal says of two solids, asked so that the answer is right and depends on nothing else.

GJK ends when the origin is within its tolerance of a face of its simplex, which for solids aligned with each other is
the rule, not the exception. It then reports that distance, below the tolerance but above zero, and a request without a
margin takes it for free: of aligned boxes that overlap by centimetres, one in a hundred. So every request here has a
margin above the tolerance. And each begins from the same guess: what was asked before does not count.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import coal

TOLERANCE = 1e-7  # m, of GJK, and of a distance d another 1e-7 d
TOUCH = 2e-7  # m; solids not farther apart than this touch


@cache
def touching(margin: float) -> Any:
    """A request whether two solids are no farther apart than a margin, m."""
    request = coal.CollisionRequest()
    request.enable_contact = False
    request.num_max_contacts = 1
    request.gjk_tolerance = TOLERANCE
    request.security_margin = margin + TOUCH
    request.distance_upper_bound = margin + 2.0 * TOUCH  # GJK may stop once they are known to be farther apart
    return request


@cache
def apart() -> Any:
    """A request for the distance of two solids; of those that overlap minus their depth."""
    request = coal.DistanceRequest()
    request.gjk_tolerance = TOLERANCE
    return request
