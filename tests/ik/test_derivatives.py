"""What refiners descend along is the derivative of the residual, by finite differences, for every kind of target."""

from functools import cache

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

import pin_metaik as mik
from tests.robots_under_test import chain_of

STEP = 1e-6  # rad or m: central differences are off by its square, and by 1e-16 / STEP
FOLLOWING = """
<robot name="following"><link name="a"/><link name="b"/><link name="c"/><link name="d"/><link name="e"/>
<joint name="one" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
  <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="two" type="revolute"><parent link="b"/><child link="c"/><origin xyz="1 0 0"/><axis xyz="0 0.6 0.8"/>
  <limit lower="-3" upper="3" effort="1" velocity="1"/><mimic joint="one" multiplier="-2" offset="0.3"/></joint>
<joint name="three" type="prismatic"><parent link="c"/><child link="d"/><origin xyz="0.5 0 0"/><axis xyz="1 0 0"/>
  <limit lower="-1" upper="1" effort="1" velocity="1"/><mimic joint="one" multiplier="0.5"/></joint>
<joint name="four" type="prismatic"><parent link="d"/><child link="e"/><origin xyz="0 0.2 0"/><axis xyz="0 0.6 -0.8"/>
  <limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>
"""
KINDS = {
    "pose": {},
    "position": {"orientation_tolerance": np.inf},
    "orientation": {"position_tolerance": np.inf},
    "a free rotation": {"orientation_tolerance": (1e-5, 1e-5, np.inf)},
    "a line": {"position_tolerance": (1e-5, np.inf, 1e-5)},
    "slack": {"position_tolerance": (0.05, 0.02, 0.01), "orientation_tolerance": (0.05, 0.2, 0.1)},
    "balls": {"position_tolerance": 0.03, "orientation_tolerance": 0.2},
    "weights": {"position_weight": 3.0, "orientation_weight": 0.3},
    "free and weighted": {"orientation_tolerance": (1e-5, np.inf, 1e-5), "orientation_weight": 0.3},
}


@cache
def chain(name: str) -> mik.Chain:
    match name:
        case "two frames":
            return mik.Chain(mik.load_robot("talos").model, ["gripper_left_base_link", "gripper_right_base_link"])
        case "mimics and slides":
            return mik.Chain(pin.buildModelFromXML(FOLLOWING, True), "e")
        case _:
            return chain_of(name)  # panda, ur5: hinges; cobra600, tiago: a slide among them


def true_rows(problem: mik.IKProblem, x: np.ndarray, J: np.ndarray) -> np.ndarray:
    """J (n, m) with the rotation rows that are angular velocity made those of the rotation vector."""
    J = J.copy()
    placements = problem.chain.placements(problem.chain.q(x))
    for t, (target, placement) in enumerate(zip(problem.targets, placements, strict=True)):
        rows = np.flatnonzero((problem.rows[:, 0] == t) & (problem.rows[:, 1] >= 3))
        if len(rows) == 3 and not problem.records[t, 15:18].any():
            w = pin.log3(target.pose.rotation.T @ placement.rotation)
            J[:, rows] = J[:, rows] @ pin.Jlog3(pin.exp3(-w)).T  # Jl^-1(w) = Jr^-1(-w)
    return J


@pytest.mark.parametrize("whole", [False, True], ids=["aimed at the middle", "aimed at all that is accepted"])
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", ["panda", "ur5", "cobra600", "tiago", "two frames", "mimics and slides"])
def test_what_refiners_descend_along_is_the_derivative_of_the_residual(name: str, kind: str, whole: bool) -> None:
    arm = chain(name)
    rng = np.random.default_rng(0)
    for x, goal in zip(arm.box.sample(rng, 5), arm.box.sample(rng, 5), strict=True):
        frames = arm.frames if len(arm.frames) > 1 else (None,)
        poses = arm.placements(arm.q(goal))
        targets = [mik.Target(pose, frame, **KINDS[kind]) for pose, frame in zip(poses, frames, strict=True)]
        problem = mik.IKProblem.of(arm, targets if len(targets) > 1 else targets[0])
        problem = problem.whole if whole else problem
        _, J = problem.linearize(x)
        differences = np.array(
            [(problem.linearize(x + h)[0] - problem.linearize(x - h)[0]) / (2.0 * STEP) for h in STEP * np.eye(arm.n)]
        )
        assert_allclose(true_rows(problem, x, J), differences, atol=2e-7)


def test_near_the_target_all_rows_are_the_derivative() -> None:
    arm = chain("panda")
    x = arm.box.sample(np.random.default_rng(1), 1)[0]
    problem = mik.IKProblem.of(arm, arm.placements(arm.q(x + 1e-7))[0])
    _, J = problem.linearize(x)
    differences = [(problem.linearize(x + h)[0] - problem.linearize(x - h)[0]) / (2.0 * STEP) for h in STEP * np.eye(7)]
    assert_allclose(J, differences, atol=2e-6)  # half the angle to the target, below 1e-6 rad
