"""Killed, without room, or twice at once: what was done is kept, and is what it would have been."""

from random import Random

import faults
import pytest


@pytest.mark.slow
@pytest.mark.parametrize(("fault", "count"), [("kills", 1), ("full", 1), ("twice", 1), ("clock", 1)])
def test_nothing_is_lost_and_nothing_is_there_twice(fault: str, count: int) -> None:
    for one in faults.FAULTS[fault](count, Random(1)):
        assert one.times >= 1
        assert one.wrong == 0, one
