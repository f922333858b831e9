"""Placements by a model of one limb are those of the whole model, wherever the other joints are."""

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

import pin_metaik as mik
from tests.robots_under_test import ARMS, chain_of

LIMBS = ["baxter", "pr2", "talos", "tiago", "anymal_kinova", "b1_z1"]


@pytest.mark.parametrize("name", sorted({*ARMS, *LIMBS}))
def test_a_frame_is_placed_as_in_the_whole_model(name: str) -> None:
    chain = chain_of(name)
    model, frame, rng = chain.model, chain.frame_ids[0], np.random.default_rng(0)
    q = np.array([pin.integrate(model, pin.neutral(model), rng.uniform(-1.5, 1.5, model.nv)) for _ in range(50)])
    places = chain.tip.fk_batch(q)
    for one, place in zip(q, places, strict=True):
        pin.forwardKinematics(model, chain.data, one)
        whole = pin.updateFramePlacement(model, chain.data, frame)
        assert_allclose(chain.tip.fk(one).homogeneous, whole.homogeneous, atol=1e-12)
        assert_allclose(place, pin.SE3ToXYZQUATtuple(whole), atol=1e-12)
    assert chain.tip.reduced.njoints == len(model.supports[model.frames[frame].parentJoint])
    assert chain.tip.reduced.nframes == 2


def test_a_joint_on_the_way_that_mimics_another_keeps_the_whole_model() -> None:
    model = mik.load_robot("tiago_pro").model
    mimic = next(j for j in range(1, model.njoints) if model.joints[j].nq == 0)
    frame = next(f.name for f in model.frames if f.parentJoint == mimic and f.type == pin.FrameType.BODY)
    chain = mik.Chain(model, frame)
    assert chain.tip.reduced is model
    q = chain.q(chain.box.sample(np.random.default_rng(0), 1)[0])
    assert_allclose(chain.tip.fk(q).homogeneous, chain.placements(q)[0].homogeneous, atol=1e-15)
