"""Limits of one's own are taken as they are, with a word where they are hardly meant."""

import warnings

import pytest

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
