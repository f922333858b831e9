"""Singular poses by construction: a curve of solutions is told as such, and comes as one of its points."""

import numpy as np
import pytest

import pin_metaik as mik
from pin_metaik.ik.singular import NullMotions
from tests.robots_under_test import chain_of

STRAIGHT = {  # by the label that is 0 there
    "puma560": ([0.3, -0.7, 0.4, 0.5, 0.0, 0.2], "wrist"),
    "rv7fl": ([0.3, -0.2, 1.4, 0.5, 0.0, 0.2], "wrist"),
    "ur5": ([0.3, -1.2, 1.4, -0.9, 0.0, 0.6], "wrist"),
}


@pytest.mark.parametrize("name", STRAIGHT)
def test_a_straight_wrist_is_told_as_a_curve_and_not_as_many_solutions(name: str) -> None:
    chain, (x, zero) = chain_of(name), STRAIGHT[name]
    pose = chain.poses(np.array(x))[0, 0]
    for certify in (True, False):
        every = mik.solve_ik_all(chain, pose, chain.q(x), certify=certify)
        assert every.complete is None
        assert set(every.dimensions) <= {0, 1} and 1 in every.dimensions and len(every) <= 8
        assert every.as_dict()["dimensions"] == list(every.dimensions)
        for dimension, label in zip(every.dimensions, every.labels, strict=True):
            assert (f"{zero} 0" in label) == (dimension == 1)


@pytest.mark.parametrize("off", [1e-7, 1e-6, 1e-5, 1e-4])
@pytest.mark.parametrize("name", STRAIGHT)
def test_a_wrist_within_the_tolerances_of_straight_does_not_give_copies(name: str, off: float) -> None:
    chain, x = chain_of(name), np.array(STRAIGHT[name][0])
    x[4] += off
    every = mik.solve_ik_all(chain, chain.poses(x)[0, 0], chain.q(x))
    assert len(every) <= (12 if off == 1e-5 else 8)  # there the motions end within the tolerances
    assert chain.limits.separation(every.x, x).max(axis=1).min() < 2e-2
    nearest = int(chain.limits.separation(every.x, x).max(axis=1).argmin())
    assert every.dimensions[nearest] == (1 if off < 2e-6 else 0) or off == 1e-5  # where it depends on the arm
    for i in range(len(every)):
        ways = chain.limits.separation(np.delete(every.x, i, axis=0), every.x[i]).max(axis=1)
        assert (ways > 5e-3).all()


def test_the_curve_of_a_straight_wrist_turns_its_outer_joints_against_each_other() -> None:
    chain, (x, _) = chain_of("puma560"), STRAIGHT["puma560"]
    problem = mik.IKProblem.of(chain, chain.poses(np.array(x))[0, 0]).exact
    curve = NullMotions.of(problem).curve(np.array(x))
    assert curve is not None and len(curve) > 20
    assert np.ptp(curve[:, 3] + curve[:, 5]) < 1e-6 and np.ptp(curve[:, [0, 1, 2, 4]], axis=0).max() < 1e-6
    assert all(problem.accepts(q) for q in chain.q(curve))
    room = chain.limits.upper[3] - chain.limits.lower[3]
    assert room - 0.01 < np.ptp(curve[:, 3]) <= room + 1e-9  # from limit to limit


def test_what_descents_find_in_a_singularity_is_on_one_of_the_curves() -> None:
    chain, (x, _) = chain_of("ur5"), STRAIGHT["ur5"]
    pose = chain.poses(np.array(x))[0, 0]
    every = mik.solve_ik_all(chain, pose)
    problem = every.problem.exact
    curves = [NullMotions.of(problem).curve(one) for one, d in zip(every.x, every.dimensions, strict=True) if d]
    known = np.concatenate([curve for curve in curves if curve is not None] + [every.x])
    for start in chain.box.sample(np.random.default_rng(0), 60):
        found = mik.solve_ik(
            chain, mik.Target(pose, position_tolerance=1e-9, orientation_tolerance=1e-9), chain.q(start)
        )
        assert found.success
        assert chain.limits.separation(known, found.x).max(axis=1).min() < 0.05


def test_a_stretched_elbow_is_one_solution_and_no_curve() -> None:
    chain = chain_of("ur5")
    x = np.array([0.3, -1.2, 0.0, -0.9, 1.0, 0.6])
    every = mik.solve_ik_all(chain, chain.poses(x)[0, 0])
    assert set(every.dimensions) == {0}


def over_the_base(chain: mik.Chain) -> np.ndarray:
    """Coordinates (6,) at which the shoulder's factor is 0."""

    def factor(x: np.ndarray) -> float:
        values = np.empty((1, 4))
        chain.kernels.factors(chain.block, x[None], values)
        return float(values[0, 0])

    a, *others = chain.box.sample(np.random.default_rng(4), 50)
    b = next(x for x in others if factor(x) * factor(a) < 0.0)
    for _ in range(60):
        middle = 0.5 * (a + b)
        a, b = (middle, b) if factor(middle) * factor(a) > 0.0 else (a, middle)
    return a


@pytest.mark.parametrize(("name", "dimension"), [("rv7fl", 1), ("puma560", 0)])
def test_a_wrist_over_the_base_lets_the_shoulder_turn_unless_the_arm_stands_beside_it(
    name: str, dimension: int
) -> None:
    chain = chain_of(name)
    x = over_the_base(chain)
    every = mik.solve_ik_all(chain, chain.poses(x)[0, 0], chain.q(x))
    nearest = int(chain.limits.separation(every.x, x).max(axis=1).argmin())
    assert every.dimensions[nearest] == dimension and len(every) <= 8


def test_a_redundant_chain_has_as_many_dimensions_as_spare_coordinates() -> None:
    chain = chain_of("panda")
    pose = chain.poses(chain.box.sample(np.random.default_rng(0), 1))[0, 0]
    assert set(mik.solve_ik_all(chain, pose, limit=3).dimensions) == {1}
    assert set(mik.solve_ik_all(chain, pose[:3, 3], limit=3).dimensions) == {4}
