"""What a result says of why: for what a bound is, which joints cannot move, and what would help."""

import re

import numpy as np
import pinocchio as pin
import pytest

import pin_metaik as mik
from tests.robots_under_test import chain_of

ARM = "".join(f'<link name="l{i}"/>' for i in range(4)) + "".join(
    f'<joint name="j{i}" type="revolute"><parent link="l{i - 1}"/><child link="l{i}"/><origin xyz="0.3 0 0"/>'
    f'<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
    for i in (1, 2, 3)
)


def planar(**limits: tuple[float, float]) -> mik.Chain:
    tip = '<link name="tip"/><joint name="end" type="fixed"><parent link="l3"/><child link="tip"/>'
    model = pin.buildModelFromXML(f'<robot name="r">{ARM}{tip}<origin xyz="0.3 0 0"/></joint></robot>')
    return mik.Chain(model, "tip", limits=limits)


def test_joints_whose_limits_are_equal_are_named_before_any_search() -> None:
    chain = planar(j1=(0.0, 0.0), j2=(0.0, 0.0), j3=(0.0, 0.0))
    for target in ([1.0, 0.2, 0.0], pin.SE3.Identity()):
        result = mik.solve_ik(chain, target)
        assert result.status is mik.IKStatus.UNREACHABLE
        assert result.evaluations == 1
        assert "j1, j2, j3 cannot move: their limits are equal" in result.why
        assert not len(mik.solve_ik_all(chain, target))
    assert mik.solve_ik_batch(chain, np.array([[1.2, 0, 0], [1.0, 0.2, 0]])).success.tolist() == [True, False]
    assert mik.solve_ik(chain, [1.2, 0.0, 0.0]).success  # where it stands


def test_some_that_cannot_move_are_told_from_those_at_a_limit() -> None:
    result = mik.solve_ik(planar(j2=(0.5, 0.5)), [0.5, 0.1, 0.0])
    assert result.proof is mik.Proof.BOXES
    assert "j2 cannot move: its limits are equal" in result.why
    assert "j2" not in result.why.split("at a limit:")[-1].split(";")[0]


@pytest.mark.parametrize("weight", [1.0, 1e3])
def test_a_bound_on_the_wrist_says_that_it_is_for_this_orientation(weight: float) -> None:
    chain = chain_of("panda")
    pose = pin.SE3(np.diag([1.0, -1.0, -1.0]), np.array([0.5, 0.0, 1.1]))
    result = mik.solve_ik(chain, mik.Target(pose, position_weight=weight))
    assert result.status is mik.IKStatus.UNREACHABLE
    assert "with this orientation" in result.why
    assert "wrist" in result.why


@pytest.mark.parametrize("name", ["panda", "ur5", "tiago"])
def test_a_bound_on_the_frame_is_never_more_than_the_error(name: str) -> None:
    chain = chain_of(name)
    for target in ([3.0, 0.0, 0.0], pin.SE3(np.eye(3), np.array([3.0, 0.0, 0.5]))):
        result = mik.solve_ik(chain, target)
        assert result.status is mik.IKStatus.UNREACHABLE
        bound = re.search(r"out of reach: at least (\S+) m beyond", result.why)
        assert bound
        assert float(bound[1]) <= 1.005 * result.position_error  # three digits are shown


def test_of_two_hands_the_one_that_is_out_of_reach_is_named() -> None:
    chain = mik.Chain(mik.load_robot("talos").model, ["gripper_left_base_link", "gripper_right_base_link"])
    left, right = chain.placements(chain.reference)
    right.translation = right.translation - np.array([0.0, 3.0, 0.0])
    result = mik.solve_ik(chain, [left, right])
    assert result.why.startswith("gripper_right_base_link is out of reach")


@pytest.mark.parametrize("name", ["ur5", "puma560", "rv7fl"])
def test_what_a_closed_form_has_no_solution_for_is_proved_and_said_why(name: str) -> None:
    chain = chain_of(name)
    rng = np.random.default_rng(0)
    tips = [chain.placements(q)[0].translation for q in chain.q(chain.box.sample(rng, 60))]
    poses = [pin.SE3(pin.exp3(2.0 * rng.standard_normal(3)), tip) for tip in tips]
    results = [mik.solve_ik(chain, pose) for pose in poses]
    assert {result.status for result in results} == {mik.IKStatus.SOLVED, mik.IKStatus.UNREACHABLE}
    formed = [result for result in results if result.proof is mik.Proof.CLOSED_FORM]
    assert formed
    for result in formed:
        assert result.evaluations < 200
        assert re.search("beyond its limit|miss the wrist|too near to the axis|turns the last axis", result.why)
        found = mik.solve_ik_all(chain, result.target)
        assert (len(found), found.complete) == (0, mik.Proof.CLOSED_FORM)


@pytest.mark.parametrize("name", ["ur5", "ur10", "puma560"])
def test_what_rounding_hides_from_a_closed_form_is_found_all_the_same(name: str) -> None:
    chain = chain_of(name)
    rng = np.random.default_rng(1)
    X = chain.box.sample(rng, 300)
    X = np.where(rng.random(X.shape) < 0.5, np.where(rng.random(X.shape) < 0.5, chain.box.lower, chain.box.upper), X)
    X[::2, 4] = rng.choice([0.0, 1e-9, 1e-5], 150)
    for q in chain.q(X):
        assert mik.solve_ik(chain, chain.placements(q)[0]).success


ARM_AND_GRIPPER = """
<robot name="two"><link name="base"/>{arm}
<link name="a"><collision><origin xyz="1.5 0.009 0.05"/>{box}</collision></link>
<link name="b"><collision><origin xyz="1.5 -0.009 0.05"/>{box}</collision></link>
{joints}
<joint name="ga" type="prismatic"><parent link="base"/><child link="a"/><axis xyz="0 1 0"/>{slide}</joint>
<joint name="gb" type="prismatic"><parent link="base"/><child link="b"/><axis xyz="0 -1 0"/>{slide}{mimic}</joint>
</robot>
"""


@pytest.mark.parametrize("mimic", ["", '<mimic joint="ga"/>'])
def test_bodies_that_the_chain_does_not_move_are_said_at_once_and_what_helps(mimic: str) -> None:
    part = '<collision><origin xyz="0 0 0.09"/><geometry><cylinder radius="0.03" length="0.18"/></geometry></collision>'
    arm = "".join(f'<link name="l{i}">{part}</link>' for i in range(7))
    joints = "".join(
        f'<joint name="j{i}" type="revolute"><parent link="{f"l{i - 1}" if i else "base"}"/><child link="l{i}"/>'
        f'<origin xyz="0 0 0.2"/><axis xyz="{("0 0 1", "0 1 0")[i % 2]}"/>'
        f'<limit lower="-2.8" upper="2.8" effort="1" velocity="1"/></joint>'
        for i in range(7)
    )
    box = '<geometry><box size="0.02 0.02 0.1"/></geometry>'
    slide = '<limit lower="0" upper="0.04" effort="1" velocity="1"/>'
    urdf = ARM_AND_GRIPPER.format(arm=arm, joints=joints, box=box, slide=slide, mimic=mimic)
    model = pin.buildModelFromXML(urdf, True)
    robot = Described("two", model, pin.buildGeomFromUrdfString(model, urdf, pin.GeometryType.COLLISION))
    chain = mik.Chain(model, "l6")
    world = mik.CollisionWorld(robot)
    pose = chain.placements(chain.q([0.3, 0.5, 0.2, 0.8, 0.1, 0.4, 0.0]))[0]
    result = mik.solve_ik(chain, pose, world=world)
    assert result.status is mik.IKStatus.IN_COLLISION
    assert result.evaluations < 100
    assert "neither moves with the chain: move it in q0, or world.allow('a', 'b')" in result.why
    q0 = chain.reference.copy()
    q0[model.joints[model.getJointId("ga")].idx_q] = 0.03
    assert mik.solve_ik(chain, pose, q0, world=world).success


class Described:
    """The least that a world takes for a robot."""

    srdf = None

    def __init__(self, name: str, model: pin.Model, collision_model: pin.GeometryModel) -> None:
        self.name, self.model, self.collision_model = name, model, collision_model
