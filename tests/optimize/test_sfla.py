from __future__ import annotations

import numpy as np
import pytest

from pin_metaik.optimize import AskTell, Box, Budget, minimize
from pin_metaik.optimize.sfla import SFLA

BOX = Box([-1.0, -1.0, -1.0], [2.0, 2.0, 2.0])


def dealt(X, f, m):
    """Memeplexes as lists of frogs, best first, as the paper deals them."""
    order = f.argsort(kind="stable")
    return [X[order[j::m]] for j in range(m)]


def between(x, start, leader, reach):
    """Whether x lies on the way from start to leader, as far as reach times the way, coordinate by coordinate."""
    shares = (x - start) / (leader - start)
    return bool(((shares >= -1e-12) & (shares <= reach + 1e-12)).all())


@pytest.mark.parametrize("frogs", [12, 13, 14])
def test_only_the_worst_frog_of_each_memeplex_leaps_towards_its_best(frogs):
    search = AskTell(
        Box([-9.0] * 3, [9.0] * 3), SFLA(frogs, 3, leap=1.3), seeds=BOX.sample(np.random.default_rng(0), 99)
    )
    X = search.ask()
    f = np.square(X).sum(axis=1)
    search.tell(f)
    leaps = search.ask()
    assert leaps.shape == (3, 3)
    for x, memeplex in zip(leaps, dealt(X, f, 3), strict=True):
        assert between(x, memeplex[-1], memeplex[0], 1.3)


def test_a_frog_that_did_not_improve_leaps_towards_the_best_of_all_and_then_anywhere():
    wide = Box([-9.0] * 3, [9.0] * 3)
    search = AskTell(wide, SFLA(12, 3), seeds=BOX.sample(np.random.default_rng(0), 12))
    X = search.ask()
    f = np.square(X).sum(axis=1)
    search.tell(f)
    first, second, third = (memeplex[-1] for memeplex in dealt(X, f, 3))
    leaps = search.ask()
    search.tell([np.inf, f.min() + 1e-9, np.inf])  # the second frog improves and is done
    towards_best = search.ask()
    assert len(towards_best) == 2
    for x, frog in zip(towards_best, (first, third), strict=True):
        assert between(x, frog, X[f.argmin()], 1.3)
    search.tell([np.inf, f.max() - 1e-9])  # the third improves, the first does not
    anywhere = search.ask()
    assert len(anywhere) == 1
    assert not between(anywhere[0], first, X[f.argmin()], 1.3)
    search.tell([np.inf])  # the random frog stays whatever it costs
    leaders = [memeplex[0] for memeplex in dealt(X, f, 3)]
    again = search.ask()
    assert between(again[0], anywhere[0], leaders[0], 1.3)
    assert not between(again[0], first, leaders[0], 1.3)
    assert between(again[1], dealt(X, f, 3)[1][-2], leaps[1], 1.3)  # the second leads its memeplex from where it leapt
    assert not between(again[1], dealt(X, f, 3)[1][-2], second, 1.3)


def test_without_fallbacks_a_frog_waits_for_a_better_leap():
    search = AskTell(BOX, SFLA(12, 3, leap=1.0, fallbacks=False))
    X = search.ask()
    f = np.square(X).sum(axis=1)
    search.tell(f)
    for _ in range(4):
        leaps = search.ask()
        assert len(leaps) == 3
        for x, memeplex in zip(leaps, dealt(X, f, 3), strict=True):
            assert between(x, memeplex[-1], memeplex[0], 1.0)
        search.tell([np.inf] * 3)


def test_no_leap_is_longer_than_the_largest():
    search = AskTell(BOX, SFLA(12, 3, largest_leap=0.01, fallbacks=False))
    X = search.ask()
    f = np.square(X).sum(axis=1)
    search.tell(f)
    worst = np.array([memeplex[-1] for memeplex in dealt(X, f, 3)])
    step = np.abs(search.ask() - worst)
    assert (step <= 0.01 * BOX.width + 1e-15).all()
    assert (step > 0.0099 * BOX.width).any()


def test_memeplexes_are_shuffled_after_their_leaps():
    search = AskTell(BOX, SFLA(12, 3, leaps=5, fallbacks=False))
    X = search.ask()
    f = np.square(X).sum(axis=1)
    search.tell(f)
    pond = [f.argsort(kind="stable")[j::3] for j in range(3)]
    for _ in range(5):
        leaps = search.ask()
        costs = np.square(leaps).sum(axis=1)
        search.tell(costs)
        for frogs, x, cost in zip(pond, leaps, costs, strict=True):
            worst = frogs[f[frogs].argmax()]
            if cost < f[worst]:
                X[worst], f[worst] = x, cost
    shuffled = search.ask()
    for x, memeplex in zip(shuffled, dealt(X, f, 3), strict=True):
        assert between(x, memeplex[-1], memeplex[0], 1.3)
    ends = [(frogs[f[frogs].argmax()], frogs[f[frogs].argmin()]) for frogs in pond]  # of the memeplexes before
    unshuffled = [between(x, X[worst], X[best], 1.3) for (worst, best), x in zip(ends, shuffled, strict=True)]
    assert not all(unshuffled)


@pytest.mark.parametrize("frogs", [12, 13, 14])
def test_all_frogs_but_the_best_of_each_memeplex_can_leap_at_once(frogs):
    search = AskTell(
        Box([-9.0] * 3, [9.0] * 3),
        SFLA(frogs, 3, leaps=2, leapers="all"),
        seeds=BOX.sample(np.random.default_rng(0), 99),
    )
    X = search.ask()
    f = np.square(X).sum(axis=1)
    search.tell(f)
    order = f.argsort(kind="stable")
    followers, leaders = X[order[3:]], X[order[np.arange(3, frogs) % 3]]
    leaps = search.ask()
    assert len(leaps) == frogs - 3
    for x, start, leader in zip(leaps, followers, leaders, strict=True):
        assert between(x, start, leader, 1.3)
    costs = np.arange(frogs - 3) - 99.0  # the first three beat their leaders and lead from now on
    search.tell(costs)
    second = search.ask()
    others = np.concatenate((X[order[:3]], leaps[3:]))  # by frog: the old leaders come first
    assert len(second) == frogs - 3
    for i, (x, start) in enumerate(zip(second, others, strict=True)):
        assert between(x, start, leaps[i % 3], 1.3)


def test_when_all_leap_the_fallbacks_are_for_those_that_did_not_improve():
    search = AskTell(Box([-9.0] * 3, [9.0] * 3), SFLA(12, 3, leapers="all"))
    X = search.ask()
    f = np.square(X).sum(axis=1)
    search.tell(f)
    search.ask()
    search.tell([*[np.inf] * 4, *[f.min() + 1e-9] * 5])
    towards_best = search.ask()
    frogs = X[f.argsort(kind="stable")[3:7]]
    assert len(towards_best) == 4
    for x, frog in zip(towards_best, frogs, strict=True):
        assert between(x, frog, X[f.argmin()], 1.3)
    search.tell([np.inf] * 4)
    assert len(search.ask()) == 4


def test_fallbacks_are_paid_for():
    counted = []

    def objective(X):
        counted.append(len(X))
        return np.square(X).sum(axis=1)

    assert minimize(objective, BOX, SFLA(12, 3), Budget(5000)).evaluations == sum(counted) == 5000
    assert set(counted[1:-1]) == {1, 2, 3}


def test_the_modified_leap_beats_the_published_one():
    """Ibrahim's C_L = 1.3 against 1: leaps that stop short of the leader make the population shrink too soon."""
    f = lambda X: np.square(X - 0.3).sum(axis=1)  # noqa: E731
    box = Box([-5.0] * 6, [5.0] * 6)
    modified, published = (
        np.median([minimize(f, box, SFLA(leap=leap), Budget(4000), rng=seed).cost for seed in range(5)])
        for leap in (1.3, 1.0)
    )
    assert modified < 0.1 * published
