"""Closed forms decide: what they do not solve they prove, and say why."""

import numpy as np
import pinocchio as pin
import pytest
from numpy.typing import NDArray

import pin_metaik as mik
from pin_metaik.kinematics.proofs.closed_forms import ClosedFormProof
from pin_metaik.kinematics.proofs.deviation import deviation, ideal

ARMS = ["ur5", "rv7fl", "z1", "kinova", "puma560"]


def chain_of(robot: str) -> mik.Chain:
    loaded = mik.load_robot(robot)
    return mik.Chain(loaded.model, loaded.frame)


def proof_of(chain: mik.Chain) -> ClosedFormProof:
    return ClosedFormProof.of(chain.form, chain.paths, chain.limits)


def any_orientations(chain: mik.Chain, count: int, seed: int) -> NDArray[np.float64]:
    """Poses (count, 4, 4) at positions the arm reaches, in orientations it may not."""
    rng = np.random.default_rng(seed)
    poses = chain.poses(chain.box.sample(rng, count))[:, 0]
    for pose in poses:
        pose[:3, :3] = pin.Quaternion(*rng.normal(size=4)).normalized().matrix()
    return poses


@pytest.mark.parametrize("robot", ARMS)
def test_what_is_not_solved_is_proved_and_nothing_is_both(robot: str) -> None:
    chain = chain_of(robot)
    proof, poses = proof_of(chain), any_orientations(chain, 400, 5)
    proved = np.array([proof.judge(pose, 1e-5, 1e-5).proved for pose in poses])
    solved = mik.solve_ik_batch(chain, poses, solver=mik.IKSolver(budget=mik.Budget(evaluations=600))).success
    assert not (proved & solved).any()
    assert (proved | solved).mean() > 0.995


def test_a_branch_that_stays_holds_the_configuration() -> None:
    chain = chain_of("puma560")
    proof, rng = proof_of(chain), np.random.default_rng(2)
    for x in chain.limits.one_turn().box().sample(rng, 200):
        branches = proof.judge(chain.poses(x)[0, 0], 1e-6, 1e-6)
        turns = (branches.angles[branches.possible] - x + np.pi) % (2.0 * np.pi) - np.pi
        assert (np.abs(turns) <= branches.radii[branches.possible] + 1e-9).all(axis=1).any()


@pytest.mark.parametrize("robot", ARMS)
def test_an_arm_is_no_farther_from_its_closed_form_than_is_added_to_the_tolerances(robot: str) -> None:
    chain = chain_of(robot)
    paths, rng = chain.paths, np.random.default_rng(0)
    paths.joints[:, :12] += 1e-7 * rng.uniform(-1.0, 1.0, (6, 12))  # still called an arm of that form
    for row in paths.joints:
        left, _, right = np.linalg.svd(row[:9].reshape(3, 3))
        row[:9] = (left @ right).ravel()
    form = ideal(chain.form)
    assert len(chain.form)
    near, aligned = deviation(paths, form)
    assert 0.0 < near < 1e-5 and 0.0 <= aligned < 1e-5
    at_zero = pin.SE3(chain.poses(np.zeros(6))[0, 0])
    points = form[6] + np.concatenate([np.zeros((1, 3)), np.cumsum(form[7:11], axis=0)])[[0, 1, 2, 3, 4, 4]]
    for x in chain.box.sample(rng, 200):
        ideally = pin.SE3.Identity()
        for axis, point, angle in zip(form[:6], points, x, strict=True):
            turn = pin.exp3(angle * axis)
            ideally = ideally * pin.SE3(turn, point - turn @ point)
        off = (ideally * at_zero).actInv(pin.SE3(chain.poses(x)[0, 0]))
        assert np.linalg.norm(off.translation) <= near and np.linalg.norm(pin.log3(off.rotation)) <= aligned + 1e-12


@pytest.mark.filterwarnings("ignore:.*own limits")
def test_why_names_the_joint_its_limit_and_by_how_much_it_is_missed() -> None:
    chain = chain_of("rv7fl")
    x = 0.5 * (chain.limits.lower + chain.limits.upper)
    x[4] = chain.limits.upper[4] + 0.2
    wide = mik.Chain(chain.model, chain.frames[0], limits=dict.fromkeys(chain.names, (-3.0, 3.0)))
    branches = proof_of(chain).judge(wide.poses(x)[0, 0], 1e-5, 1e-5)
    assert branches.proved
    said = branches.why()
    assert "rad beyond its limit" in said and "branches are real" in said and any(name in said for name in chain.names)


def test_why_says_which_links_miss_the_wrist() -> None:
    chain = chain_of("puma560")
    pose = np.eye(4)
    pose[:3, 3] = 0.0, 0.0, 3.0
    branches = proof_of(chain).judge(pose, 1e-5, 1e-5)
    said = branches.why()
    assert branches.proved and ("miss the wrist by" in said or "too near to the axis" in said)
