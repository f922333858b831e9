from __future__ import annotations

import numpy as np
import pytest

from pin_metaik.errors import InvalidSetting
from pin_metaik.optimize import AskTell, Box, Budget, Status

BOX = Box([-1.0, -1.0], [2.0, 2.0])


def test_asking_twice_or_telling_first_is_refused():
    search = AskTell(BOX, "gwo")
    with pytest.raises(InvalidSetting, match="without ask"):
        search.tell(np.zeros(30))
    search.ask()
    with pytest.raises(InvalidSetting, match="called twice"):
        search.ask()


def test_costs_of_the_wrong_length_may_be_told_again():
    search = AskTell(BOX, "gwo")
    X = search.ask()
    with pytest.raises(InvalidSetting, match=r"costs: expected shape \(30,\), got \(29,\)"):
        search.tell(np.zeros(29))
    search.tell(np.square(X).sum(axis=1))
    assert search.run.evaluations == 30


def test_nothing_is_best_before_the_first_costs():
    search = AskTell(BOX, "gwo")
    with pytest.raises(InvalidSetting, match="nothing is best yet"):
        search.best  # noqa: B018
    X = search.ask()
    search.tell(X[:, 0])
    assert search.best.cost == X[:, 0].min() == search.best.x[0]


def test_without_a_budget_it_goes_on():
    search = AskTell(BOX, "pso")
    for _ in range(200):
        search.tell(np.square(search.ask()).sum(axis=1))
    assert search.status is None
    assert search.best.cost < 1e-6


def test_after_the_end_there_is_nothing_to_ask_for():
    search = AskTell(BOX, "gwo", budget=Budget(10))
    X = search.ask()
    assert len(X) == 10
    search.tell(X[:, 0])
    assert search.status is Status.EVALUATIONS_SPENT
    with pytest.raises(InvalidSetting, match=r"ended \(evaluations spent\)"):
        search.ask()


def test_it_can_be_stopped():
    search = AskTell(BOX, "gwo")
    search.tell(search.ask()[:, 0])
    search.stop()
    assert search.status is Status.INTERRUPTED


def test_points_asked_for_belong_to_the_caller():
    searches = AskTell(BOX, "de"), AskTell(BOX, "de")
    for _ in range(5):
        for search, spoil in zip(searches, (False, True), strict=True):
            X = search.ask()
            costs = X[:, 0].copy()
            if spoil:
                X[:] = np.nan
            search.tell(costs)
    assert np.array_equal(searches[0].ask(), searches[1].ask())
