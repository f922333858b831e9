"""The measurement behind the unit of comparisons still runs."""

import importlib
from pathlib import Path

import pytest

from pin_metaik.compare.methods.cost import FK_WITH_JACOBIAN

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"


@pytest.mark.slow
def test_a_jacobian_costs_about_what_comparisons_charge_for_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(BENCHMARKS)
    costs = importlib.import_module("kernel_costs")
    monkeypatch.setattr(costs, "ROUNDS", 20)
    alone, both = costs.measured("ur5", (costs.loop(False), costs.loop(True)))
    assert 0.6 * FK_WITH_JACOBIAN < both / alone < 1.7 * FK_WITH_JACOBIAN  # a busy machine may slow either
