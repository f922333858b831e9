"""A proof is never wrong: what holds a solution is never excluded. ``benchmarks/proof_soundness.py`` runs far more."""

from types import ModuleType


def test_no_box_that_holds_a_solution_is_excluded(soundness: ModuleType) -> None:
    looked, wrong, arms = soundness.boxes(seed=11, count=20_000)
    assert looked >= 20_000 and arms > 20
    assert wrong == 0


def test_no_closed_form_calls_a_feasible_target_out_of_reach(soundness: ModuleType) -> None:
    assert soundness.closed(seed=11, count=10_000) == (10_000, 0, 6)
