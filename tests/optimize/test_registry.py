from __future__ import annotations

import pytest

from pin_metaik.errors import InvalidSetting, UnknownName
from pin_metaik.optimize import ALGORITHMS, make
from pin_metaik.optimize.gwo import GWO


def test_a_name_gives_the_algorithm_with_its_defaults():
    assert make("gwo") == GWO()


def test_an_object_is_returned_as_it_is():
    mine = GWO(agents=7)
    assert make(mine) is mine


def test_an_unknown_name_is_refused_with_those_there_are():
    with pytest.raises(UnknownName) as error:
        make("wolf")
    assert error.value.known == sorted(ALGORITHMS)


@pytest.mark.parametrize("thing", [GWO, 3, None, object()])
def test_what_is_neither_a_name_nor_an_algorithm_is_refused(thing):
    with pytest.raises(InvalidSetting, match="not a metaheuristic"):
        make(thing)
