"""The shared loop: what it does with any step, good or bad."""

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import pin_metaik as mik
from pin_metaik.errors import InvalidSetting
from pin_metaik.ik.refine.iterate import Patience, iterate
from pin_metaik.ik.refine.lm import damped
from tests.robots_under_test import chain_of

X = np.array([0.3, -1.2, 1.4, -0.9, -1.5, 0.6])


class Recorder:
    """A step that remembers where it was asked for."""

    def __init__(self, dx: np.ndarray) -> None:
        self.dx, self.asked = dx, []

    def __call__(self, x: np.ndarray, r: np.ndarray, J: np.ndarray, square: float) -> np.ndarray:
        self.asked.append(x.copy())
        return self.dx


def problem() -> mik.IKProblem:
    chain = chain_of("ur5")
    return mik.IKProblem.of(chain, chain.placements(chain.q(X))[0])


def good(x: np.ndarray, r: np.ndarray, J: np.ndarray, square: float) -> np.ndarray:
    return damped(r, J, 1e-9)


def test_what_a_step_is_given_is_the_residual_and_its_derivative() -> None:
    seen = []

    def step(x: np.ndarray, r: np.ndarray, J: np.ndarray, square: float) -> np.ndarray:
        seen.append((r.copy(), J.copy(), square))
        return np.full(6, 1e-6) if len(seen) == 1 else np.full(6, np.nan)

    iterate(problem(), (X + 0.01)[None], 2, step, Patience())
    iterate(problem(), (X + 0.01)[None], 2, step, Patience())
    (r, J, square), (moved, *_) = seen[0], seen[1]
    assert J.shape == (6, 6)
    assert square == pytest.approx(r @ r)
    np.testing.assert_allclose(moved - r, J @ np.full(6, 1e-6), atol=1e-7)  # near the target, J is d log too


def test_a_start_that_stalls_is_given_up_after_as_many_steps_as_patience_has() -> None:
    still = Recorder(np.zeros(6))
    starts = chain_of("ur5").box.sample(np.random.default_rng(0), 3)
    refinement = iterate(problem(), starts, 1000, still, Patience(steps=5))
    assert refinement.evaluations == 3 * 6  # the sixth look shows that five steps brought nothing
    assert_array_equal([x for k, x in enumerate(still.asked) if k % 5 == 0], starts)


def test_no_start_gets_more_steps_than_iterations() -> None:
    still = Recorder(np.zeros(6))
    starts = chain_of("ur5").box.sample(np.random.default_rng(0), 3)
    assert iterate(problem(), starts, 1000, still, Patience(iterations=7, share=1.0)).evaluations == 3 * 7


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_a_step_that_is_not_finite_ends_its_start_and_the_next_has_its_turn(bad: float) -> None:
    def step(x: np.ndarray, r: np.ndarray, J: np.ndarray, square: float) -> np.ndarray:
        return good(x, r, J, square) if np.abs(x - X).max() < 0.1 else np.full(6, bad)

    refinement = iterate(problem(), np.array([X + 1.0, X - 1.0, X + 0.02]), 100, step, Patience())
    assert refinement.met
    np.testing.assert_allclose(refinement.x, X, atol=1e-8)


def test_a_step_across_the_limits_is_clipped_onto_them() -> None:
    limits = chain_of("ur5").limits
    wild = Recorder(np.full(6, 50.0))
    iterate(problem(), X[None] + 0.1, 3, wild, Patience())
    assert_array_equal(wild.asked[1], limits.upper)


def test_the_best_is_kept_when_a_step_makes_it_worse() -> None:
    refinement = iterate(problem(), X[None] + 0.1, 5, Recorder(np.full(6, 0.7)), Patience())
    assert_array_equal(refinement.x, X + 0.1)
    assert not refinement.met


def test_a_solution_is_kept_when_polishing_makes_it_worse() -> None:
    refinement = iterate(problem(), X[None] + 1e-7, 100, Recorder(np.full(6, 0.7)), Patience())
    assert refinement.met
    assert refinement.evaluations == 2
    assert_array_equal(refinement.x, X + 1e-7)


def test_without_evaluations_the_first_start_comes_back_inside_the_limits() -> None:
    refinement = iterate(problem(), np.full((2, 6), 50.0), 0, good, Patience())
    assert refinement.evaluations == 0
    assert_array_equal(refinement.x, chain_of("ur5").limits.upper)


def test_a_solution_met_by_the_last_evaluation_counts() -> None:
    needed = iterate(problem(), X[None] + 0.02, 100, good, Patience()).evaluations
    outcomes = [iterate(problem(), X[None] + 0.02, budget, good, Patience()).met for budget in range(1, needed + 1)]
    assert outcomes[-1]
    assert outcomes == sorted(outcomes)


@pytest.mark.parametrize("settings", [{"iterations": 0}, {"steps": 0}, {"share": 1.5}, {"share": float("nan")}])
def test_patience_that_makes_no_sense_is_refused(settings: dict[str, float]) -> None:
    with pytest.raises(InvalidSetting, match=next(iter(settings))):
        Patience(**settings)
