"""Chains: what they take from a model, x <-> q both ways, and errors where the input enters."""

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

import pin_metaik as mik
from pin_metaik.errors import (
    FixedFrame,
    FrameNotFound,
    InvalidBounds,
    InvalidConfiguration,
    UnknownName,
)
from tests.robots_under_test import ARMS, CATALOGUE, chain_of


@pytest.mark.parametrize("name", CATALOGUE + ARMS)
def test_coordinates_go_to_a_configuration_and_back(name: str) -> None:
    chain = chain_of(name)
    X = chain.box.sample(np.random.default_rng(0), 20)
    assert_allclose(chain.x(chain.q(X)), X, atol=1e-12)  # an angle from its cos and sin
    assert pin.isNormalized(chain.model, chain.q(X)[0], 1e-9)


@pytest.mark.parametrize("name", CATALOGUE + ARMS)
def test_integrating_a_step_in_pinocchio_is_adding_it_to_x(name: str) -> None:
    chain = chain_of(name)
    rng = np.random.default_rng(1)
    x, dx = 0.5 * chain.box.sample(rng, 1)[0], 0.1 * rng.standard_normal(chain.n)
    v = np.zeros(chain.model.nv)
    v[[chain.model.joints[int(j)].idx_v for j in chain.coordinates.joints]] = dx
    assert_allclose(pin.integrate(chain.model, chain.q(x), v), chain.q(x + dx), atol=1e-12)


def test_a_continuous_joint_has_no_limits_and_is_sampled_over_one_turn() -> None:
    chain = chain_of("kinova")
    assert chain.limits.periodic.tolist() == [True, False, False, True, False, True]
    assert_allclose(chain.box.width[chain.limits.periodic], 2 * np.pi)


def test_a_prismatic_joint_is_a_coordinate_in_metres() -> None:
    chain = chain_of("tiago")
    assert chain.names[0] == "torso_lift_joint"
    assert not chain.limits.rotates[0]
    assert chain.limits.rotates[1:].all()


MIMIC = """
<robot name="mimic"><link name="a"/><link name="b"/><link name="c"/><link name="d"/>
<joint name="one" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
  <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="two" type="revolute"><parent link="b"/><child link="c"/><origin xyz="1 0 0"/><axis xyz="0 0.6 0.8"/>
  <limit lower="-3" upper="3" effort="1" velocity="1"/><mimic joint="one" multiplier="-2" offset="0.3"/></joint>
<joint name="three" type="prismatic"><parent link="c"/><child link="d"/><origin xyz="0.5 0 0"/><axis xyz="1 0 0"/>
  <limit lower="-1" upper="1" effort="1" velocity="1"/><mimic joint="one" multiplier="0.5"/></joint></robot>
"""


def test_mimic_joints_follow_as_scaled_copies() -> None:
    chain = mik.Chain(pin.buildModelFromXML(MIMIC, True), "d")
    assert chain.names == ("one",)
    for x in (-0.7, 0.0, 0.9):
        assert_allclose(chain.poses([[x]])[0, 0], chain.placements(chain.q([x]))[0].homogeneous, atol=1e-12)
    goal = chain.placements(chain.q([0.4]))[0]
    assert_allclose(mik.solve_ik(chain, goal).x, [0.4], atol=1e-6)


def test_limits_of_a_joint_that_follows_bind_the_one_it_follows() -> None:
    model = pin.buildModelFromXML(MIMIC, True)
    chain = mik.Chain(model, "d", limits={"two": (-0.5, 0.9), "three": (-0.2, 0.9)})  # -2 one + 0.3, and 0.5 one
    assert_allclose([chain.limits.lower, chain.limits.upper], [[-0.3], [0.4]])
    for x in chain.box.sample(np.random.default_rng(0), 20):
        assert mik.solve_ik(chain, chain.placements(chain.q(x))[0]).success
    beyond = chain.placements(chain.q([0.6]))[0]
    assert not mik.solve_ik(chain, beyond).success
    both = mik.Chain(model, "d", limits={"one": (0.0, 0.1), "two": (-0.5, 0.9)})
    assert_allclose([both.limits.lower, both.limits.upper], [[0.0], [0.1]])
    with pytest.raises(InvalidBounds, match=r"'two' is at -2 'one' \+ 0\.3: its limits .* leave no room to 'one'"):
        mik.Chain(model, "d", limits={"two": (2.5, 2.9)})
    with pytest.raises(InvalidBounds, match=r"'two' has its lower limit 1\.0 above"):
        mik.Chain(model, "d", limits={"two": (1.0, 0.0)})


def test_locked_joints_stay_at_the_reference() -> None:
    model = mik.load_robot("panda").model
    reference = pin.neutral(model)
    reference[2] = 0.5
    chain = mik.Chain(model, "panda_hand_tcp", locked=["panda_joint3"], reference=reference)
    assert "panda_joint3" not in chain.names
    x = chain.box.sample(np.random.default_rng(0), 1)[0]
    assert chain.q(x)[2] == 0.5
    assert_allclose(chain.poses([x])[0, 0], chain.placements(chain.q(x))[0].homogeneous, atol=1e-12)


def test_a_free_flyer_on_the_path_can_be_locked() -> None:
    model = mik.load_robot("ur5", free_flyer=True).model
    chain = mik.Chain(model, "tool0", locked=["root_joint"])
    assert chain.n == 6
    x = chain.box.sample(np.random.default_rng(0), 1)[0]
    assert_allclose(chain.poses([x])[0, 0], chain.placements(chain.q(x))[0].homogeneous, atol=1e-12)


def test_several_frames_share_coordinates() -> None:
    chain = mik.Chain(mik.load_robot("talos").model, ["gripper_left_base_link", "gripper_right_base_link"])
    assert chain.n == 16  # two torso joints shared by two arms of seven
    X = chain.box.sample(np.random.default_rng(0), 10)
    for x, poses in zip(X, chain.poses(X), strict=True):
        for pose, placement in zip(poses, chain.placements(chain.q(x)), strict=True):
            assert_allclose(pose, placement.homogeneous, atol=1e-12)


def screws(pitch: float = 0.1, lower: float = -9.0, upper: float = 9.0) -> pin.Model:
    """A helical joint, with joints before and after it."""
    model = pin.Model()
    kinds = pin.JointModelRX(), pin.JointModelHelicalUnaligned(np.array([0.0, 0.6, -0.8]), pitch), pin.JointModelPY()
    for joint, kind in enumerate(kinds):
        model.addJoint(joint, kind, pin.SE3(np.eye(3), np.array([0.1, 0.2, 0.3])), f"joint_{joint + 1}")
    model.lowerPositionLimit, model.upperPositionLimit = np.array([-2.0, lower, -0.3]), np.array([2.0, upper, 0.4])
    model.addFrame(
        pin.Frame("tip", 3, 0, pin.SE3(pin.utils.rotate("y", 0.4), np.array([0.1, 0.0, 0.3])), pin.FrameType.OP_FRAME)
    )
    return model


def test_a_helical_joint_turns_and_slides_as_pinocchio_has_it() -> None:
    chain = mik.Chain(screws(), "tip")
    assert chain.n == 3
    assert len(chain.paths.joints) == 4
    assert not chain.limits.multi_turn[1]  # after a whole turn it is somewhere else
    for x in chain.box.sample(np.random.default_rng(0), 50):
        (placement,) = chain.placements(chain.q(x))
        assert_allclose(chain.poses([x])[0, 0], placement.homogeneous, atol=1e-12)
        problem = mik.IKProblem.of(chain, placement)
        result = mik.solve_ik(chain, placement)
        assert result.success
        assert result.verify()
        slopes = [(problem.linearize(x + h)[0] - problem.linearize(x - h)[0]) / 2e-6 for h in 1e-6 * np.eye(3)]
        assert_allclose(problem.linearize(x)[1], slopes, atol=1e-6)
    (far,) = chain.placements(chain.q([0.0, 0.0, 0.0]))
    far.translation = far.translation + np.array([0.0, 3.0, 0.0])
    assert mik.solve_ik(chain, far).status is mik.IKStatus.UNREACHABLE


def test_a_helical_joint_without_limits_has_no_range_to_search() -> None:
    with pytest.raises(InvalidBounds, match="'joint_2'"):
        mik.solve_ik(mik.Chain(screws(lower=-np.inf, upper=np.inf), "tip"), [0.1, 0.2, 0.3])


def test_errors_name_what_would_have_worked() -> None:
    model = mik.load_robot("ur5").model
    with pytest.raises(FrameNotFound, match="did you mean 'tool0'"):
        mik.Chain(model, "tool00")
    with pytest.raises(FixedFrame, match="no joint moves frame 'world'"):
        mik.Chain(model, "world")
    with pytest.raises(UnknownName, match="did you mean 'elbow_joint'"):
        mik.Chain(model, "tool0", locked=["elbow"])
    with pytest.raises(InvalidBounds, match=r"'elbow_joint' has its lower limit 1.0 above its upper limit -1.0"):
        mik.Chain(model, "tool0", limits={"elbow_joint": (1.0, -1.0)})
    with pytest.raises(InvalidBounds, match="'elbow'"):
        mik.Chain(model, "tool0", limits={"elbow": (0.0, 1.0)})
    with pytest.raises(InvalidBounds, match="NaN"):
        mik.Chain(model, "tool0", limits={"elbow_joint": (np.nan, 1.0)})
    with pytest.raises(InvalidConfiguration, match=r"shape \(6,\), got \(5,\)"):
        mik.Chain(model, "tool0", reference=np.zeros(5))


def test_a_sliding_joint_without_limits_is_refused_when_a_search_needs_them() -> None:
    model = pin.Model()
    model.addJoint(0, pin.JointModelPX(), pin.SE3.Identity(), "rail")
    model.addFrame(pin.Frame("cart", 1, 0, pin.SE3.Identity(), pin.FrameType.OP_FRAME))
    chain = mik.Chain(model, "cart")
    with pytest.raises(InvalidBounds, match=r"'rail'.*limits=\{'rail': \(lower, upper\)\}"):
        mik.solve_ik(chain, [0.5, 0.0, 0.0])
    assert mik.solve_ik(mik.Chain(model, "cart", limits={"rail": (-1, 1)}), [0.5, 0.0, 0.0]).success


def test_an_unlimited_hinge_is_searched_over_one_turn() -> None:
    model = pin.Model()
    model.addJoint(0, pin.JointModelRZ(), pin.SE3.Identity(), "hinge")
    model.addFrame(pin.Frame("tip", 1, 0, pin.SE3(np.eye(3), np.array([1.0, 0, 0])), pin.FrameType.OP_FRAME))
    chain = mik.Chain(model, "tip")
    assert chain.limits.periodic.all()
    assert mik.solve_ik(chain, [0.0, -1.0, 0.0]).success


def test_the_model_is_never_written_to() -> None:
    model = mik.load_robot("panda").model
    before = model.copy()
    mik.solve_ik(mik.Chain(model, "panda_hand_tcp", locked=["panda_joint1"]), [0.4, 0.0, 0.5])
    assert model == before
