"""Boxes decide chains without a closed form, and cover all solutions of any."""

import numpy as np
import pinocchio as pin
import pytest

import pin_metaik as mik
from pin_metaik.kinematics.proofs import boxes as boxes_of
from pin_metaik.kinematics.proofs.arm import WHOLE, Path, ProofArm, proof_arm


def chain_of(robot: str) -> mik.Chain:
    loaded = mik.load_robot(robot)
    return mik.Chain(loaded.model, loaded.frame)


def arm_of(chain: mik.Chain) -> ProofArm:
    arm = proof_arm(chain.paths, chain.limits, 0, WHOLE)
    assert arm is not None
    return arm


def path_of(chain: mik.Chain) -> Path:
    return Path(chain.paths.joints, chain.paths.wiring, chain.paths.tips[0])


@pytest.mark.parametrize("robot", ["talos_arm", "panda"])
def test_what_is_not_solved_is_proved_and_nothing_is_both(robot: str) -> None:
    chain = chain_of(robot)
    rng = np.random.default_rng(7)
    poses = chain.poses(chain.box.sample(rng, 60))[:, 0]
    for pose in poses:
        pose[:3, :3] = pin.Quaternion(*rng.normal(size=4)).normalized().matrix()
    solved = mik.solve_ik_batch(chain, poses, solver=mik.IKSolver(budget=mik.Budget(evaluations=600))).success
    for pose, found in zip(poses, solved, strict=True):
        boxes = chain._boxes(0, pose, 1e-5, 1e-5, least=1e-3)
        boxes.look(20_000)
        assert boxes.excluded != found


def test_a_position_that_limits_forbid_is_proved_out_of_reach() -> None:
    """A planar arm of three joints that cannot fold: the links span the distance, the limits do not let them."""
    model = pin.Model()
    joint = 0
    for i in range(3):
        way = pin.SE3(np.eye(3), np.array([0.0 if i == 0 else 0.4, 0.0, 0.0]))
        ten, most = np.array([10.0]), np.array([0.3 if i else 3.0])
        joint = model.addJoint(joint, pin.JointModelRZ(), way, f"joint_{i}", ten, ten, -most, most)
    model.addFrame(pin.Frame("tip", joint, 0, pin.SE3(np.eye(3), np.array([0.4, 0.0, 0.0])), pin.FrameType.OP_FRAME))
    chain = mik.Chain(model, "tip")

    def proved(distance: float) -> bool:
        pose = np.eye(4)
        pose[0, 3] = distance
        boxes = chain._boxes(0, pose, 1e-5, 0.0, (True, True, True), least=1e-3)
        boxes.look(5_000)
        return boxes.excluded

    nearest = np.linalg.norm(chain.poses(np.array([0.0, 0.3, 0.3]))[0, 0, :3, 3])
    assert proved(0.9 * nearest) and proved(1.01 * 1.2)
    assert not proved(nearest) and not proved(1.18) and not proved(1.2)


@pytest.mark.parametrize("robot", ["talos_arm", "aerial_arm"])
def test_every_solution_lies_in_a_leaf_of_the_cover(robot: str) -> None:
    chain = chain_of(robot)
    arm, rng = arm_of(chain), np.random.default_rng(1)
    n = chain.n
    split = n - 3 if arm.arrays[7][0] else n  # the wrist's joints are not split
    for x in chain.box.sample(rng, 3):
        pose = chain.poses(x)[0, 0]
        boxes = chain._boxes(0, pose, 1e-6, 1e-6, least=0.03)
        leaves = boxes.look(200_000, 4_000)
        assert boxes.done and not boxes.excluded
        for solution in chain.x(mik.solve_ik_all(chain, pose).q):
            off = np.abs(leaves[:, :split] - solution[:split])
            assert (off <= leaves[:, n : n + split] + 1e-6).all(axis=1).any()


def test_a_path_and_its_reverse_are_inverse_to_each_other() -> None:
    chain = chain_of("panda")
    path, x = path_of(chain), chain.box.sample(np.random.default_rng(0), 1)[0]
    np.testing.assert_allclose(path.frames(x)[-1], chain.poses(x)[0, 0], atol=1e-12)
    np.testing.assert_allclose(path.reversed().frames(x)[-1] @ path.frames(x)[-1], np.eye(4), atol=1e-12)


def test_free_joints_at_the_tip_turn_it_where_it_stands() -> None:
    chain = chain_of("ur5")
    path, rng = path_of(chain), np.random.default_rng(0)
    x, turns = chain.box.sample(rng, 1)[0], rng.uniform(-np.pi, np.pi, 3)
    tip, turned = path.frames(x)[-1], path.with_wrist(6).frames(np.append(x, turns))[-1]
    np.testing.assert_allclose(turned[:3, 3], tip[:3, 3], atol=1e-12)
    meant = tip[:3, :3]
    for axis, angle in zip("zyz", turns, strict=True):
        meant = meant @ pin.utils.rotate(axis, angle)
    np.testing.assert_allclose(turned[:3, :3], meant, atol=1e-12)


def test_a_wrist_at_the_base_is_found_from_the_tip() -> None:
    arm = arm_of(chain_of("panda"))
    assert arm.backwards and arm.arrays[7][0] == 1
    assert not arm_of(chain_of("talos_arm")).backwards


def test_slides_without_limits_cannot_be_covered() -> None:
    model = pin.Model()
    joint = model.addJoint(0, pin.JointModelPX(), pin.SE3.Identity(), "slide")
    model.addFrame(pin.Frame("tip", joint, 0, pin.SE3.Identity(), pin.FrameType.OP_FRAME))
    chain = mik.Chain(model, "tip")
    assert proof_arm(chain.paths, chain.limits, 0, WHOLE) is None


def arm_with_shoulder(rng: np.random.Generator, backwards: bool, off: float) -> mik.Chain:
    """Seven joints at any angle, axes of a wrist and a shoulder meeting, or missing each other by ``off`` (m)."""
    model, joint, meeting = pin.Model(), 0, (1, 2, 5) if backwards else (2, 5, 6)
    for i in range(7):
        way = off * rng.normal(size=3) if i in meeting else rng.uniform(-0.4, 0.4, 3)
        ten, most = np.array([10.0]), np.array([rng.uniform(1.0, 3.1)])
        placement = pin.SE3(pin.exp3(2.0 * rng.normal(size=3)), way)
        joint = model.addJoint(joint, pin.JointModelRZ(), placement, f"joint_{i}", ten, ten, -most, most)
    model.addFrame(pin.Frame("tip", joint, 0, pin.SE3(np.eye(3), rng.uniform(-0.2, 0.2, 3)), pin.FrameType.OP_FRAME))
    return mik.Chain(model, "tip")


def has_shoulder(arm: ProofArm) -> bool:
    return bool(arm.arrays[7][2])


def test_a_shoulder_is_found_from_either_end_and_only_before_a_wrist() -> None:
    rng = np.random.default_rng(0)
    for backwards in False, True:
        arm = arm_of(arm_with_shoulder(rng, backwards, 0.0))
        assert has_shoulder(arm) and arm.backwards == backwards
    assert has_shoulder(arm_of(chain_of("panda"))) and has_shoulder(arm_of(chain_of("xarm7")))
    assert not has_shoulder(arm_of(chain_of("puma560"))) and not has_shoulder(arm_of(chain_of("aerial_arm")))
    assert not has_shoulder(arm_of(arm_with_shoulder(rng, False, 1e-4)))


@pytest.mark.parametrize("off", [0.0, 2e-6])
@pytest.mark.parametrize("backwards", [False, True])
def test_what_is_kept_of_an_arm_with_a_shoulder_holds_every_solution(backwards: bool, off: float) -> None:
    """Limits, corners and stretched and folded shoulders and wrists included."""
    rng, held = np.random.default_rng(3), 0
    for _ in range(12):
        chain = arm_with_shoulder(rng, backwards, off)
        x = chain.box.sample(rng, 1)[0]
        x = np.where(rng.random(7) < 0.3, rng.choice([chain.limits.lower, chain.limits.upper, np.zeros(7)]), x)
        pose = chain.poses(x)[0, 0]
        solutions = chain.x(mik.solve_ik_all(chain, pose, limit=16).q)
        for least in 0.2, 0.02:
            boxes = chain._boxes(0, pose, 1e-5, 1e-5, least=least, shrink=True)
            kept = boxes.look(200_000, 100_000)
            assert boxes.done
            for one in [x, *solutions]:
                assert (np.abs(kept[:, :7] - one) <= kept[:, 7:] + 1e-9).all(axis=1).any()
                held += 1
    assert held > 100


def test_boxes_of_an_arm_with_a_shoulder_are_split_in_one_coordinate() -> None:
    """1,000 of them in the median, 4,600 where all four joints before the wrist were split."""
    chain, looked = chain_of("panda"), []
    for x in chain.box.sample(np.random.default_rng(12), 30):
        boxes = chain._boxes(0, chain.poses(x)[0, 0], 0.0, 0.0, least=0.15, shrink=True)
        boxes.look(100_000, 10_000)
        assert boxes.done
        looked.append(boxes.looked)
    assert np.median(looked) < 2_000


@pytest.mark.parametrize("robot", ["panda", "xarm7"])
def test_boxes_that_are_shrunk_hold_the_solution_with_its_wrist(robot: str) -> None:
    chain = chain_of(robot)
    n = chain.n
    for x in chain.box.sample(np.random.default_rng(4), 10):
        boxes = chain._boxes(0, chain.poses(x)[0, 0], 0.0, 0.0, least=0.05, shrink=True)
        kept = boxes.look(200_000, 20_000)
        assert boxes.done
        off = kept[:, :n] - x
        off = np.where(chain.limits.rotates, off - 2.0 * np.pi * np.round(off / (2.0 * np.pi)), off)
        assert (np.abs(off) <= kept[:, n:] + 1e-9).all(axis=1).any()
        assert (kept[:, n:] <= 0.05).all()


def test_a_box_shrinks_to_the_solution_in_it_and_what_is_empty_to_nothing() -> None:
    chain = chain_of("talos_arm")
    x = chain.box.sample(np.random.default_rng(3), 1)[0]
    boxes = chain._boxes(0, chain.poses(x)[0, 0], 0.0, 0.0, least=1e-6, shrink=True)
    around, beside = (np.concatenate([x + off, np.full(6, 0.05)]) for off in (0.02, 0.08))
    part = boxes.within(around, 1e-6)
    kept = part.look(40, 10)
    assert part.done and len(kept) == 1
    np.testing.assert_allclose(kept[0, :6], x, atol=1e-6)
    empty = boxes.within(beside, 1e-6)
    assert not len(empty.look(40, 10)) and empty.excluded


@pytest.mark.parametrize("robot", ["panda", "puma560", "aerial_arm"])
def test_boxes_wait_where_there_was_no_room_for_them(robot: str, monkeypatch: pytest.MonkeyPatch) -> None:
    chain, kept = chain_of(robot), []
    pose = chain.poses(chain.box.sample(np.random.default_rng(5), 1)[0])[0, 0]
    for room in 1024, 9:
        monkeypatch.setattr(boxes_of, "DEPTH", room)
        boxes = chain._boxes(0, pose, 0.0, 0.0, least=0.05, shrink=True)
        kept.append(boxes.look(200_000, 20_000))
        assert boxes.done
    np.testing.assert_array_equal(*kept)


def test_boxes_come_to_an_end_where_only_the_first_joint_is_wide_and_the_wrist_may_be_straight() -> None:
    """They were split in joints that were 1e-160 rad wide, until there was no room, and then looked at for ever."""
    chain = chain_of("rv7fl")
    x = np.array([3.8782949229110404, -1.2911321556647906, 2.482711224947752, 1.4122523269968768, 1.8724596723804159])
    pose = chain.poses(np.append(x, 4.342845967835998))[0, 0]
    begin = chain.nominal_proof.judge(pose, 0.0, 0.0).pieces
    boxes = chain._boxes(0, pose, 0.0, 0.0, least=0.0025, shrink=True, begin=begin)
    boxes.look(100_000, 10_000)
    assert boxes.done
