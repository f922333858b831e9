"""Settings outside their range are refused when an algorithm is built, and the message names them."""

from __future__ import annotations

import pytest

from pin_metaik.errors import InvalidSetting
from pin_metaik.optimize import ALGORITHMS


@pytest.mark.parametrize(
    ("name", "settings", "named"),
    [
        ("gwo", {"agents": 2}, "at least 3"),
        ("gwo", {"agents": 30.0}, "whole number"),
        ("igwo", {"agents": 2}, "at least 3"),
        ("mtde", {"agents": 19}, "at least 20"),
        ("mtde", {"patience": 0}, "patience"),
        ("mtde", {"scale": 1.5}, "scale must be a number from 0 to 1"),
        ("sfla", {"frogs": 39}, "at least 40"),
        ("sfla", {"memeplexes": 0}, "memeplexes"),
        ("sfla", {"leap": -1.0}, "leap"),
        ("sfla", {"leaps": 0}, "leaps"),
        ("sfla", {"fallbacks": "both"}, "fallbacks"),
        ("de", {"agents": 3}, "at least 4"),
        ("de", {"F": float("nan")}, "F must be"),
        ("de", {"CR": 1.1}, "CR"),
        ("de", {"strategy": "rand/2/bin"}, "'rand/1/bin', 'best/1/bin', 'current-to-best/1/bin'"),
        ("pso", {"agents": 0}, "at least 1"),
        ("pso", {"variant": "clerc"}, "'constriction', 'inertia', 'literal'"),
        ("pso", {"w_max": 0.2}, "w_max must be a number from 0.4"),
        ("pso", {"v_max": 0.0}, "v_max must be a number above 0"),
        ("pso", {"v_max": float("inf")}, "v_max"),
        ("pso", {"c1": "much"}, "c1"),
        ("qpso", {"agents": True}, "agents"),
        ("qpso", {"beta_end": -0.1}, "beta_end"),
        ("ga", {"agents": 1}, "at least 2"),
        ("ga", {"agents": 5, "elites": 5}, "agents - elites"),
        ("ga", {"mutation_rate": 2}, "mutation_rate"),
        ("ga", {"selection": "rank"}, "'roulette', 'tournament'"),
        ("ga", {"crossover": "uniform"}, "'one-point', 'blend'"),
        ("cmaes", {"agents": 1}, "at least 2"),
        ("cmaes", {"sigma": 0}, "sigma"),
        ("cmaes", {"growth": 0.5}, "growth"),
    ],
)
def test_a_setting_outside_its_range_is_named(name, settings, named):
    with pytest.raises(InvalidSetting, match=named):
        ALGORITHMS[name](**settings)
