"""The commands about Stewart platforms, with platforms moved by servos."""

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose
from typer.testing import CliRunner

from pin_metaik.cli import app
from pin_metaik.errors import InvalidConfiguration
from pin_metaik.stewart import Verdict, inverse, load_mechanism, pose_at

POSE = (5, 0, 115, 3, 2, 0)


def run(*arguments):
    return CliRunner().invoke(app, ["stewart", *map(str, arguments)])


def test_servos_are_shown_with_what_they_are():
    result = run("show", "servo_esp32")
    assert result.exit_code == 0
    for text in (
        "horns                15 mm",
        "rods                 140 mm",
        "-90 deg to 90 deg",
        "120, -60, -120",
        "source",
    ):
        assert text in result.output


def test_analyse_gives_angles_transmission_and_both_kinds_of_singularities():
    result = run("analyse", "servo_sg90", "--cells", 20, "--pose", *POSE)
    assert result.exit_code == 0
    for text in (
        "servo angles",
        "-8.55743, -6.5963",
        "transmission",
        "least transmission",
        "beyond the angle of a servo",
    ):
        assert text in result.output


def test_analyse_as_json_has_angles_in_rad_and_null_where_no_rod_reaches():
    result = run("analyse", "servo_sg90", "--cells", 20, "--pose", *POSE, "--to", 0, 0, 160, 0, 0, 0, "--json")
    report = json.loads(result.stdout)
    q = inverse(load_mechanism("servo_sg90").geometry, pose_at((0.005, 0, 0.115), np.radians([3, 2, 0]))).coordinates[0]
    assert_allclose(report["at_pose"]["servo_angles"], q, atol=1e-12)
    assert len(report["at_pose"]["transmission"]) == 6
    assert report["along_way"]["servo_angles"][-1] == [None] * 6
    assert report["along_way"]["states"][-1] == "too_long"
    far = run("analyse", "servo_sg90", "--cells", 20, "--pose", 0, 0, 160, 0, 0, 0)
    assert "m too short" in far.output
    assert far.exit_code == 0


def test_forward_takes_angles_in_degrees():
    angles = (-8.55743, -6.5963, 5.13228, 14.7553, -0.0350726, -11.5301)
    result = run("forward", "servo_sg90", "--json", "--", *angles)
    report = json.loads(result.stdout)
    assert_allclose(report["angles"], np.radians(angles))
    assert_allclose(report["poses"][0], pose_at((0.005, 0, 0.115), np.radians([3, 2, 0])), atol=1e-6)
    every = run("forward", "servo_sg90", "--all", "--", *angles)
    assert every.exit_code == 0
    assert "all of them: 40 of 40" in every.output
    few = run("forward", "servo_sg90", "--", 1, 2)
    assert isinstance(few.exception, InvalidConfiguration)
    assert "give as many angles, got 2" in str(few.exception)


def test_a_way_is_followed_and_drawn_with_angles(tmp_path):
    pytest.importorskip("matplotlib")
    way = tmp_path / "way.csv"
    way.write_text("time,x,y,z,roll,pitch,yaw\n0,0,0,115,0,0,0\n1,4,2,118,2,0,3\n2,0,0,115,0,0,0\n")
    result = run("follow", "servo_sg90", way, "-o", tmp_path / "legs.csv", "--picture", tmp_path / "legs.png")
    assert result.exit_code == 0
    assert "lowest, highest" in result.output
    assert "deg/s" in result.output
    assert (tmp_path / "legs.csv").read_text().startswith("time,a1,")
    assert (tmp_path / "legs.png").stat().st_size > 10_000


def test_a_platform_of_servos_is_begun_drawn_designed_and_written_for_other_tools(tmp_path):
    pytest.importorskip("matplotlib")
    path, better = tmp_path / "mine.toml", tmp_path / "better.toml"
    assert run("new", "6x3", "--base", 60, "--platform", 40, "--servos", 20, 110, "-o", path).exit_code == 0
    assert "angles = [15, 45, 135, 165, 255, 285]" in path.read_text()
    assert run("design", path, "--evaluations", 60, "--cells", 10, "-o", better).exit_code == 0
    assert load_mechanism(better).survey().verdict is Verdict.REGULAR
    names = {name: tmp_path / name for name in ("m.png", "above.png", "m.urdf")}
    shown = run("show", better, "-o", names["m.png"], "--above", names["above.png"], "--urdf", names["m.urdf"])
    assert shown.exit_code == 0
    assert all(name.stat().st_size > 1000 for name in names.values())
