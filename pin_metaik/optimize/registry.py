"""The metaheuristics by name: one line each."""

from __future__ import annotations

from pin_metaik.errors import InvalidSetting
from pin_metaik.lookup import lookup
from pin_metaik.optimize.cmaes import CMAES
from pin_metaik.optimize.de import DE
from pin_metaik.optimize.ga import GA
from pin_metaik.optimize.gwo import GWO
from pin_metaik.optimize.igwo import IGWO
from pin_metaik.optimize.mtde import MTDE
from pin_metaik.optimize.pso import PSO
from pin_metaik.optimize.qpso import QPSO
from pin_metaik.optimize.search import Metaheuristic
from pin_metaik.optimize.sfla import SFLA

ALGORITHMS: dict[str, type[Metaheuristic]] = {
    "gwo": GWO,
    "igwo": IGWO,
    "mtde": MTDE,
    "sfla": SFLA,
    "de": DE,
    "pso": PSO,
    "qpso": QPSO,
    "ga": GA,
    "cmaes": CMAES,
}


def make(algorithm: str | Metaheuristic) -> Metaheuristic:
    """An algorithm from its name, with its default settings; an object is returned unchanged.

    Raises:
        UnknownName: No metaheuristic of that name; the message lists those there are.
        InvalidSetting: Neither a name nor an object with a method `search`.
    """
    if isinstance(algorithm, str):
        return lookup("metaheuristic", algorithm, ALGORITHMS)()
    if isinstance(algorithm, type) or not isinstance(algorithm, Metaheuristic):
        raise InvalidSetting(f"not a metaheuristic: {algorithm!r}; give a name or an object with a method search(run)")
    return algorithm
