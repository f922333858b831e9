"""Measures of a Jacobian against their closed forms."""

import numpy as np
from numpy.testing import assert_allclose

from pin_metaik.dexterity import condition_number, manipulability, rank


def test_a_planar_arm_of_two_links_has_manipulability_l1_l2_sin_q2() -> None:
    for q1, q2 in np.random.default_rng(0).uniform(-np.pi, np.pi, (20, 2)):
        s1, c1, s12, c12 = np.sin(q1), np.cos(q1), np.sin(q1 + q2), np.cos(q1 + q2)
        J = np.array([[-0.5 * s1 - 0.3 * s12, -0.3 * s12], [0.5 * c1 + 0.3 * c12, 0.3 * c12]])
        assert_allclose(manipulability(J), 0.15 * abs(np.sin(q2)), atol=1e-15)


def test_condition_and_rank_of_a_diagonal_matrix() -> None:
    assert condition_number(np.diag([4.0, 2.0, 1.0])) == 4.0
    assert condition_number(np.diag([4.0, 0.0])) == np.inf
    assert rank(np.diag([4.0, 2.0, 1e-9])) == 2
