"""Refiners: from a start near a solution to the solution. A registry anyone can read."""

from __future__ import annotations

from pin_metaik.errors import InvalidSetting, UnknownName
from pin_metaik.ik.refine.dls import DLS
from pin_metaik.ik.refine.protocol import Refinement, Refiner

REFINERS: dict[str, type[Refiner]] = {
    "dls": DLS,
}

__all__ = ["DLS", "REFINERS", "Refinement", "Refiner", "make_refiner"]


def make_refiner(refiner: str | Refiner) -> Refiner:
    """A refiner from its name; an object that already is one is returned as it is.

    Raises:
        UnknownName: No refiner of that name.
        InvalidSetting: Neither a name nor an object with a method ``refine``.
    """
    if isinstance(refiner, str):
        if refiner not in REFINERS:
            raise UnknownName("refiner", refiner, REFINERS)
        return REFINERS[refiner]()
    if isinstance(refiner, type) or not isinstance(refiner, Refiner):
        raise InvalidSetting(f"not a refiner: {refiner!r}; give a name or an object with refine(problem, starts, ...)")
    return refiner
