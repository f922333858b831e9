"""The methods by name: Jacobian methods, metaheuristics, hybrids, the default solver, and solvers of other packages."""

from __future__ import annotations

from pin_metaik.compare.methods.method import Method
from pin_metaik.compare.methods.peers import PEERS
from pin_metaik.compare.methods.solvers import Default, Rounds, Search
from pin_metaik.ik import REFINERS
from pin_metaik.lookup import lookup
from pin_metaik.optimize import ALGORITHMS

METHODS: dict[str, Method] = {
    "default": Default("default"),
    "default_nearest": Default("default_nearest", "nearest"),
    **{name: Search(name, None, name, starts=1) for name in REFINERS},
    **{f"{name}+restarts": Search(f"{name}+restarts", None, name) for name in REFINERS},
    **{name: Search(name, name) for name in ALGORITHMS},
    **{f"{a}+{name}": Search(f"{a}+{name}", a, name) for a in ALGORITHMS for name in REFINERS},
    **PEERS,
}

ROUND = "@"  # as in gwo@120+dls: rounds of 120 evaluations


def named(name: str) -> Method:
    """A method by its name; of a hybrid the evaluations of a round may be given: ``gwo@120+dls``.

    Raises:
        UnknownName: No method has that name.
    """
    seeder, at, rest = name.partition(ROUND)
    size, _, refiner = rest.partition("+")
    if at and size.isdecimal() and seeder in ALGORITHMS and refiner in REFINERS:
        return Rounds(name, seeder, refiner, int(size))
    return lookup("method", name, METHODS)


__all__ = ["METHODS", "Default", "Rounds", "Search", "named"]
