"""The benchmark of inverse-kinematics solvers: its targets are what they are called, and it runs."""

import importlib
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import pin_metaik as mik
from tests.robots_under_test import chain_of

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"
ROBOTS = ["baxter", "kinova", "panda", "pr2", "talos", "tiago", "ur10", "ur5", "xarm7", "z1"]


@pytest.fixture
def part(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Callable[[str], ModuleType]:
    """Imports a file of the benchmark, which is no package."""
    monkeypatch.syspath_prepend(BENCHMARKS)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return importlib.import_module


def test_it_measures_our_solver_and_says_why_a_peer_could_not_be_had(tmp_path: Path) -> None:
    out = tmp_path / "speed.md"
    words = ["--targets", "5", "--robots", "ur5", "--solvers", "pin_metaik", "--no-batch", "--out", str(out)]
    nowhere = ["--peer", f"placo={tmp_path / 'python'}"]
    command = [sys.executable, str(BENCHMARKS / "ik_speed.py"), *words, *nowhere]
    environment = {**os.environ, "XDG_CACHE_HOME": str(tmp_path)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    page = out.read_text()
    for family in ("random", "near-limit", "singular"):
        section = page.split(f"## {family}")[1].split("## ")[0]
        assert "| **pin_metaik** | 1 | 100.00 % |" in section
    assert "| **pin_metaik** | 1 | 100.00 % | 0.00 % |" in page.split("## unreachable")[1]
    assert "placo: its interpreter does not start" in page
    assert str(tmp_path) not in page


@pytest.mark.parametrize("robot", ROBOTS)
def test_the_urdf_that_peers_get_moves_as_the_robot_does(robot: str, part: Callable[[str], ModuleType]) -> None:
    chain = chain_of(robot)
    serial = part("ik_serial").SerialArm
    arm = serial.from_json(serial.of_chain(robot, chain).to_json())
    alone = mik.Chain(pin.buildModelFromXML(arm.urdf()), "tip")
    assert_array_equal(alone.box.lower, chain.box.lower)
    assert_array_equal(alone.box.upper, chain.box.upper)
    for x in chain.box.sample(np.random.default_rng(0), 20):
        reached = alone.placements(arm.q(x))[0].homogeneous
        assert_allclose(reached, chain.placements(chain.q(x))[0].homogeneous, atol=1e-12)  # rounding of ten products
        assert_allclose(np.cos(arm.x(arm.q(x)) - x), 1.0, atol=1e-12)


@pytest.mark.parametrize("robot", ["panda", "kinova", "pr2"])
def test_targets_are_what_their_family_says(robot: str, part: Callable[[str], ModuleType]) -> None:
    chain, ik_targets = chain_of(robot), part("ik_targets")
    rng = np.random.default_rng(0)

    X = ik_targets.singular(chain, 30, rng)
    velocities = [chain.model.joints[int(j)].idx_v for j in chain.coordinates.joints]
    data = chain.model.createData()
    for x in X:
        J = pin.computeFrameJacobian(chain.model, data, chain.q(x), chain.frame_ids[0])[:, velocities]
        assert np.linalg.svd(J)[1][-1] < 1e-3
        assert chain.limits.contains(x)

    X = ik_targets.near_limit(chain, 30, rng)
    depth = np.minimum(X - chain.box.lower, chain.box.upper - X) / (chain.box.upper - chain.box.lower)
    assert (((depth <= 0.01) & ~chain.limits.periodic).sum(axis=1) >= min(chain.n // 2, 3)).all()
    assert all(chain.limits.contains(x) for x in X)

    far = ik_targets.targets(robot, chain, "unreachable", 30, seed=0).poses
    reach = chain.reach(0, oriented=True)
    assert all(0.009 < reach.gap(pin.SE3(pose)) < 0.501 for pose in far)


def test_the_same_seed_gives_the_same_targets(part: Callable[[str], ModuleType]) -> None:
    ik_targets = part("ik_targets")
    for family in ik_targets.FAMILIES:
        one, again, other = (ik_targets.targets("ur5", chain_of("ur5"), family, 10, seed) for seed in (0, 0, 1))
        assert_array_equal(one.poses, again.poses)
        assert_array_equal(one.starts, again.starts)
        assert (one.poses != other.poses).any()


def test_the_guarantees_are_counted_on_a_few_poses(tmp_path: Path) -> None:
    out = tmp_path / "guarantees.md"
    command = [sys.executable, str(BENCHMARKS / "ik_guarantees.py"), "--poses", "3", "--out", str(out)]
    environment = {**os.environ, "XDG_CACHE_HOME": str(tmp_path)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    page = out.read_text()
    assert "farther than the nearest of all: 0;" in page
    assert page.count("200 met") == 4
    assert "0 jumps not reported" in page
    assert "| the same bits |" in page
    assert "6 solved" in page
    assert "0 answers past a limit" in page
