"""Curves as uPlot takes them: one x for all, and numbers that its axis can show."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_array_equal

pytest.importorskip("viser")

from pin_metaik.gui.look.curves import aligned, drawable


def test_curves_share_one_x_and_hold_the_value_of_the_point_before() -> None:
    x, a, b = aligned({"a": ([0.0, 2.0], [5.0, 3.0]), "b": ([1.0, 3.0], [9.0, 4.0])})
    assert_array_equal(x, [0.0, 1.0, 2.0, 3.0])
    assert_array_equal(a, [5.0, 5.0, 3.0, 3.0])
    assert_array_equal(b, [9.0, 9.0, 9.0, 4.0])
    assert all(len(column) == 2 for column in aligned({"none": ([], [])}))


@pytest.mark.parametrize("log", [False, True])
def test_what_an_axis_cannot_show_is_at_its_edge(log: bool) -> None:
    columns = drawable((np.arange(5.0), np.array([np.inf, 8.0, 2.0, 0.0, np.nan])), log)
    assert_array_equal(columns[1], [8.0, 8.0, 2.0, 2.0, 2.0] if log else [8.0, 8.0, 2.0, 0.0, 0.0])
    assert np.isfinite(drawable((np.arange(2.0), np.zeros(2)), log)[1]).all()
