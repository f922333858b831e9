"""Reach bounds are true: nothing reachable is ever excluded, and they are tight enough to be of use."""

import numpy as np
import pinocchio as pin
import pytest

from tests.robots_under_test import ARMS, CATALOGUE, chain_of


@pytest.mark.parametrize("oriented", [True, False])
@pytest.mark.parametrize("name", CATALOGUE + ARMS)
def test_no_reachable_pose_is_excluded(name: str, oriented: bool) -> None:
    chain = chain_of(name)
    reach = chain.reach(0, oriented)
    X = chain.box.sample(np.random.default_rng(0), 3000)
    corners = np.where(np.random.default_rng(1).random(X.shape) < 0.5, chain.box.lower, chain.box.upper)
    for pose in np.concatenate([chain.poses(X)[:, 0], chain.poses(corners)[:, 0]]):
        assert reach.gap(pin.SE3(pose)) == 0.0


@pytest.mark.parametrize(("name", "shoulder_to_wrist"), [("rv7fl", 0.435 + np.hypot(0.47, 0.05)), ("puma560", 0.8774)])
def test_with_a_spherical_wrist_the_bound_is_the_wrists_reach(name: str, shoulder_to_wrist: float) -> None:
    reach = chain_of(name).reach(0, True)
    assert reach.most == pytest.approx(shoulder_to_wrist, abs=2e-3)


@pytest.mark.parametrize("name", ["panda", "ur5", "ur10", "xarm7", "z1", "baxter"])
def test_the_bound_is_within_a_few_percent_of_what_samples_reach(name: str) -> None:
    chain = chain_of(name)
    reach = chain.reach(0, False)
    tips = chain.poses(chain.box.sample(np.random.default_rng(0), 50_000))[:, 0, :3, 3]
    assert np.linalg.norm(tips - reach.anchor, axis=1).max() > 0.85 * reach.most
