"""The pose solver: what it says of a target, and what it refuses."""

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

from pin_metaik.ik.solver import DEFAULT_SOLVER
from tests.robots_under_test import chain_of

SETTINGS = DEFAULT_SOLVER.kernel_settings


@pytest.mark.parametrize("name", ["ur5", "panda"])
def test_a_target_comes_back_as_pinocchio_writes_it(name: str) -> None:
    """Position and quaternion, sign included: small turns, turns by nearly pi about every axis, and any."""
    chain = chain_of(name)
    solver = chain.pose_solver
    rng = np.random.default_rng(0)
    turns = [1e-9 * rng.normal(size=3) for _ in range(20)] + [rng.normal(size=3) for _ in range(200)]
    turns += [(np.pi + off) * axis for axis in np.eye(3) for off in (-1e-3, 1e-9, 1e-3)]
    turns += [3.1 * axis / np.linalg.norm(axis) for axis in rng.normal(size=(100, 3))]
    for turn in turns:
        target = pin.SE3(pin.exp3(turn), rng.normal(size=3))
        spent, position, quaternion = solver.solve_pose(
            solver.block, solver.rows, solver.starts, SETTINGS, target.homogeneous, chain.reference.copy()
        )
        assert spent >= 0
        assert_allclose([*position, *quaternion], pin.SE3ToXYZQUATtuple(target), atol=1e-15)


def test_what_is_no_pose_and_no_configuration_is_refused() -> None:
    chain = chain_of("ur5")
    solver, pose, q = chain.pose_solver, np.eye(4), chain.reference.copy()

    def spent(target: np.ndarray, start: np.ndarray) -> int:
        return solver.solve_pose(solver.block, solver.rows, solver.starts, SETTINGS, target, start)[0]

    mirrored, shifted, unsound = np.diag([1.0, 1.0, -1.0, 1.0]), np.eye(4), np.eye(4)
    shifted[3, 0], unsound[0, 3] = 1.0, np.nan
    assert spent(pose, q) >= 0
    for target in (mirrored, shifted, unsound, 2.0 * pose, pose[:3].copy()):
        assert spent(target, q) < 0
    for start in (q[:5].copy(), np.append(q, 0.0), np.full(6, np.nan)):
        assert spent(pose, start) < 0
