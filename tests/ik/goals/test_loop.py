"""Closed loops: a gripper of four bars from MJCF, and a platform on six legs from URDF."""

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

import pin_metaik as mik
from pin_metaik import goals
from pin_metaik.collision import CollisionWorld, Obstacle, Sphere
from pin_metaik.errors import FixedFrame, InvalidModel, InvalidTarget
from pin_metaik.stewart import closed_model, leg_lengths
from tests.stewart.cases import home_poses, reference

BAR = "<geom type='capsule' size='.004' fromto='0 0 .01 0 0 .05'/>"
HINGE = "<joint name='{}' type='hinge' axis='0 1 0' range='-{} {}'/>"
CLOSED = "<connect name='coupler' body1='finger' body2='rocker' anchor='.03 0 0'/>"


def gripper(closed: str = CLOSED) -> str:
    """An arm of two joints with a finger on a crank and a rocker of 6 cm, 3 cm apart: it moves without turning."""
    return f"""<mujoco model="gripper"><compiler angle="radian"/><worldbody><body name="arm">
    <joint name="lift" type="slide" axis="0 0 1" range="0 .5"/><geom type="box" size=".01 .01 .01" pos="0 0 -.05"/>
    <body name="palm"><joint name="turn" type="hinge" axis="0 0 1" range="-3 3"/>
    <body name="crank">{HINGE.format("crank", 1.2, 1.2)}{BAR}
      <body name="finger" pos="0 0 .06">{HINGE.format("knuckle", 2, 2)}
        <geom type="capsule" size=".004" fromto="0 0 .02 .03 0 .06"/></body></body>
    <body name="rocker" pos=".03 0 0">{HINGE.format("rocker", 1.2, 1.2)}{BAR}</body></body></body></worldbody>
    <equality>{closed}</equality></mujoco>"""


def gap(chain: mik.Chain, closure: object, q: np.ndarray) -> float:
    """How far (m) a loop is open, by Pinocchio's own constraint."""
    data, state = chain.model.createData(), closure.createData()
    pin.computeJointJacobians(chain.model, data, q)
    closure.calc(chain.model, data, state)
    return float(np.linalg.norm(state.constraint_position_error))


def test_a_gripper_of_four_bars_is_closed_by_whatever_solves_it() -> None:
    robot = mik.load_robot(gripper())
    (closure,) = robot.loops
    loop = goals.Loop(closure)
    assert loop.ends(robot.model) == ("finger", "rocker")
    chain = mik.Chain(robot, loop.ends(robot.model))

    def asked(angle: float, height: float) -> list[object]:
        """The finger at one height, the palm turned by an angle (rad)."""
        return [loop, goals.Posture({"turn": angle}), goals.OnPlane("finger", (0, 0, height), "z")]

    lists = [asked(0.02 * k, 0.2 + 0.002 * k) for k in range(6)]
    alone = mik.solve_ik(chain, lists[0])
    chosen = mik.solve_ik(chain, lists[0], solver=mik.IKSolver(select="limits"))
    several = mik.solve_ik_all(chain, lists[0], limit=4)
    batch = mik.solve_ik_batch(chain, lists)
    path = mik.solve_ik_path(chain, lists, alone.q)
    assert path.continuous
    ball = Obstacle("ball", Sphere(0.02), (0.06, 0.0, 0.26))
    world = CollisionWorld(robot, [ball])
    clear = mik.solve_ik(chain, lists[0], world=world)
    assert clear.success and not world.checker.collides(clear.q)
    answers = [alone.q, chosen.q, *several.q, *batch.q, *path.q, clear.q]
    assert len(answers) >= 1 + 1 + 2 + 6 + 6 + 1
    for q in answers:
        assert gap(chain, closure, q) <= 1.001e-5
        crank, knuckle, rocker = chain.x(q)[2:]
        assert crank == pytest.approx(rocker, abs=1e-3)  # a parallelogram: both turn alike, and the finger does not
        assert knuckle == pytest.approx(-crank, abs=1e-3)


def test_a_platform_on_six_legs_is_placed_as_by_its_own_inverse_kinematics() -> None:
    mechanism = reference()
    closed = closed_model(mechanism)
    box = {"x": (-0.3, 0.3), "y": (-0.3, 0.3), "z": (0.2, 0.6), "yaw": (-1, 1), "pitch": (-1, 1), "roll": (-1, 1)}
    limits = {f"platform_joint.{name}": span for name, span in box.items()}
    loops = [goals.Loop(closure) for closure in closed.closures]
    ends = dict.fromkeys(end for loop in loops for end in loop.ends(closed.model))
    chain = mik.Chain(closed.model, [*ends], limits=limits)
    assert chain.n == 24
    shortest, longest = mechanism.limits.span
    reached = 0
    for pose in home_poses(12):
        lengths = leg_lengths(mechanism.geometry, pose)
        if lengths.min() < shortest or lengths.max() > longest:
            continue
        result = mik.solve_ik(chain, [mik.Target(pose, "platform"), *loops])
        assert result.success, result.why
        assert max(gap(chain, closure, result.q) for closure in closed.closures) <= 1.001e-5
        found = [result.q[closed.leg(i)[2].idx_q] for i in range(6)]
        assert_allclose(found, lengths, atol=2.1e-5)  # m: the tolerance of the pose and that of a loop
        reached += 1
    assert reached >= 4


@pytest.mark.parametrize("kind", [pin.ContactType.CONTACT_3D, pin.ContactType.CONTACT_6D])
def test_rigid_constraints_and_anchors_say_the_same(kind: pin.ContactType) -> None:
    model = mik.load_robot("talos").model
    ends = "gripper_left_base_link", "gripper_right_base_link"
    chain = mik.Chain(model, ends)
    joints = [model.frames[frame].parentJoint for frame in chain.frame_ids]
    placements = pin.SE3(pin.exp3(np.array([0.3, 0.2, 0.1])), np.array([0.0, 0.1, 0.2])), pin.SE3.Identity()
    where = joints[0], placements[0], joints[1], placements[1]
    pointed = kind == pin.ContactType.CONTACT_3D
    anchor = (pin.PointAnchorConstraintModel if pointed else pin.FrameAnchorConstraintModel)(model, *where)
    loops = [
        goals.Loop(one) for one in (pin.RigidConstraintModel(kind, model, *where), anchor, pin.ConstraintModel(anchor))
    ]
    at = goals.Placed(chain, chain.q(chain.box.sample(np.random.default_rng(0), 1)[0]))
    assert_allclose(loops[0].residual(at), loops[1].residual(at), atol=0)
    assert_allclose(loops[0].residual(at), loops[2].residual(at), atol=0)
    result = mik.solve_ik(chain, [loops[0], mik.Target.at((0.4, 0.1, 0.2), frame=ends[0])])
    assert result.success, result.why
    assert gap(chain, anchor, result.q) <= 1.5e-5  # of 6 rows, m and rad


def test_loops_of_an_mjcf_have_names_and_those_that_are_not_active_are_left_out() -> None:
    weld = "<weld name='glued' body1='finger' body2='rocker'/>"
    off = "<connect active='false' body1='finger' anchor='0 0 0'/>"
    to_world = "<connect name='tied' body1='finger' anchor='0 0 0'/>"
    loops = mik.load_robot(gripper(weld + off + CLOSED + to_world)).loops
    assert [loop.name for loop in loops] == ["coupler", "tied", "glued"]
    assert [goals.Loop(loop).about for loop in loops] == ["coupler", "tied", "glued"]
    assert goals.Loop(loops[1]).ends(mik.load_robot(gripper()).model) == ("finger",)
    assert mik.load_robot("panda").loops == ()
    with pytest.raises(InvalidModel, match="not well-formed"):
        mik.load_robot(gripper().replace("<equality>", "<equality><a></b>"))


def test_a_loop_that_cannot_be_closed_says_by_how_much() -> None:
    robot = mik.load_robot(gripper())
    loop = goals.Loop(robot.loops[0])
    chain = mik.Chain(robot, loop.ends(robot.model))
    few = mik.IKSolver(budget=mik.Budget(evaluations=300))
    apart = goals.Posture({"crank": 0.5, "rocker": -0.5})
    result = mik.solve_ik(chain, [loop, apart], solver=few)
    assert result.status is mik.IKStatus.OUT_OF_TOLERANCE
    assert "Loop of coupler by 0.0" in result.why


def test_what_closes_no_loop_of_the_chain_is_refused_by_name() -> None:
    robot = mik.load_robot(gripper())
    (closure,) = robot.loops
    with pytest.raises(FixedFrame, match=r"make it for the frames 'finger', 'rocker', too"):
        mik.solve_ik(mik.Chain(robot, "palm"), goals.Loop(closure))
    with pytest.raises(InvalidTarget, match="of another model: it ends at joint 5, and 'two' has 3"):
        two = pin.Model()
        two.name = "two"
        for name in "ab":
            two.addJoint(0, pin.JointModelRX(), pin.SE3.Identity(), name)
        goals.Loop(closure).ends(two)
    with pytest.raises(InvalidTarget, match="closed by a RigidConstraintModel, a Point"):
        goals.Loop(pin.ConstraintModel(pin.JointFrictionConstraintModel(robot.model, [1])))
    with pytest.raises(InvalidTarget, match="closure: expected"):
        goals.Loop("coupler")  # type: ignore[arg-type]
    moved = pin.RigidConstraintModel(
        pin.ContactType.CONTACT_6D, robot.model, 1, pin.SE3.Identity(), 2, pin.SE3.Identity()
    )
    moved.desired_contact_placement = pin.SE3.Random()
    with pytest.raises(InvalidTarget, match="ignores desired_contact_placement"):
        goals.Loop(moved)
    with pytest.raises(InvalidTarget, match="position_tolerance is a number above 0"):
        goals.Loop(closure, position_tolerance=-1.0)
