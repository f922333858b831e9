from __future__ import annotations

import numpy as np
import pytest

from pin_metaik.errors import MissingExtra
from pin_metaik.optimize import AskTell, Budget, cmaes, make, minimize
from pin_metaik.optimize.functions import shifted


def test_without_its_package_it_names_the_extra(monkeypatch):
    monkeypatch.setattr("pin_metaik.lookup.find_spec", lambda name: None)
    with pytest.raises(MissingExtra, match=r"pip install .*\[cma\]'"):
        make("cmaes")


def test_it_solves_what_the_others_do_not():
    f = shifted("rosenbrock", 5)
    assert minimize(f, f.box, "cmaes", Budget(5000, target=1e-10)).cost <= 1e-10


def test_it_starts_anew_with_a_larger_population_when_it_has_converged():
    f = shifted("sphere", 2)
    search = AskTell(f.box, "cmaes", budget=Budget(3000))
    sizes = []
    while search.status is None:
        X = search.ask()
        sizes.append(len(X))
        search.tell(f(X))
    assert {6, 12, 24} <= set(sizes)


def test_a_step_too_small_to_matter_does_not_stop_it():
    f = shifted("sphere", 2)
    assert minimize(f, f.box, cmaes.CMAES(sigma=1e-30), Budget(200)).evaluations == 200


def test_the_first_run_starts_at_the_best_seed():
    f = shifted("rastrigin", 4)
    near = f.optimum + 0.01
    result = minimize(f, f.box, cmaes.CMAES(sigma=0.005), Budget(800), seeds=near)
    assert result.cost < 1e-6
    assert np.allclose(result.x, f.optimum, atol=1e-3)
