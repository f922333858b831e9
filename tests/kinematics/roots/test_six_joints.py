"""All configurations of six coordinates for a pose, real and complex, and the proof that there are no others."""

from functools import cache

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

import pin_metaik as mik
from pin_metaik.kinematics.limits import Limits
from pin_metaik.kinematics.roots.counting import simple_roots
from pin_metaik.kinematics.roots.six_joints import Configurations, copies_inside

TURN = 2.0 * np.pi


@cache
def drawn_chain(kinds: str, mimic: float = 0.0) -> mik.Chain:
    """A chain drawn at random whose joints turn (R) or slide (P); with ``mimic`` the last one follows the first one."""
    rng = np.random.default_rng(len(kinds) + ord(kinds[1]))
    text, last = '<robot name="drawn"><link name="l0"/>', len(kinds) - 1
    for i, kind in enumerate(kinds):
        span = 3.0 if kind == "R" else 0.6
        xyz, rpy = rng.uniform(-0.5, 0.5, 3), rng.uniform(-2.0, 2.0, 3)
        axis = rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        follow = f'<mimic joint="j0" multiplier="{mimic}"/>' if mimic and i == last else ""
        text += (
            f'<link name="l{i + 1}"/><joint name="j{i}" type="{"revolute" if kind == "R" else "prismatic"}">'
            f'<parent link="l{i}"/><child link="l{i + 1}"/>{follow}'
            f'<origin xyz="{" ".join(map(str, xyz))}" rpy="{" ".join(map(str, rpy))}"/>'
            f'<axis xyz="{" ".join(map(str, axis))}"/>'
            f'<limit lower="{-span}" upper="{span}" effort="1" velocity="1"/></joint>'
        )
    return mik.Chain(pin.buildModelFromXML(text + "</robot>", bool(mimic)), f"l{len(kinds)}")


def away(a: np.ndarray, b: np.ndarray, rotates: np.ndarray) -> np.ndarray:
    """Greatest difference in any coordinate, whole turns aside."""
    way = np.abs(a - b)
    return np.where(rotates, np.abs(way - TURN * np.round(way.real / TURN)), way).max(axis=-1)


# The degrees are those of the literature: 16 for six turning joints and for five, 8 for four, 2 for three.
@pytest.mark.parametrize(
    ("kinds", "degree"), [("RRRRRR", 16), ("RRPRRR", 16), ("PPRRRR", 8), ("RPRPRR", 8), ("PRPRPR", 2), ("PPPRRR", 2)]
)
def test_every_pose_has_all_its_configurations_and_they_are_proved(kinds: str, degree: int) -> None:
    chain = drawn_chain(kinds)
    six = chain._six_joints
    assert six is not None
    assert (six.degree, six.bound) == (degree, degree)
    every = []
    for x in chain.box.sample(np.random.default_rng(3), 30):
        found = six.at(chain.poses(x)[0, 0])
        assert found.all
        assert len(found.x) == degree
        assert away(found.x, x, chain.limits.rotates).min() < 1e-7
        for one in found.x:  # complex ones come in pairs
            assert away(found.x, one.conjugate(), chain.limits.rotates).min() < 1e-6
        every.append(found.proved)
    assert np.mean(every) > 0.8


def test_a_joint_that_follows_another_is_solved_like_any_other() -> None:
    chain = drawn_chain("RRRRRRR", -1.0)
    assert chain.n == 6
    six = chain._six_joints
    assert six is not None
    assert six.bound == 0
    for x in chain.box.sample(np.random.default_rng(3), 10):
        pose = chain.poses(x)[0, 0]
        assert away(six.at(pose).x, x, chain.limits.rotates).min() < 1e-7
        assert away(mik.solve_ik_all(chain, pose, certify=False).x, x, chain.limits.rotates).min() < 1e-5


def test_what_turns_at_half_the_angle_of_another_joint_and_what_has_not_six_coordinates_is_left_alone() -> None:
    assert drawn_chain("RRRRRRR", 0.5)._six_joints is None
    assert drawn_chain("RRRRR")._six_joints is None
    assert drawn_chain("RRRRRRR")._six_joints is None


def test_of_two_configurations_that_are_nearly_one_both_are_kept() -> None:
    chain = drawn_chain("RRRRRR")
    rng = np.random.default_rng(5)
    for _ in range(10):
        while True:  # to where det J = 0, between two configurations where its sign differs
            a, b = chain.box.sample(rng, 2)
            if np.linalg.det(jacobian(chain, a)) * np.linalg.det(jacobian(chain, b)) < 0.0:
                break
        for _ in range(50):
            middle = 0.5 * (a + b)
            same = np.linalg.det(jacobian(chain, a)) * np.linalg.det(jacobian(chain, middle)) > 0.0
            a, b = (middle, b) if same else (a, middle)
        for off in (0.0, 1e-5, 1e-3):
            x = chain.limits.clip(a + off * rng.normal(size=6))
            found = mik.solve_ik_all(chain, chain.poses(x)[0, 0], certify=False, apart=1e-4)
            assert away(found.x, x, chain.limits.rotates).min() < 1e-2


def jacobian(chain: mik.Chain, x: np.ndarray) -> np.ndarray:
    q = chain.q(x)
    return pin.computeFrameJacobian(chain.model, chain.data, q, chain.frame_ids[0])


def test_a_set_that_is_called_complete_holds_all_that_descents_find() -> None:
    robot = mik.load_robot("aerial_arm")
    chain = mik.Chain(robot.model, robot.frame)
    rng = np.random.default_rng(8)
    kinds = []
    for x in chain.box.sample(rng, 12):
        pose = chain.poses(x)[0, 0]
        found = mik.solve_ik_all(chain, pose)
        kinds.append(found.complete)
        for start in chain.box.sample(rng, 40):
            result = mik.solve_ik(chain, pose, chain.q(start), rng=1)
            assert result.success
            assert away(found.x, result.x, chain.limits.rotates).min() < 1e-2
    assert kinds.count(mik.Proof.COUNT) > 8
    assert None not in kinds


def test_a_pose_that_is_not_quite_a_rotation_is_taken_for_the_nearest_one() -> None:
    chain = drawn_chain("RRRRRR")
    x = chain.box.sample(np.random.default_rng(0), 1)[0]
    pose = chain.poses(x)[0, 0]
    exact = mik.solve_ik_all(chain, pose)
    pose[:3, :3] += 4e-7 * np.random.default_rng(1).normal(size=(3, 3))
    assert len(mik.solve_ik_all(chain, pose)) == len(exact)


def limits(lower: float, upper: float, rotates: bool, multi_turn: bool) -> Limits:
    flags = np.array([rotates] * 6), np.array([multi_turn] * 6)
    return Limits(np.full(6, lower), np.full(6, upper), np.ones(6), *flags, tuple("abcdef"))


def test_a_configuration_comes_as_its_copies_inside_the_limits() -> None:
    x = np.array([[0.1, 0.2, 0.3, 0.4, 0.5, 0.6]])
    assert_allclose(copies_inside(x, limits(6.0, 8.0, True, False), x[0]), x + TURN)
    assert_allclose(copies_inside(x, limits(-9.0, 9.0, True, True), x[0] + 6.0), x + TURN)
    assert_allclose(copies_inside(x, limits(-np.inf, np.inf, True, True), x[0] - 60.0), x - 10 * TURN)
    assert len(copies_inside(x, limits(-5.7, 6.4, True, False), x[0])) == 4  # 0.1 and 0.6 have two places each
    assert len(copies_inside(x, limits(0.3, 8.0, False, False), x[0])) == 0
    assert_allclose(copies_inside(x, limits(0.1005, 8.0, False, False), x[0]), x)  # a descent may still end inside
    none = Configurations(np.empty((0, 6), np.complex128), np.empty((0, 6), np.complex128), False, False, 0)
    assert [part.shape for part in none.inside(limits(-1.0, 1.0, True, False), np.zeros(6))] == [(0, 6), (0, 6)]


def test_only_separate_points_that_are_roots_are_counted() -> None:
    six = drawn_chain("RRRRRR")._six_joints
    assert six is not None
    chain, rng = drawn_chain("RRRRRR"), np.random.default_rng(2)
    pose = chain.poses(chain.box.sample(rng, 1)[0])[0, 0]
    target = np.append(pose[:3, :3].ravel(), pose[:3, 3] / six.length)
    roots = six.at(pose).x
    assert simple_roots(*six.arm, target, roots) == 16
    assert simple_roots(*six.arm, target, np.concatenate([roots[:5], roots[:5] + TURN])) == 5
    assert simple_roots(*six.arm, target, roots + 1e-6 * rng.normal(size=roots.shape)) == 0
    target[9] += 1e-6
    assert simple_roots(*six.arm, target, roots) == 0
