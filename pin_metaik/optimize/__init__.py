"""Metaheuristics that minimise a function over a box; they need numpy alone."""

from pin_metaik.optimize.asktell import AskTell, Best, Status
from pin_metaik.optimize.budget import Budget
from pin_metaik.optimize.minimize import Result, minimize
from pin_metaik.optimize.registry import ALGORITHMS, make
from pin_metaik.optimize.search import Metaheuristic, Search
from pin_metaik.optimize.space import Box

__all__ = [
    "ALGORITHMS",
    "AskTell",
    "Best",
    "Box",
    "Budget",
    "Metaheuristic",
    "Result",
    "Search",
    "Status",
    "make",
    "minimize",
]
