from __future__ import annotations

import numpy as np
import pytest

from pin_metaik.optimize import AskTell, Box, Budget, minimize
from pin_metaik.optimize.functions import shifted
from pin_metaik.optimize.ga import GA, blend, one_point, spin, wheel

BOX = Box([0.0] * 4, [1.0] * 4)


@pytest.fixture
def rng():
    return np.random.default_rng(0)


def test_the_wheel_gives_room_by_how_much_better_than_the_worst_one_is():
    np.testing.assert_allclose(wheel(np.array([3.0, 1.0, 2.0])), [0, 2 / 3, 1 / 3])
    np.testing.assert_allclose(wheel(np.array([3.0, np.inf, 1.0])), [0, 0, 1])
    np.testing.assert_allclose(wheel(np.array([-5.0, -5.0])), [0.5, 0.5])
    np.testing.assert_allclose(wheel(np.array([np.inf, np.inf])), [0.5, 0.5])


def test_the_ball_falls_where_there_is_room(rng):
    drawn = spin(rng, np.array([0.0, 0.5, 0.2, 0.0, 0.3]), 20_000)
    np.testing.assert_allclose(np.bincount(drawn, minlength=5) / 20_000, [0, 0.5, 0.2, 0, 0.3], atol=0.015)


def test_one_point_crossover_swaps_the_genes_behind_a_cut(rng):
    mothers, fathers = np.zeros((500, 4)), np.ones((500, 4))
    first, second = np.split(one_point(rng, mothers, fathers), 2)
    assert np.array_equal(first, 1 - second)
    assert (np.diff(first, axis=1) >= 0).all()  # the mother's genes, then the father's
    assert set(first.sum(axis=1)) == {1, 2, 3}  # at least one gene of each


def test_blend_reaches_half_the_distance_beyond_both_parents(rng):
    children = blend(rng, np.full((5000, 2), 2.0), np.full((5000, 2), 4.0))
    assert children.shape == (10_000, 2)
    assert 1.0 <= children.min() < 1.01
    assert 4.99 < children.max() <= 5.0


@pytest.mark.parametrize("selection", ["roulette", "tournament"])
def test_without_crossover_and_mutation_children_are_copies(selection):
    search = AskTell(BOX, GA(11, crossover_rate=0, mutation_rate=0, selection=selection))
    X = search.ask()
    search.tell(X[:, 0])
    children = search.ask()
    assert len(children) == 10
    assert all((child == X).all(axis=1).any() for child in children)


def test_mutation_draws_one_gene_of_a_child_anew():
    search = AskTell(BOX, GA(200, crossover_rate=0, mutation_rate=0.3), rng=1)
    X = search.ask()
    search.tell(X[:, 0])
    changed = np.array([np.min((child != X).sum(axis=1)) for child in search.ask()])
    assert set(changed) == {0, 1}
    assert 0.2 < changed.mean() < 0.4


def test_the_elite_lives_on_without_being_evaluated_again():
    search = AskTell(BOX, GA(10, crossover_rate=0, mutation_rate=1, elites=2, selection="tournament"))
    X = search.ask()
    search.tell(np.arange(10.0))
    kin = np.zeros((40, 2))  # children that differ in one gene from each of the two best
    for generation in range(len(kin)):
        children = search.ask()
        assert len(children) == 8
        kin[generation] = [((children != parent).sum(axis=1) == 1).sum() for parent in X[:2]]
        search.tell(np.full(8, 99.0))
    assert (kin[-20:].sum(axis=0) > 10).all()


def test_tournaments_prefer_the_better():
    search = AskTell(BOX, GA(1000, crossover_rate=0, mutation_rate=0, elites=0, selection="tournament"))
    X = search.ask()
    search.tell(X[:, 0])
    assert search.ask()[:, 0].mean() == pytest.approx(1 / 3, abs=0.04)  # the mean of the smaller of two uniforms


def test_the_better_choices_are_better():
    f = shifted("sphere", 6)
    paper, better = (
        np.median([minimize(f, f.box, algorithm, Budget(5000), rng=seed).cost for seed in range(5)])
        for algorithm in (GA(), GA(selection="tournament", crossover="blend"))
    )
    assert better < 0.1 * paper
