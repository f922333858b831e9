"""Limits of one's own are taken as they are, with a word where they are hardly meant."""

import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose

import pin_metaik as mik


def panda_with(**limits):
    robot = mik.load_robot("panda")
    return mik.Chain(robot.model, robot.frame, limits=limits)


def test_own_limits_in_degrees_are_said_to_be():
    with pytest.warns(
        UserWarning, match=r"joint 'panda_joint4' has limits \[-90, -45\] rad: probably degrees; they are"
    ):
        chain = panda_with(panda_joint4=(-90, -45))
    assert (chain.limits.lower[3], chain.limits.upper[3]) == (-90.0, -45.0)


def test_own_limits_beyond_the_models_are_said_to_be():
    with pytest.warns(UserWarning, match=r"'panda_joint1' has own limits \[-3, 3\] beyond \[-2\.8973, 2\.8973\]"):
        panda_with(panda_joint1=(-3, 3))


def test_own_limits_inside_the_models_or_of_a_joint_that_has_none_are_taken_without_a_word():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        panda_with(panda_joint1=(-1, 2.8973), panda_joint2=(-0.5, 0.5))
        mik.Chain(mik.load_robot("aerial_arm").model, "tool0", limits={})


def test_the_way_of_a_continuous_joint_is_the_shorter_one_and_at_half_a_turn_that_of_the_nearest_copy():
    lower, upper = np.array([-np.inf, -4.0, 0.0]), np.array([np.inf, 4.0, 1.0])
    rotates = np.array([True, True, False])
    limits = mik.Limits(lower, upper, np.ones(3), rotates, rotates, ("continuous", "turning", "sliding"))
    a = np.array([0.1, -3.0, 0.2])
    assert_allclose(limits.way(a, np.array([6.0, 3.0, 0.9])), [5.9 - 2.0 * np.pi, 6.0, 0.7], atol=1e-15)
    for half in (np.pi, -np.pi, 3.0 * np.pi):
        b = np.add(a, [half, 0.0, 0.0])
        assert limits.way(a, b)[0] == pytest.approx(limits.nearest_turns(b, a)[0] - a[0], abs=1e-15)
        assert_allclose(a, [0.1, -3.0, 0.2])
