"""Joints of every kind are turns and slides: placed as Pinocchio places them, solved for, and proved unreachable."""

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

import pin_metaik as mik
from pin_metaik.collision import load_scene
from pin_metaik.errors import InvalidBounds, InvalidConfiguration, UnsupportedJoint
from pin_metaik.kinematics.joints import angles, quaternion

OFFSET = pin.SE3(pin.utils.rotate("x", 0.3), np.array([0.1, 0.2, 0.3]))
TIAGO_HAND = mik.load_robot("tiago").frame
BASE = {"root_joint.x": (-1.0, 1.0), "root_joint.y": (-0.5, 2.0), "root_joint.z": (0.2, 1.5)}


def composite() -> pin.JointModelComposite:
    joint = pin.JointModelComposite(pin.JointModelRX(), pin.SE3.Identity())
    joint.addJoint(pin.JointModelPrismaticUnaligned(np.array([0.0, 0.6, 0.8])), OFFSET)
    joint.addJoint(pin.JointModelRUBZ(), OFFSET)
    return joint


KINDS = {
    "planar": (pin.JointModelPlanar(), ("x", "y", "yaw")),
    "translation": (pin.JointModelTranslation(), ("x", "y", "z")),
    "ball": (pin.JointModelSpherical(), ("yaw", "pitch", "roll")),
    "ball by angles": (pin.JointModelSphericalZYX(), ("yaw", "pitch", "roll")),
    "floating": (pin.JointModelFreeFlyer(), ("x", "y", "z", "yaw", "pitch", "roll")),
    "universal": (pin.JointModelUniversal(np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])), ("1", "2")),
    "composite": (composite(), ("1", "2", "3")),
    "helical": (pin.JointModelHelicalUnaligned(np.array([0.0, 0.6, -0.8]), 0.1), ("",)),
    "turn": (pin.JointModelRevoluteUnaligned(np.array([0.6, 0.0, 0.8])), ("",)),
    "continuous": (pin.JointModelRUBX(), ("",)),
}


def model_with(kind: str) -> pin.Model:
    """A joint of a kind between two others, all within limits of its numbers."""
    model = pin.Model()
    for i, joint in enumerate((pin.JointModelRZ(), KINDS[kind][0], pin.JointModelRY(), pin.JointModelPX())):
        model.addJoint(i, joint, OFFSET, f"joint_{i}")
    model.lowerPositionLimit, model.upperPositionLimit = np.full(model.nq, -1.2), np.full(model.nq, 0.9)
    model.addFrame(pin.Frame("tip", 4, 0, OFFSET, pin.FrameType.OP_FRAME))
    return model


@pytest.mark.parametrize("kind", KINDS)
def test_a_joint_of_any_kind_is_placed_solved_and_proved(kind: str) -> None:
    model, rng = model_with(kind), np.random.default_rng(0)
    chain = mik.Chain(model, "tip")
    assert chain.names == (
        "joint_0",
        *(f"joint_1.{n}" if n else "joint_1" for n in KINDS[kind][1]),
        "joint_2",
        "joint_3",
    )
    for x in chain.box.sample(rng, 25):
        q = chain.q(x)
        assert pin.isNormalized(model, q, 1e-12)
        assert_allclose(chain.x(q), x, atol=1e-12)
        (placement,) = chain.placements(q)
        assert_allclose(chain.poses([x])[0, 0], placement.homogeneous, atol=1e-12)
        result = mik.solve_ik(chain, placement)
        assert result.success
        assert result.verify()
        h = 1e-6 * rng.normal(size=chain.n)
        moved = pin.integrate(model, q, chain.tangent(x) @ h)
        assert_allclose(pin.difference(model, moved, chain.q(x + h)), 0.0, atol=1e-10)
    far = pin.SE3(placement.rotation, placement.translation + np.array([30.0, 0.0, 0.0]))
    assert mik.solve_ik(chain, far).status is mik.IKStatus.UNREACHABLE


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_reachable_at_the_limits_is_never_proved_unreachable(kind: str) -> None:
    chain, rng = mik.Chain(model_with(kind), "tip"), np.random.default_rng(1)
    X = chain.box.sample(rng, 60)
    at_limit = rng.random(X.shape) < 0.4
    X = np.where(at_limit, np.where(rng.random(X.shape) < 0.5, chain.box.lower, chain.box.upper), X)
    for q in chain.q(X):
        (pose,) = chain.placements(q)
        for target in (pose, mik.Target.at(pose.translation), mik.Target.facing(pose.rotation)):
            assert mik.solve_ik(chain, target).success


def test_yaw_pitch_and_roll_are_those_of_pinocchio_also_where_they_lose_one() -> None:
    rng = np.random.default_rng(0)
    given = rng.uniform([-np.pi, -np.pi / 2, -np.pi], [np.pi, np.pi / 2, np.pi], (2000, 3))
    given[:400, 1] = np.repeat([np.pi / 2, -np.pi / 2, np.pi / 2 - 1e-8, 1e-8 - np.pi / 2], 100)
    for ypr, quat, sign in zip(given, quaternion(given), rng.choice([-1.0, 1.0], 2000), strict=True):
        rotation = pin.Quaternion(quat).matrix()
        assert_allclose(rotation, pin.rpy.rpyToMatrix(ypr[2], ypr[1], ypr[0]), atol=1e-14)
        back = angles(sign * quat)
        assert abs(back[1]) <= np.pi / 2
        assert_allclose(pin.Quaternion(quaternion(back)).matrix(), rotation, atol=3e-9)
    assert_allclose(angles(quaternion(given[400:])), given[400:], atol=1e-9)


def test_a_floating_base_wants_bounds_and_says_how_they_are_given() -> None:
    robot = mik.load_robot("solo12", free_flyer=True)
    feet = ["FL_FOOT", "FR_FOOT", "HL_FOOT", "HR_FOOT"]
    with pytest.raises(InvalidBounds, match=r"'root_joint.x'.*limits=\{'root_joint.x': \(lower, upper\)\}"):
        mik.solve_ik(mik.Chain(robot.model, feet), [mik.Target.at([0.1, 0.1, 0.0])] * 4)


def test_a_quadruped_stands_on_four_feet_with_its_body_where_it_shall_be() -> None:
    robot = mik.load_robot("solo12", free_flyer=True)
    frames = ["FL_FOOT", "FR_FOOT", "HL_FOOT", "HR_FOOT", "base_link"]
    tilt = {"root_joint.pitch": (-0.3, 0.3), "root_joint.roll": (-0.3, 0.3)}
    chain = mik.Chain(robot.model, frames, limits=BASE | tilt | {"root_joint.z": (0.1, 0.4)})
    assert chain.n == 18
    solved, rng = 0, np.random.default_rng(0)
    X = chain.box.sample(rng, 40)
    for x in X:
        feet = [p.translation for p in chain.placements(chain.q(x))]
        targets = [mik.Target.at(foot, frame=frame) for foot, frame in zip(feet, frames, strict=True)]
        result = mik.solve_ik(chain, targets)
        solved += result.success
        assert np.abs(chain.x(result.q)[4:6]).max() <= 0.3 + 1e-12
        assert pin.isNormalized(robot.model, result.q, 1e-9)
    assert solved == len(X)


def test_a_mobile_manipulator_drives_and_reaches_with_the_quick_solver() -> None:
    model = mik.load_robot("tiago", planar=True).model
    chain = mik.Chain(model, TIAGO_HAND, limits={"root_joint.x": (-3.0, 3.0), "root_joint.y": (-3.0, 3.0)})
    assert chain.has_pose_solver
    assert chain.names[:3] == ("root_joint.x", "root_joint.y", "root_joint.yaw")
    for q in chain.q(chain.box.sample(np.random.default_rng(0), 50)):
        (pose,) = chain.placements(q)
        result = mik.solve_ik(chain, pose)
        assert result.success
        assert pin.isNormalized(model, result.q, 1e-9)


def test_a_base_drives_round_what_is_in_the_way() -> None:
    robot = mik.load_robot("ur5", planar=True)
    chain = mik.Chain(robot, "tool0", limits={"root_joint.x": (-2.0, 2.0), "root_joint.y": (-2.0, 2.0)})
    world = mik.CollisionWorld(robot, load_scene("table"))
    cleared, rng = 0, np.random.default_rng(4)
    for q in chain.q(chain.box.sample(rng, 300)):
        if world.in_collision(q):
            continue
        (pose,) = chain.placements(q)
        result = mik.solve_ik(chain, pose, world=world)
        assert not result.success or not world.in_collision(result.q)
        cleared += result.success
        if cleared == 4:
            break
    assert cleared == 4


def test_a_configuration_whose_quaternion_is_none_is_named() -> None:
    robot = mik.load_robot("ur5", free_flyer=True)
    chain = mik.Chain(robot.model, "tool0", limits=BASE)
    q0 = pin.neutral(robot.model)
    q0[6] = 0.5
    with pytest.raises(InvalidConfiguration, match=r"root_joint.*length 1"):
        mik.solve_ik(chain, [0.4, 0.1, 0.5], q0)


def test_a_joint_that_is_not_made_of_fixed_axes_is_refused_by_name() -> None:
    model = pin.Model()
    ellipsoid = getattr(pin, "JointModelEllipsoid", None)
    if ellipsoid is None:
        pytest.skip("this Pinocchio has no ellipsoid joint")
    model.addJoint(0, ellipsoid(0.1, 0.2, 0.3), pin.SE3.Identity(), "shell")
    model.addFrame(pin.Frame("tip", 1, 0, pin.SE3.Identity(), pin.FrameType.OP_FRAME))
    with pytest.raises(UnsupportedJoint, match="'shell'"):
        mik.Chain(model, "tip")
