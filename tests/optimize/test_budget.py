from __future__ import annotations

import math

import numpy as np
import pytest

from pin_metaik.errors import InvalidBudget
from pin_metaik.optimize import Budget


@pytest.mark.parametrize("evaluations", [0, -5, 2.5, True, "many", math.nan, math.inf])
def test_evaluations_are_a_whole_number_above_zero(evaluations):
    with pytest.raises(InvalidBudget, match="evaluations"):
        Budget(evaluations)


@pytest.mark.parametrize("seconds", [0, -1.0, math.nan, "1", True])
def test_seconds_are_a_number_above_zero(seconds):
    with pytest.raises(InvalidBudget, match="seconds"):
        Budget(seconds=seconds)


@pytest.mark.parametrize("target", [math.nan, "low"])
def test_a_target_is_a_number(target):
    with pytest.raises(InvalidBudget, match="target"):
        Budget(10, target=target)


def test_numbers_of_numpy_are_numbers():
    Budget(np.int64(5), np.float64(1.5), np.float64(-2))


def test_a_target_alone_does_not_end_a_search():
    assert not Budget(target=1.0).ends
    assert Budget(1).ends
    assert Budget(seconds=1).ends
