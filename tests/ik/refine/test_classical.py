"""The step formulas of the classical methods, against the formulas of their papers."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from pin_metaik.errors import InvalidSetting
from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.refine import LM, SDLS, Newton, Transpose
from pin_metaik.ik.refine.sdls import clamp, effectors_of
from tests.robots_under_test import chain_of

RNG = np.random.default_rng(0)
SHAPES = [(6, 7), (6, 6), (6, 4), (3, 7), (12, 14)]  # (m, n)
WHOLE_POSE = np.repeat(np.eye(2), 3, axis=1)  # position and orientation of one frame


def linearized(m: int, n: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """Some x, r, J and |r|^2."""
    r = RNG.normal(size=m)
    return np.zeros(n), r, RNG.normal(size=(m, n)), float(r @ r)


@pytest.mark.parametrize("shape", SHAPES)
def test_levenberg_and_marquardts_steps_are_those_of_the_papers(shape: tuple[int, int]) -> None:
    x, r, J, square = linearized(*shape)
    E, one = 0.5 * square, np.eye(shape[1])
    W_n = {"chan": 0.3 * E * one, "sugihara": (E + 0.3) * one, "wampler": 0.3 * one}
    for rule, W in W_n.items():
        step = LM(rule, 0.3).step(x, r, J, square)
        assert_allclose(step, -np.linalg.solve(J.T @ J + W, J.T @ r), atol=1e-12)


def test_without_a_scale_levenberg_and_marquardt_take_the_one_of_their_rule() -> None:
    x, r, J, square = linearized(6, 7)
    for rule, scale in {"chan": 0.1, "sugihara": 1e-4, "wampler": 1e-4}.items():
        assert_allclose(LM(rule).step(x, r, J, square), LM(rule, scale).step(x, r, J, square), rtol=0.0)


@pytest.mark.parametrize("rule", ["chan", "sugihara", "wampler"])
def test_damping_keeps_steps_finite_where_the_jacobian_has_lost_its_rank(rule: str) -> None:
    x, r, J, _ = linearized(6, 7)
    J[3:] = 0.0
    for size in (1.0, 1e-3, 1e-8):
        assert np.isfinite(LM(rule).step(x, size * r, J, size**2 * float(r @ r))).all()
        assert (LM(rule).step(x, size * r, np.zeros((6, 7)), size**2 * float(r @ r)) == 0.0).all()


@pytest.mark.parametrize("shape", SHAPES)
def test_newtons_step_is_the_pseudo_inverse(shape: tuple[int, int]) -> None:
    x, r, J, square = linearized(*shape)
    assert_allclose(Newton().step(x, r, J, square), -np.linalg.pinv(J) @ r, atol=1e-10)


def test_newton_leaves_out_directions_below_its_cutoff() -> None:
    U, _, Vt = np.linalg.svd(RNG.normal(size=(6, 7)), full_matrices=False)
    J = U @ np.diag([1.0, 1.0, 1.0, 1.0, 1.0, 1e-4]) @ Vt
    r = U[:, 5]
    assert np.abs(Newton(1e-3).step(np.zeros(7), r, J, 1.0)).max() < 1e-9
    assert_allclose(Newton(1e-5).step(np.zeros(7), r, J, 1.0), -1e4 * Vt[5], rtol=1e-6)


@pytest.mark.parametrize("shape", SHAPES)
def test_the_transposes_step_is_the_best_along_the_gradient(shape: tuple[int, int]) -> None:
    x, r, J, square = linearized(*shape)
    dx = Transpose().step(x, r, J, square)
    g = J.T @ r
    assert_allclose(dx / np.linalg.norm(dx), -g / np.linalg.norm(g), atol=1e-12)
    left = [np.linalg.norm(r + scale * J @ dx) for scale in (0.99, 1.0, 1.01)]
    assert left[1] < min(left[0], left[2])


def test_the_transpose_knows_no_way_on_where_the_gradient_is_zero() -> None:
    assert np.isnan(Transpose().step(np.zeros(7), np.ones(6), np.zeros((6, 7)), 6.0)).all()


def test_no_coordinate_moves_further_than_selective_damping_allows() -> None:
    for _ in range(50):
        _, r, J, _ = linearized(6, 7)
        J[5] *= 10.0 ** -RNG.integers(0, 8)  # down to singular
        for largest in (0.1, np.pi / 4.0):
            dx = SDLS(largest).step(r, J, WHOLE_POSE)
            assert np.abs(dx).max() <= largest * (1.0 + 1e-12)
    assert np.isfinite(SDLS().step(r, np.zeros((6, 7)), WHOLE_POSE)).all()


def test_selective_damping_leaves_small_steps_alone() -> None:
    _, r, J, _ = linearized(6, 7)
    assert_allclose(SDLS().step(1e-4 * r, J, WHOLE_POSE), -1e-4 * np.linalg.pinv(J) @ r, atol=1e-12)


def test_selective_damping_is_that_of_the_paper_written_out_loop_by_loop() -> None:
    _, r, J, _ = linearized(6, 7)
    e, gamma_max = -r, 0.6
    U, sigma, Vt = np.linalg.svd(J)
    total = np.zeros(7)
    for i in range(6):
        N = sum(np.linalg.norm(U[3 * k : 3 * k + 3, i]) for k in range(2))
        M = sum(abs(Vt[i, j]) / sigma[i] * np.linalg.norm(J[3 * k : 3 * k + 3, j]) for k in range(2) for j in range(7))
        gamma = min(1.0, N / M) * gamma_max
        phi = U[:, i] @ e / sigma[i] * Vt[i]
        total += phi if np.abs(phi).max() <= gamma else gamma * phi / np.abs(phi).max()
    expected = total if np.abs(total).max() <= gamma_max else gamma_max * total / np.abs(total).max()
    assert_allclose(SDLS(gamma_max).step(r, J, WHOLE_POSE), expected, atol=1e-12)


def test_clamping_scales_a_row_and_keeps_its_direction() -> None:
    rows = np.array([[3.0, -4.0], [0.1, 0.2], [0.0, 0.0]])
    assert_allclose(clamp(rows, 1.0), [[0.75, -1.0], [0.1, 0.2], [0.0, 0.0]])


def test_positions_and_orientations_are_effectors_of_their_own() -> None:
    chain = chain_of("ur5")
    goal = chain.placements(chain.reference)[0]
    assert (effectors_of(IKProblem.of(chain, goal)) == WHOLE_POSE).all()
    assert (effectors_of(IKProblem.of(chain, goal.translation)) == np.ones((1, 3))).all()


def test_settings_that_make_no_sense_are_refused() -> None:
    with pytest.raises(InvalidSetting, match="'chan', 'sugihara', 'wampler'"):
        LM("chen")  # type: ignore[arg-type]
    with pytest.raises(InvalidSetting, match="scale"):
        LM("chan", 0.0)
    with pytest.raises(InvalidSetting, match="cutoff"):
        Newton(-1.0)
    with pytest.raises(InvalidSetting, match="largest"):
        SDLS(largest=float("nan"))
