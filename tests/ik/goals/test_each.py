"""Every goal of the registry: its derivative, its test, its solutions, and what it refuses."""

import math
import sys
from collections.abc import Callable
from functools import cache
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

import pin_metaik as mik
from pin_metaik import goals
from pin_metaik.errors import FixedFrame, FrameNotFound, InvalidConfiguration, InvalidTarget, UnknownName
from pin_metaik.ik.goals.goal import differences
from tests.ik.test_derivatives import chain
from tests.robots_under_test import chain_of

BENCHMARKS = Path(__file__).parents[3] / "benchmarks"
FAR = (3.0, 2.0, 4.0)  # m: out of reach, so that no residual is zero
POSE = pin.SE3(pin.rpy.rpyToMatrix(0.3, -0.5, 1.1), np.array(FAR))
CHAINS = ["panda", "ur5", "tiago", "kinova", "two frames", "mimics and slides"]

EXAMPLES: dict[str, Callable[[str, str, mik.Chain], list[Any]]] = {
    "centre_of_mass": lambda tip, other, chain: [
        goals.CentreOfMass([(3, 3), (4, 3), (3, 5)], margin=0.1, most=-2.0),
        goals.CentreOfMass(least=5.0, tolerance=0.1),
    ],
    "custom": lambda tip, other, chain: [
        goals.Custom(lambda q: np.sum(q**2) + 1.0),
        goals.Custom(chain.x, derivative=lambda q: np.eye(chain.n), least=7.0, most=9.0, tolerance=0.1),
    ],
    "distance": lambda tip, other, chain: [
        goals.Distance(tip, FAR, most=0.1),
        goals.Distance(tip, (0, 0, 0), reference=other, least=9.0, tolerance=0.2, weight=3.0),
    ],
    "frame_pose": lambda tip, other, chain: [
        goals.FramePose(tip, POSE, reference=other),
        goals.FramePose(other, POSE, position_tolerance=0.1, orientation_tolerance=(0.1, math.inf, 0.2)),
        goals.FramePose.at(tip, FAR, reference=other, tolerance=(0.1, math.inf, 0.2)),
    ],
    "in_box": lambda tip, other, chain: [
        goals.InBox(tip, (2, 2, 2), (3, 3, math.inf), pose=POSE),
        goals.InBox(tip, (2, -math.inf, 2), (3, 3, 3), reference=other, tolerance=0.1),
    ],
    "look_at": lambda tip, other, chain: [
        goals.LookAt(tip, FAR),
        goals.LookAt(tip, FAR, (1, 2, 1), reference=other, tolerance=0.02),
    ],
    "loop": lambda tip, other, chain: [goals.Loop(one) for one in closures(tip, other, chain)],
    "manipulability": lambda tip, other, chain: [
        goals.Manipulability(tip, 50.0),
        goals.Manipulability(tip, 50.0, "position", reference=other),
    ],
    "mid_range": lambda tip, other, chain: [goals.MidRange(0), goals.MidRange(0.1, tolerance=0.01)],
    "on_line": lambda tip, other, chain: [
        goals.OnLine(tip, FAR, (1, 2, 3), reference=other),
        goals.OnLine(tip, FAR, "-x", least=3.0, most=4.0, tolerance=0.01),
    ],
    "on_plane": lambda tip, other, chain: [
        goals.OnPlane(tip, FAR, "x", reference=other),
        goals.OnPlane(tip, FAR, (1, 1, 0), least=3.0, most=math.inf, tolerance=0.01),
    ],
    "pointing": lambda tip, other, chain: [
        goals.Pointing(tip, "z", (0.3, 0.2, -0.9)),
        goals.Pointing(tip, (1, 1, 0), (0.4, 0.5, -0.6), reference=other, tolerance=0.05),
    ],
    "pose": lambda tip, other, chain: [
        mik.Target(POSE, tip),
        mik.Target(POSE, tip, 0.2, (0.1, math.inf, 0.2), position_weight=2.0, orientation_weight=0.5),
        mik.Target(POSE, tip, (0.1, math.inf, 0.3), 0.2),
    ],
    "posture": lambda tip, other, chain: [
        goals.Posture(chain.q(chain.limits.clip(np.full(chain.n, 0.9)))),
        goals.Posture({chain.names[0]: (-0.2, -0.1)}, tolerance=0.01),
    ],
}


def closures(tip: str, other: str, chain: mik.Chain) -> list[Any]:
    """Constraints of every kind between two frames, far from being met."""
    model = chain.model
    first, second = (int(model.frames[model.getFrameId(name)].parentJoint) for name in (tip, other))
    ends = model, first, POSE, second, pin.SE3(pin.exp3(np.array([0.4, -0.3, 0.2])), np.ones(3))
    offset = pin.PointAnchorConstraintModel(*ends)
    offset.desired_constraint_offset = np.array([0.1, 0.2, 0.3])
    return [
        pin.RigidConstraintModel(pin.ContactType.CONTACT_3D, *ends),
        pin.RigidConstraintModel(pin.ContactType.CONTACT_6D, *ends),
        offset,
        pin.ConstraintModel(pin.FrameAnchorConstraintModel(*ends)),
        pin.PointAnchorConstraintModel(model, first, POSE),  # to the world
    ]


def frames(chain: mik.Chain) -> tuple[str, str]:
    """The tip of a chain, and a frame that it moves otherwise."""
    if len(chain.frames) > 1:
        return chain.frames[0], chain.frames[1]
    model, first = chain.model, min(chain.movers)
    on = [one.name for one in model.frames if one.parentJoint == first and one.type == pin.FrameType.BODY]
    return chain.frames[0], on[0]


def test_every_goal_of_the_registry_has_examples() -> None:
    assert set(EXAMPLES) == set(goals.GOALS)


@pytest.mark.parametrize("name", CHAINS)
@pytest.mark.parametrize("kind", EXAMPLES)
def test_the_jacobian_of_a_goal_is_the_derivative_of_its_residual(kind: str, name: str) -> None:
    arm, rng = chain(name), np.random.default_rng(1)
    if (kind, name) == ("centre_of_mass", "mimics and slides"):
        with pytest.raises(InvalidTarget, match="have no mass"):
            mik.solve_ik(arm, goals.CentreOfMass(least=0.0))
        return
    for goal in EXAMPLES[kind](*frames(arm), arm):
        assert isinstance(goal, goals.GOALS[kind])
        for x in arm.box.sample(rng, 3):
            at = goals.Placed(arm, arm.q(x))
            r = goal.residual(at)
            J = goal.jacobian(at)
            assert r.any()
            assert not goal.met(at)
            assert all(size > 0.0 for size in goal.off(at).values())
            assert_allclose(J, differences(goal, at, len(r)), atol=3e-6 * max(1.0, np.abs(J).max()))


@pytest.mark.parametrize("name", [*CHAINS, "panda finger"])
def test_the_velocity_of_a_frame_is_the_derivative_of_its_pose(name: str) -> None:
    arm = mik.Chain(mik.load_robot("panda"), "panda_rightfinger") if name == "panda finger" else chain(name)
    tip, other = frames(arm)
    q, h = arm.q(arm.box.sample(np.random.default_rng(4), 1)[0]), 1e-6
    at = goals.Placed(arm, q)
    for frame, reference in ((tip, None), (other, None), (tip, other), (other, tip)):
        here, J = at.pose(frame, reference), at.jacobian(frame, reference)
        for c, (ahead, back) in enumerate(at.around):
            there, before = ahead.pose(frame, reference), back.pose(frame, reference)
            linear = (there.translation - before.translation) / (2.0 * h)
            angular = pin.log3(there.rotation @ before.rotation.T) / (2.0 * h)
            assert_allclose(J[:, c], np.concatenate([linear, angular]), atol=1e-8)
        assert here.isApprox(at.pose(frame, reference))
    middle = [(a.centre_of_mass - b.centre_of_mass) / (2.0 * h) for a, b in at.around]
    assert_allclose(at.centre_of_mass_jacobian, np.transpose(middle), atol=1e-8)


@cache
def cases() -> ModuleType:
    """``benchmarks/goal_cases.py``: goals that are met by construction, and tests without them."""
    sys.path.insert(0, str(BENCHMARKS))
    try:
        return import_module("goal_cases")
    finally:
        sys.path.remove(str(BENCHMARKS))


@pytest.mark.parametrize("kind", [*cases().ALONE, *cases().TOGETHER])
def test_goals_that_a_configuration_meets_are_solved_and_verified_without_them(kind: str) -> None:
    made = cases()
    robot = made.Robot(chain_of("panda"), "panda_hand_tcp", "panda_link4")
    rng, arm = np.random.default_rng(0), robot.chain
    for _ in range(3):
        there = made.Truth(arm.model, arm.q(arm.box.sample(rng, 1)[0]))
        asked = [make(robot, there, rng) for make in {**made.ALONE, **made.TOGETHER}[kind]]
        at = goals.Placed(arm, there.q)
        assert all(one.holds(there) and one.goal.met(at) for one in asked)
        result = mik.solve_ik(arm, [one.goal for one in asked])
        assert result.success, result.why
        assert result.verify()
        assert all(one.holds(made.Truth(arm.model, result.q)) for one in asked)
        assert [one.met for one in result.goals] == [True] * len(asked)


def test_joints_off_the_chain_are_where_q0_has_them_for_goals_too() -> None:
    arm, rng = chain_of("talos"), np.random.default_rng(5)
    model = arm.model
    for _ in range(3):
        there = rng.uniform(np.maximum(model.lowerPositionLimit, -1.0), np.minimum(model.upperPositionLimit, 1.0))
        q = arm.q(arm.box.sample(rng, 1)[0], there)
        at = goals.Placed(arm, q)
        height = float(at.centre_of_mass[2])
        other = at.pose("gripper_left_base_link", "gripper_right_base_link").translation
        asked = [
            goals.CentreOfMass(least=height, most=height),
            goals.FramePose.at("gripper_left_base_link", other, reference="gripper_right_base_link"),
            goals.Wish(goals.Posture(q)),
        ]
        start = arm.q(arm.x(arm.reference), there)
        result = mik.solve_ik(arm, asked, start)
        assert result.success, result.why
        assert result.verify()
        assert goals.Placed(arm, result.q).centre_of_mass[2] == pytest.approx(height, abs=1.1e-5)
        assert len(mik.solve_ik_all(arm, asked, start, limit=2)) > 0
        assert mik.solve_ik_path(arm, [asked, asked], start).success.all()


def test_two_hands_of_a_humanoid_hold_one_tray() -> None:
    arm, rng = chain("two frames"), np.random.default_rng(2)
    left, right = arm.frames
    for x in arm.box.sample(rng, 5):
        at = goals.Placed(arm, arm.q(x))
        grasp, tray = at.pose(right, left), at.pose(left)
        asked = [
            goals.FramePose(right, grasp, reference=left),
            mik.Target.at(tray.translation, frame=left),
            goals.Pointing(left, "z", tray.rotation[:, 2], tolerance=0.01),
        ]
        result = mik.solve_ik(arm, asked)
        assert result.success, result.why
        hands = arm.placements(result.q)
        assert np.linalg.norm(pin.log6(grasp.actInv(hands[0].actInv(hands[1]))).vector) < 2e-5


class Growing:
    """A goal whose residual has other rows elsewhere."""

    def residual(self, at: goals.Placed) -> np.ndarray:
        return np.ones(1 if abs(at.q).max() == 0.0 else 2)

    def met(self, at: goals.Placed) -> bool:
        return False


REFUSED: dict[str, tuple[type[Exception], str, Callable[[], Any]]] = {
    "an empty box": (InvalidTarget, "it is empty", lambda: goals.InBox("tool0", (1, 1, 1), (0, 2, 2))),
    "a box everywhere": (InvalidTarget, "has no bound", lambda: goals.InBox("tool0", [-math.inf] * 3, [math.inf] * 3)),
    "distances crossed": (InvalidTarget, "2 to 1", lambda: goals.Distance("tool0", FAR, least=2, most=1)),
    "any distance": (InvalidTarget, "is always met", lambda: goals.Distance("tool0", FAR)),
    "a negative distance": (InvalidTarget, "at least 0", lambda: goals.Distance("tool0", FAR, least=-1, most=1)),
    "a zero direction": (InvalidTarget, "with a direction", lambda: goals.Pointing("tool0", "z", (0, 0, 0))),
    "an unknown axis": (InvalidTarget, "x, y, z, -x", lambda: goals.LookAt("tool0", FAR, "w")),
    "half a turn": (InvalidTarget, "below pi", lambda: goals.Pointing("tool0", "z", "z", tolerance=4.0)),
    "a part of a line crossed": (InvalidTarget, "1 to 0", lambda: goals.OnLine("tool0", FAR, "z", least=1, most=0)),
    "no plane": (InvalidTarget, "point: expected", lambda: goals.OnPlane("tool0", (1, 2), "z")),
    "a polygon in a line": (InvalidTarget, "not in a line", lambda: goals.CentreOfMass([(0, 0), (1, 1), (2, 2)])),
    "a margin too wide": (
        InvalidTarget,
        "at most 0.5 m",
        lambda: goals.CentreOfMass([(0, 0), (1, 0), (1, 1), (0, 1)], margin=0.6),
    ),
    "nothing of a mass": (InvalidTarget, "is always met", lambda: goals.CentreOfMass()),
    "no posture": (InvalidTarget, "at least one joint", lambda: goals.Posture({})),
    "a joint's range crossed": (InvalidTarget, "2 to 1", lambda: goals.Posture({"elbow_joint": (2, 1)})),
    "a share above one": (InvalidTarget, "from 0 to 1", lambda: goals.MidRange(1.5)),
    "no measure": (InvalidTarget, "above 0", lambda: goals.Manipulability("tool0", 0.0)),
    "odd rows": (InvalidTarget, "pose, position", lambda: goals.Manipulability("tool0", 1.0, "all")),  # type: ignore[arg-type]
    "no function": (InvalidTarget, "function: expected", lambda: goals.Custom(3)),  # type: ignore[arg-type]
    "no tolerance": (InvalidTarget, "tolerance is a finite number", lambda: goals.MidRange(0, tolerance=0.0)),
    "no weight": (InvalidTarget, "weight is a finite number", lambda: goals.Wish(goals.MidRange(0), weight=-1.0)),
    "no goal": (InvalidTarget, "goal: expected", lambda: goals.Wish(3)),  # type: ignore[arg-type]
    "an unknown frame": (FrameNotFound, "hat", lambda: asked(goals.OnPlane("hat", FAR, "z"))),
    "a frame that stands still": (FixedFrame, "moves frame 'base_link'", lambda: asked(goals.LookAt("base_link", FAR))),
    "a frame as itself sees it": (
        FixedFrame,
        "relative to 'tool0'",
        lambda: asked(goals.Distance("tool0", FAR, reference="tool0", most=1.0)),
    ),
    "a joint off the chain": (UnknownName, "knee", lambda: asked(goals.Posture({"knee": 0.0}))),
    "a joint beyond its limits": (
        InvalidTarget,
        "outside its limits",
        lambda: asked(goals.Posture({"elbow_joint": 9.0})),
    ),
    "another robot's posture": (InvalidConfiguration, "x|q", lambda: asked(goals.Posture([0.0, 0.0]))),
    "a function of NaN": (InvalidTarget, "finite", lambda: asked(goals.Custom(lambda q: math.nan))),
    "a function of words": (InvalidTarget, "expected numbers", lambda: asked(goals.Custom(lambda q: "far"))),
    "a matrix": (InvalidTarget, "expected shape", lambda: asked(goals.Custom(lambda q: np.eye(2)))),
    "two poses of one frame": (
        InvalidTarget,
        r"Target of tool0 and FramePose of tool0 contradict each other: they are .* m apart",
        lambda: asked([mik.Target(POSE, "tool0"), goals.FramePose("tool0", pin.SE3.Identity())]),
    ),
    "two orientations of one frame": (
        InvalidTarget,
        r"contradict each other: they are 1.* rad apart, and their tolerances add up to 0.1 rad",
        lambda: asked([mik.Target.facing(np.eye(3), tolerance=0.1), goals.FramePose("tool0", POSE)]),
    ),
    "two ranges of one joint": (
        InvalidTarget,
        "no value of joint 'elbow_joint' is in both ranges",
        lambda: asked([goals.Posture({"elbow_joint": 0.5}), goals.Posture({"elbow_joint": (1, 2)})]),
    ),
    "a function that is of NaN elsewhere": (
        InvalidTarget,
        "what <lambda> gives for a configuration",
        lambda: asked(goals.Custom(lambda q: q[0] - 5.0 if q[0] < 0.1 else math.nan)),
    ),
    "a residual of another size elsewhere": (InvalidTarget, r"must be \(1,\) finite numbers", lambda: asked(Growing())),
    "a derivative of another shape": (
        InvalidTarget,
        "as a derivative: expected shape",
        lambda: asked(goals.Custom(np.sum, derivative=lambda q: q)),
    ),
}


def asked(goal: Any) -> mik.IKResult:
    return mik.solve_ik(chain_of("ur5"), goal)


@pytest.mark.parametrize("mistake", REFUSED)
def test_a_goal_that_makes_no_sense_is_refused_by_name(mistake: str) -> None:
    error, says, make = REFUSED[mistake]
    with pytest.raises(error, match=says):
        make()


def test_goals_that_contradict_each_other_end_with_what_each_is_off_by() -> None:
    arm = chain_of("ur5")
    pose = arm.placements(arm.reference)[0]
    away = goals.OnPlane("tool0", pose.translation + np.array([0.0, 0.0, 0.2]), "z", most=math.inf)
    few = mik.IKSolver(budget=mik.Budget(evaluations=500))
    result = mik.solve_ik(arm, [pose, away], solver=few)
    assert result.status is mik.IKStatus.OUT_OF_TOLERANCE
    assert "Target of tool0 by" in result.why
    assert "OnPlane of tool0 by 0.1" in result.why
    said = result.as_dict()
    assert [one["goal"] for one in said["goals"]] == ["Target of tool0", "OnPlane of tool0"]
    assert not any(one["met"] for one in said["goals"])
    assert said["goals"][1]["off"]["m"] == pytest.approx(0.1, abs=0.05)


def test_a_joint_that_a_posture_wants_a_turn_away_from_the_start_stays_there() -> None:
    arm = chain_of("ur5")
    x = arm.box.sample(np.random.default_rng(1), 1)[0]
    x[5] = 5.0  # rad; nearer to the start, at 0, is 5 - 2 pi
    asked = [arm.placements(arm.q(x))[0], goals.Posture({arm.names[5]: 5.0})]
    found = mik.solve_ik_all(arm, asked)
    assert len(found) >= 1
    assert np.abs(found.q[:, 5] - 5.0).max() <= 1.1e-5
    assert mik.solve_ik(arm, asked, solver=mik.IKSolver(select="limits")).success


def test_poses_in_the_order_of_two_frames_do_not_contradict_each_other() -> None:
    arm = chain("two frames")
    q = arm.q(arm.box.sample(np.random.default_rng(3), 1)[0])
    height = float(goals.Placed(arm, q).centre_of_mass[2])
    result = mik.solve_ik(arm, [*arm.placements(q), goals.CentreOfMass(least=height, most=height)])
    assert result.success, result.why


def test_one_pose_in_a_list_is_solved_as_the_pose_is() -> None:
    arm = chain_of("ur5")
    for x in arm.box.sample(np.random.default_rng(2), 3):
        pose = arm.placements(arm.q(x))[0]
        alone = mik.solve_ik(arm, pose)
        for one in (pose, mik.Target(pose)):
            listed = mik.solve_ik(arm, [one])
            assert (listed.q == alone.q).all()
            assert listed.evaluations == alone.evaluations
