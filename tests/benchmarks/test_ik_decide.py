"""The dense scan is what it says, independent of what it judges; the page of decided targets is written."""

import subprocess
import sys
from importlib import import_module
from pathlib import Path
from types import ModuleType

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

import pin_metaik as mik

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"


@pytest.fixture(scope="module")
def scan() -> ModuleType:
    """``benchmarks/grasp_scan.py``."""
    sys.path.insert(0, str(BENCHMARKS))
    try:
        return import_module("grasp_scan")
    finally:
        sys.path.remove(str(BENCHMARKS))


@pytest.mark.parametrize("robot", ["panda", "ur5", "tiago"])
def test_the_screws_of_the_scan_place_the_tip_as_pinocchio_does(scan: ModuleType, robot: str) -> None:
    loaded = mik.load_robot(robot)
    model, data, number = loaded.model, loaded.model.createData(), loaded.model.getFrameId(loaded.frame)
    arm = scan.PlainArm.of(model, loaded.frame)
    X = np.random.default_rng(0).uniform(arm.lower, arm.upper, (20, len(arm.lower)))
    for x, rotation, position, J in zip(X, *arm.place(X), strict=True):
        q = arm.configuration(x)
        pin.framesForwardKinematics(model, data, q)
        assert_allclose(rotation, data.oMf[number].rotation, atol=1e-12)  # rounding of eight products
        assert_allclose(position, data.oMf[number].translation, atol=1e-12)
        jacobian = pin.computeFrameJacobian(model, data, q, number, pin.LOCAL_WORLD_ALIGNED)
        assert_allclose(
            J,
            jacobian[:, [model.joints[int(j)].idx_v for j in mik.Chain(model, loaded.frame).coordinates.joints]],
            atol=1e-12,
        )


@pytest.mark.parametrize("robot", ["panda", "ur5"])
def test_the_scan_knows_the_three_verdicts(scan: ModuleType, robot: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(scan, "EACH", 2)  # quicker, and enough for these
    chain, world = scan.shelf_of(robot)
    decide = scan.Scan.of(mik.load_robot(robot), world).decide
    X = chain.box.sample(np.random.default_rng(1), 60)
    free = next(x for x in X if not world.checker.collides(chain.q(x)))
    free, deep, far = chain.placements(chain.q(free))[0].homogeneous, np.eye(4), np.eye(4)
    deep[:3, :3], deep[:3, 3] = pin.utils.rotate("y", np.pi / 2), [0.6, 0.0, 0.45]  # in the middle of a board
    far[:3, 3] = [0.0, 0.0, 5.0]
    verdicts = [decide(pose, np.random.default_rng(0)).verdict for pose in (free, deep, far)]
    assert verdicts == [scan.SOLVABLE, scan.COLLIDES, scan.NONE]


@pytest.mark.slow
def test_every_section_is_written_and_the_others_are_kept(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("# Old\n\n## Seeds and generators\n\nmeasured before\n")
    sizes = ["--targets", "8", "--grasps", "3", "--again", "3", "--workers", "1", "--robots", "ur5", "--out", str(page)]
    command = [sys.executable, str(BENCHMARKS / "ik_decide.py"), "arms", "shelf", "twice", *sizes]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    text = page.read_text()
    assert text.count("\n## ") == 4 and "measured before" in text and str(tmp_path) not in text
    assert text.count("| 3 of 3 | 3 of 3 | 3 of 3 |") == 2
    assert text.count("| 3 | 0 | 0 | 0 | 0 |") == 2  # all agree with the scan
