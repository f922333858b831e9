"""The command line, as a user calls it."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

import pin_metaik as mik


def call(*arguments: str, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "pin_metaik", *arguments], capture_output=True, text=True, cwd=cwd, check=False
    )


CASE = ("--position", "0.63925", "-0.64594", "0.40079")


@pytest.mark.parametrize("seeder", ["none", "gwo", "mtde", "sfla"])
def test_the_rv7fl_case_is_solved_to_a_nanometre(seeder: str) -> None:
    done = call("solve", "rv7fl_paper", *CASE, "--seeder", seeder, "--refiner", "dls", "--rng", "0", "--json")
    assert done.returncode == 0, done.stderr
    answer = json.loads(done.stdout)
    assert answer["status"] == "SOLVED"
    assert answer["success"] is True
    assert answer["position_error"] < 1e-9
    keys = {"robot", "frame", "status", "success", "q", "position_error", "orientation_error", "evaluations", "seconds"}
    assert keys <= answer.keys()


def test_degrees_go_in_and_come_out() -> None:
    pose = ("--position", "0.3", "0.3", "0.4")
    radians = json.loads(call("solve", "ur5", *pose, "--rpy", "0", str(np.pi / 2), "0", "--json").stdout)
    degrees = json.loads(call("solve", "ur5", *pose, "--rpy", "0", "90", "0", "--degrees", "--json").stdout)
    assert_allclose(np.radians(degrees["q"]), radians["q"], atol=1e-9)


def test_out_of_reach_exits_with_one_and_says_why() -> None:
    done = call("solve", "panda", "--position", "2", "0", "0.5")
    assert done.returncode == 1
    assert "UNREACHABLE" in done.stdout
    assert "out of reach" in done.stdout


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("solve", "pnada", "--position", "0", "0", "1"), "did you mean 'panda'"),
        (("solve", "panda", "--position", "0", "0", "1", "--frame", "hand"), "did you mean 'panda_hand'"),
        (("solve", "panda", "--position", "0", "0", "1", "--seeder", "gow"), "did you mean 'gwo'"),
        (("solve", "panda", "--position", "0", "0", "1", "--evaluations", "0"), "evaluations"),
        (("solve", "panda", "--position", "nan", "0", "1"), "finite"),
        (("solve", "panda", "--position", "0", "0"), "requires 3 arguments"),
        (("solve", "panda"), "--position"),
        (("solve", "no/such/file.urdf", "--position", "0", "0", "1"), "no/such/file.urdf"),
        (("urdf",), "--all"),
        (("urdf", "rv7"), "rv7fl"),
    ],
)
def test_a_call_that_makes_no_sense_exits_with_two_and_one_clear_line(arguments: tuple[str, ...], says: str) -> None:
    done = call(*arguments)
    assert done.returncode == 2
    assert says in done.stderr
    assert "Traceback" not in done.stderr
    assert done.stdout == ""


def test_robots_lists_the_catalogue_and_the_arms() -> None:
    listed = call("robots").stdout
    for name in ("rv7fl_paper", "puma_offset", "panda", "ur5", "talos_arm", "z1"):
        assert name in listed


def test_urdf_prints_writes_and_writes_all(tmp_path: Path) -> None:
    text = call("urdf", "rv7fl").stdout
    assert text == mik.load_robot("rv7fl").urdf
    assert call("urdf", "rv7fl", "-o", "arm.urdf", cwd=tmp_path).returncode == 0
    assert (tmp_path / "arm.urdf").read_text() == text
    assert call("urdf", "--all", cwd=tmp_path).returncode == 0
    assert (tmp_path / "urdf" / "rv7fl.urdf").read_text() == text


def test_demo_is_one_readable_table() -> None:
    done = call("demo")
    assert done.returncode == 0
    lines = done.stdout.splitlines()
    assert max(map(len, lines)) <= 80
    assert sum("SOLVED" in line and "+ dls" in line for line in lines) == 9
