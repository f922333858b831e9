from __future__ import annotations

import numpy as np
import pytest

from pin_metaik.optimize import AskTell, Box, Budget, minimize
from pin_metaik.optimize.pso import PSO

WIDE = Box([-1e3] * 2, [1e3] * 2)
UNIT = Box([-5.12] * 13, [5.12] * 13)


def sphere(X):
    return np.square(X).sum(axis=1)


@pytest.mark.parametrize(("variant", "c"), [("constriction", 2.05), ("literal", 2.05), ("inertia", 2.0)])
def test_each_variant_has_its_paper_s_attraction_unless_told_otherwise(variant, c):
    def answer(**settings):
        return minimize(sphere, UNIT, PSO(variant=variant, **settings), Budget(400)).cost

    assert answer() == answer(c1=c, c2=c) != answer(c1=1.5)


@pytest.mark.parametrize("variant", ["constriction", "inertia", "literal"])
def test_steps_are_what_the_equations_say_particle_by_particle(variant):
    c = 2.0 if variant == "inertia" else 2.05
    algorithm = PSO(4, variant, v_max=1e3)
    search = AskTell(WIDE, algorithm, rng=7, budget=Budget(40))
    rng = np.random.default_rng(7)
    X = WIDE.sample(rng, 4)
    V = 0.5 * (WIDE.sample(rng, 4) - X)
    P, f = X.copy(), sphere(X)
    search.tell(sphere(search.ask()))
    for step in (1, 2, 3):
        r1, r2 = rng.random((2, 4, 2))
        w = 0.9 - 0.5 * (4 * step / 40)
        for i in range(4):
            pull = c * r1[i] * (P[i] - X[i]) + c * r2[i] * (P[f.argmin()] - X[i])
            V[i] = {
                "constriction": 0.7298 * (V[i] + pull),
                "inertia": w * V[i] + pull,
                "literal": 0.7298 * V[i] + pull,
            }[variant]
        for i in range(4):
            free = X[i] + V[i]
            X[i] = np.clip(free, -1e3, 1e3)
            V[i][X[i] != free] = 0
            if sphere(X[i : i + 1])[0] < f[i]:
                P[i], f[i] = X[i], sphere(X[i : i + 1])[0]
        proposed = search.ask()
        np.testing.assert_allclose(proposed, X, atol=1e-10)  # of numbers up to 1e3
        search.tell(sphere(proposed))


def test_no_particle_is_faster_than_v_max():
    search = AskTell(WIDE, PSO(20, "literal", v_max=0.01), rng=0)
    last = None
    for _ in range(20):
        X = search.ask()
        if last is not None:
            assert (np.abs(X - last) <= 0.01 * WIDE.width + 1e-9).all()
        search.tell(sphere(X))
        last = X


def test_the_literal_variant_throws_its_particles_at_the_walls_and_constriction_does_not():
    """The Stewart sheet: 13-D sphere, 60 x 60; without a box the literal form reaches |x| = 2e4."""

    def share_at_the_walls(variant):
        search = AskTell(UNIT, PSO(60, variant, v_max=1e3), budget=Budget(3600))
        while search.status is None:
            X = search.ask()
            search.tell(sphere(X))
        return np.mean(np.abs(X) == 5.12)  # of the last generation

    assert share_at_the_walls("literal") > 0.03
    assert share_at_the_walls("constriction") < 0.01


def test_constriction_beats_the_literal_variant_as_in_the_stewart_sheet():
    """Medians of 10 seeds there: sphere 2.2 (clamped) to 0.027."""
    literal, constriction = (
        np.median([minimize(sphere, UNIT, PSO(60, variant), Budget(3600), rng=seed).cost for seed in range(10)])
        for variant in ("literal", "constriction")
    )
    assert 0.3 < literal < 10
    assert constriction < 0.1 * literal
