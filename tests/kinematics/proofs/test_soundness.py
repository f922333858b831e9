"""A proof is never wrong: what holds a solution is never excluded. ``benchmarks/proof_soundness.py`` runs far more."""

from types import ModuleType


def test_no_box_that_holds_a_solution_is_excluded(soundness: ModuleType) -> None:
    looked, wrong, arms = soundness.boxes(seed=11, count=20_000)
    assert looked >= 20_000 and arms > 20
    assert wrong == 0


def test_no_closed_form_calls_a_feasible_target_out_of_reach(soundness: ModuleType) -> None:
    looked, wrong, arms = soundness.closed(seed=11, count=10_000)
    assert looked == 10_000 and arms > 20
    assert wrong == 0


def test_solve_ik_calls_no_feasible_target_out_of_reach(soundness: ModuleType) -> None:
    looked, wrong, arms = soundness.public(seed=11, count=2_000)
    assert looked >= 2_000 and arms > 5
    assert wrong == 0
