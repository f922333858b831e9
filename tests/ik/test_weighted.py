"""Criteria in which joints do not count alike."""

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

import pin_metaik as mik
from pin_metaik.errors import InvalidSetting, UnknownName
from tests.robots_under_test import chain_of


def test_the_weighted_nearest_solution_is_the_best_of_all() -> None:
    chain, rng = chain_of("ur5"), np.random.default_rng(0)
    heavy, others = mik.Weighted("nearest", {chain.names[0]: 10.0, chain.names[5]: 0.0}), 0
    weights = np.array([10.0, 1.0, 1.0, 1.0, 1.0, 0.0])
    for x, x0 in zip(chain.box.sample(rng, 10), chain.box.sample(rng, 10), strict=True):
        pose, q0 = chain.poses(x)[0, 0], chain.q(x0)
        every = mik.solve_ik_all(chain, pose, q0)
        values = [np.linalg.norm(weights * (chain.limits.nearest_turns(one, x0) - x0)) for one in every.x]
        assert_allclose(every.best(heavy, q0), every.q[int(np.argmin(values))], atol=0.0)
        result = mik.solve_ik(chain, pose, q0, solver=mik.IKSolver(select=heavy))
        assert np.linalg.norm(weights * (result.x - x0)) <= min(values) + 1e-4
        others += int(np.argmin(values) != 0)
    assert others  # the weights have changed something


def test_the_weighted_nearest_point_of_curves_is_nearer_than_any_that_is_sampled() -> None:
    chain, rng = chain_of("panda"), np.random.default_rng(7)
    pose, q0 = chain.poses(chain.box.sample(rng, 1))[0, 0], chain.q(chain.box.sample(rng, 1)[0])
    weights = {chain.names[3]: 5.0, chain.names[0]: 0.0}
    w = np.array([weights.get(name, 1.0) for name in chain.names])
    motions, x0 = mik.self_motions(chain, pose, q0), chain.x(q0)
    best = motions.nearest(q0, weights)
    sampled = [np.linalg.norm(w * (chain.x(q) - x0)) for curve in motions for q in curve.sample(0.1)]
    assert best.value <= min(sampled) + 1e-4
    assert_allclose(best.value, motions.best(mik.Weighted("nearest", weights)).value, atol=1e-4)
    assert_allclose(best.value, np.linalg.norm(w * (chain.x(best.q) - x0)), atol=1e-9)
    assert motions.nearest(q0, dict.fromkeys(chain.names, 0.0)).value == 0.0
    safe = mik.Weighted("limits", {chain.names[5]: 0.0})
    assert motions.best(safe).value <= motions.best("limits").value + 1e-4


def test_weighted_torques_are_those_that_joints_hold() -> None:
    chain = chain_of("ur5")
    x = np.array([0.3, -1.2, 1.4, -0.9, -1.5, 0.6])
    every = mik.solve_ik_all(chain, chain.poses(x)[0, 0])
    elbow = mik.Weighted("torque", {name: 0.0 for name in chain.names if name != chain.names[2]})
    held = [abs(pin.computeGeneralizedGravity(chain.model, chain.data, q)[2]) for q in every.q]
    assert_allclose(every.best(elbow), every.q[int(np.argmin(held))], atol=0.0)


def test_weights_that_make_no_sense_are_named() -> None:
    chain = chain_of("ur5")
    pose = chain.poses(np.array([0.3, -1.2, 1.4, -0.9, -1.5, 0.6]))[0, 0]
    with pytest.raises(UnknownName, match="known: limits, nearest, torque"):
        mik.Weighted("clearance", {})
    with pytest.raises(InvalidSetting, match="at least 0"):
        mik.Weighted("nearest", {"elbow_joint": -1.0})
    with pytest.raises(UnknownName, match="did you mean 'elbow_joint'"):
        mik.solve_ik(chain, pose, solver=mik.IKSolver(select=mik.Weighted("nearest", {"elbow_join": 2.0})))
    with pytest.raises(InvalidSetting, match="no solution"):
        mik.solve_ik_all(chain, [5.0, 0.0, 0.0]).best("nearest")
