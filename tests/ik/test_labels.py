"""Labels of solutions: they change where a singularity is crossed, and nowhere else."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import pin_metaik as mik
from pin_metaik.dexterity import singular_values
from pin_metaik.ik.labels import labels_of, signs_of
from tests.robots_under_test import chain_of

ZERO = 1e-6  # a determinant counts as 0 below 1e-9 of the arm's size cubed, and has five more singular values in it
FORMED = ["ur5", "puma560", "z1", "kinova", "rv7fl"]


def problem_at(chain: mik.Chain, x: np.ndarray) -> mik.IKProblem:
    return mik.IKProblem.of(chain, chain.poses(x)[0, 0])


@pytest.mark.parametrize("name", FORMED)
def test_the_factors_of_an_arm_with_a_closed_form_multiply_to_its_determinant(name: str) -> None:
    chain, values = chain_of(name), np.empty((500, 4))
    chain.kernels.factors(chain.block, chain.box.sample(np.random.default_rng(0), 500), values)
    share = values[:, 3] / values[:, :3].prod(axis=1)
    assert_allclose(np.abs(share), 1.0, atol=1e-6)  # kinova's axes meet to nine digits
    assert len(np.unique(np.sign(share))) == 1


@pytest.mark.parametrize("name", ["ur5", "puma560", "aerial_arm", "bravo7_no_ee"])
def test_a_label_changes_along_a_motion_only_where_the_jacobian_is_singular(name: str) -> None:
    chain, rng, changes = chain_of(name), np.random.default_rng(1), 0
    for a, b in zip(chain.box.sample(rng, 12), chain.box.sample(rng, 12), strict=True):
        way = a + np.linspace(0.0, 1.0, 400)[:, None] * (b - a)
        signs = signs_of(problem_at(chain, a), way)
        for k in np.flatnonzero((signs[1:] != signs[:-1]).any(axis=1)):
            low, high = way[k], way[k + 1]
            first = signs[k]
            for _ in range(50):  # to where the sign changes
                middle = 0.5 * (low + high)
                same = (signs_of(problem_at(chain, a), middle[None])[0] == first).all()
                low, high = (middle, high) if same else (low, middle)
            assert singular_values(problem_at(chain, low).linearize(low)[1])[-1] < ZERO
            changes += 1
    assert changes


@pytest.mark.parametrize("name", FORMED)
def test_solutions_of_an_arm_with_a_closed_form_have_labels_of_their_own(name: str) -> None:
    chain = chain_of(name)
    for pose in chain.poses(chain.box.sample(np.random.default_rng(2), 40))[:, 0]:
        every = mik.solve_ik_all(chain, pose)
        if every.complete is not None:
            assert len(set(every.labels)) == len(every) and "shoulder" in every.labels[0]
            assert every.labels == labels_of(every.problem, every.x)


def test_a_result_is_labelled_as_the_solution_that_it_is() -> None:
    chain = chain_of("ur5")
    pose = chain.poses(np.array([0.3, -1.2, 1.4, -0.9, -1.5, 0.6]))[0, 0]
    result, every = mik.solve_ik(chain, pose), mik.solve_ik_all(chain, pose)
    nearest = np.abs(every.x - result.x).max(axis=1).argmin()
    assert result.label == every.labels[nearest]
    assert mik.solve_ik(chain, pose[:3, 3]).label == ""  # positions leave three degrees of freedom


def test_a_path_tells_its_reconfigurations_and_takes_the_way_with_none() -> None:
    chain = chain_of("ur5")
    a, b = np.array([0.3, -1.2, 1.4, -0.9, -1.5, 0.6]), np.array([0.9, -1.0, 1.1, -1.2, -1.2, 0.2])
    still = mik.solve_ik_path(chain, chain.poses(np.linspace(a, b, 30))[:, 0], chain.q(a))
    assert still.continuous and not still.reconfigurations and len(set(still.labels)) == 1
    over = b.copy()
    over[4] = 1.2  # wrist 2 passes through 0, where the wrist is singular
    crossing = mik.solve_ik_path(chain, chain.poses(np.linspace(a, over, 60))[:, 0], chain.q(a))
    free = mik.solve_ik_path(chain, chain.poses(np.linspace(a, over, 60))[:, 0])
    for path in (crossing, free):
        assert path.continuous or path.breaks
        assert all(path.labels[one.index] == one.after for one in path.reconfigurations)
    assert len(free.reconfigurations) <= len(crossing.reconfigurations)
    assert all("wrist" in str(one) for one in crossing.reconfigurations)


def test_a_path_of_poses_and_positions_has_labels_where_solutions_are_separate() -> None:
    chain = chain_of("ur5")
    q = chain.q([0.1, -1.2, 1.4, -0.5, 0.8, 0.2])
    pose = chain.placements(q)[0]
    path = mik.solve_ik_path(chain, [pose, pose.translation + np.array([0.0, 0.0, 0.01]), pose], q)
    assert path.success.all()
    assert [bool(label) for label in path.labels] == [True, False, True]
    assert not path.reconfigurations
