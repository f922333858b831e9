"""Reach bounds are true: nothing reachable is ever excluded, and they are tight enough to be of use.

``benchmarks/ik_guarantees.py`` asks the same of 100,000 targets.
"""

import numpy as np
import pinocchio as pin
import pytest

import pin_metaik as mik
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


def unit(rng: np.random.Generator) -> np.ndarray:
    v = rng.standard_normal(3)
    return v / np.linalg.norm(v)


def any_chain(rng: np.random.Generator, misshapen: float = 0.0) -> mik.Chain:
    """A chain of 2 to 13 joints, turning and sliding, of millimetres to kilometres, about axes near -z and others."""
    model, parent = pin.Model(), 0
    size = 10.0 ** rng.uniform(-3, 3)
    for i in range(int(rng.integers(2, 14))):
        axis = unit(rng) if rng.random() < 0.6 else np.array([0.0, 0.0, -1.0]) + 10.0 ** rng.uniform(-9, -2) * unit(rng)
        axis /= np.linalg.norm(axis)
        slides = rng.random() < 0.2
        turn = pin.exp3(rng.choice([0.0, 1e-6, 1.0]) * rng.standard_normal(3)) + misshapen * rng.standard_normal((3, 3))
        offset = pin.SE3(turn, size * rng.standard_normal(3) * rng.choice([0.0, 1.0], 3))
        joint = pin.JointModelPrismaticUnaligned(axis) if slides else pin.JointModelRevoluteUnaligned(axis)
        most = np.array([size if slides else 2.5])
        parent = model.addJoint(parent, joint, offset, f"j{i}", np.ones(1), np.ones(1), -most, most)
    tip = pin.SE3(pin.exp3(rng.standard_normal(3)), size * rng.standard_normal(3) * rng.choice([0.0, 1.0]))
    model.addFrame(pin.Frame("tip", parent, 0, tip, pin.FrameType.OP_FRAME))
    return mik.Chain(model, "tip")


def feasible(chain: mik.Chain, q: np.ndarray, rng: np.random.Generator) -> mik.Target:
    """A target that q (nq,) meets: its pose, or one as far off as tolerances from 1e-9 on allow."""
    pose = chain.placements(q)[0]
    near, aligned = 10.0 ** rng.uniform(-9, -1), 10.0 ** rng.uniform(-9, 0)
    turn = pin.exp3(rng.choice([0.0, 0.95]) * aligned * unit(rng))
    error = pin.SE3(turn, rng.choice([0.0, 0.95]) * near * unit(rng))
    asked = pose * error.inverse()
    match rng.integers(4):
        case 0:
            return mik.Target(asked, None, near, aligned)
        case 1:
            return mik.Target(asked, None, [near] * 3, aligned, position_weight=10.0)
        case 2:
            return mik.Target(asked, None, near, np.inf)
        case _:
            return mik.Target(pose, None, 1e-9, 1e-9)


def configurations(chain: mik.Chain, count: int, rng: np.random.Generator) -> np.ndarray:
    """Coordinates (count, n): random ones, some joints at limits, and corners."""
    X = chain.box.sample(rng, count)
    ends = np.where(rng.random(X.shape) < 0.5, chain.box.lower, chain.box.upper)
    return np.where(rng.random(X.shape) < rng.choice([0.0, 0.5, 1.0], (count, 1)), ends, X)


def never_unreachable(chain: mik.Chain, count: int, rng: np.random.Generator) -> None:
    few = mik.IKSolver(budget=mik.Budget(evaluations=40))
    for number, q in enumerate(chain.q(configurations(chain, count, rng))):
        target = feasible(chain, q, rng)
        if not target.judge(chain.placements(q)[0]).met:
            continue  # but for rounding
        assert mik.IKProblem.of(chain, target).gap == 0.0
        if number % 5 == 0:
            assert mik.solve_ik(chain, target, solver=few).status is not mik.IKStatus.UNREACHABLE
            pose = chain.placements(q)[0].homogeneous
            assert mik.solve_ik_batch(chain, pose[None], solver=few).status[0] is not mik.IKStatus.UNREACHABLE


@pytest.mark.parametrize("name", [*CATALOGUE, "panda", "ur5", "kinova", "tiago", "so101"])
def test_what_a_configuration_meets_is_never_called_unreachable(name: str) -> None:
    never_unreachable(chain_of(name), 200, np.random.default_rng(3))


@pytest.mark.parametrize("misshapen", [0.0, 1e-8])
def test_nor_on_any_chain_of_any_size_with_placements_that_are_not_quite_rotations(misshapen: float) -> None:
    rng = np.random.default_rng(4)
    for _ in range(15):
        never_unreachable(any_chain(rng, misshapen), 60, rng)


def test_a_target_that_is_not_quite_a_rotation_is_not_called_unreachable_for_that() -> None:
    chain = chain_of("panda")
    stretched = np.zeros(7)
    pose = chain.placements(chain.q(chain.limits.clip(stretched)))[0]
    for stretch in (-3e-7, 3e-7):
        rough = pose.homogeneous.copy()
        rough[:3, :3] *= 1.0 + stretch
        target = mik.Target(rough, None, 1e-9, 1e-9)
        assert target.judge(pose).met
        assert mik.IKProblem.of(chain, target).gap == 0.0
        assert mik.solve_ik(chain, target).status is not mik.IKStatus.UNREACHABLE


def test_what_is_out_of_reach_is_still_proved_to_be() -> None:
    rng = np.random.default_rng(5)
    for chain in [chain_of("panda"), chain_of("ur5"), *(any_chain(rng) for _ in range(5))]:
        reach = chain.reach(0, False)
        away = reach.anchor + (1.001 * reach.most + 0.01) * unit(rng)
        assert mik.solve_ik(chain, away).status is mik.IKStatus.UNREACHABLE
