"""Files in and out: trajectories, legs over time, points of a workspace; a new mechanism; the types side by side."""

import json
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from typer.testing import CliRunner

from pin_metaik.cli import app
from pin_metaik.errors import InvalidSetting, InvalidTarget, MetaIKError
from pin_metaik.optimize.pso import PSO
from pin_metaik.stewart import (
    Grid,
    LegLimits,
    all_forward,
    compare_types,
    draw_above,
    draw_motion,
    follow,
    leg_lengths,
    load_mechanism,
    new_mechanism,
    pose_at,
    read_trajectory,
    save_points,
)
from tests.stewart.cases import reference, stroke

WAY = "time,x,y,z,roll\n0,0,0,370,0\n1,10,0,370,5\n2,30,0,375,5\n"


def run(*arguments):
    return CliRunner().invoke(app, ["stewart", *map(str, arguments)])


def test_a_way_is_read_in_the_units_of_the_file_and_columns_in_any_order(tmp_path):
    path = tmp_path / "way.csv"
    path.write_text(WAY)
    way = read_trajectory(path, 0.001)
    assert_allclose(way.times, [0, 1, 2])
    assert_allclose(way.poses[1], pose_at((0.01, 0, 0.37), (np.radians(5), 0, 0)), atol=1e-15)
    assert_allclose(way.twists[1], [0.015, 0, 0.0025, np.radians(2.5), 0, 0], atol=1e-12)
    path.write_text("z,y,x,time\n370,0,0,0\n\n370,0,10,1\n")
    assert_allclose(read_trajectory(path, 0.001).poses[1], pose_at((0.01, 0, 0.37)))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "no column time"),
        ("time,x,y\n", "no column z"),
        ("time,x,y,z,jaw\n", "unknown column 'jaw'"),
        ("time,x,y,z,z\n", "a column twice"),
        ("time,x,y,z\n0,0,0,1\n", "two or more rows, got 1"),
        ("time,x,y,z\n0,0,0,1\n1,0,a,1\n", "line 3 is not 4 finite numbers"),
        ("time,x,y,z\n0,0,0,1\n1,0,nan,1\n", "line 3 is not 4 finite numbers"),
        ("time,x,y,z\n0,0,0,1\n1,0,0\n", "line 3 is not 4 finite numbers"),
        ("time,x,y,z\n0,0,0,1\n\n0,0,0,1\n", "that of line 4 is not after line 2"),
    ],
)
def test_a_way_that_is_none_is_refused_by_its_line(tmp_path, text, message):
    path = tmp_path / "way.csv"
    path.write_text(text)
    with pytest.raises(InvalidTarget, match=message):
        read_trajectory(path)
    with pytest.raises(InvalidTarget, match="cannot read"):
        read_trajectory(tmp_path / "none.csv")


def test_the_legs_over_time_are_written_and_drawn(tmp_path):
    pytest.importorskip("matplotlib")
    way, legs, picture = tmp_path / "way.csv", tmp_path / "legs.csv", tmp_path / "legs.png"
    way.write_text(WAY)
    result = run("follow", "reference_6x6", way, "-o", legs, "--picture", picture)
    assert result.exit_code == 0
    assert "fastest leg" in result.output
    table = np.genfromtxt(legs, delimiter=",", names=True, dtype=None, encoding="utf-8")
    expected = 1e3 * leg_lengths(reference().geometry, read_trajectory(way, 0.001).poses)
    assert_allclose([table[f"d{i}"] for i in range(1, 7)], expected.T, rtol=1e-8)
    assert set(table["state"]) == {"negative"}
    assert picture.stat().st_size > 10_000
    report = json.loads(run("follow", "reference_6x6", way, "--json").stdout)
    assert np.shape(report["leg_rates"]) == (3, 6)
    assert report["too_fast"] is False
    way.write_text(WAY.replace("375", "475"))
    assert run("follow", "reference_6x6", way).exit_code == 1


def test_a_motion_beyond_its_limits_is_shaded(tmp_path):
    pytest.importorskip("matplotlib")
    path = tmp_path / "way.csv"
    path.write_text(WAY.replace("375", "475"))
    mechanism = replace(reference(), limits=LegLimits(0.35, 0.47, speed=0.02))
    motion = follow(mechanism.geometry, read_trajectory(path, 0.001), mechanism.limits)
    figure = draw_motion(motion, mechanism)
    assert "beyond a limit" in figure.axes[0].get_title()
    assert len(figure.axes[1].lines) == 8  # six legs, two limits


def test_points_of_a_workspace_are_what_was_reached(tmp_path):
    grid = Grid((12, 12, 12), (-0.06, 0.06), (-0.06, 0.06), (0.2, 0.27), steps=(1, 1, 2), yaw=(-0.1, 0.1))
    workspace = replace(stroke(100), grid=grid).survey()
    table = np.genfromtxt(save_points(workspace, tmp_path / "p.csv", 0.001), delimiter=",", names=True)
    assert len(table) == workspace.cells_reached
    assert_allclose(np.column_stack([table[name] for name in "xyz"]), 1e3 * workspace.positions, rtol=1e-8)
    assert_allclose((table["nu"] * table["share"]).sum() / table["share"].sum(), workspace.gdi, rtol=1e-8)
    lines = save_points(workspace, tmp_path / "p.ply").read_text().splitlines()
    body = lines[lines.index("end_header") + 1 :]
    assert lines[:3] == ["ply", "format ascii 1.0", f"element vertex {len(body)}"]
    assert_allclose(np.array([line.split() for line in body], dtype=float)[:, :3], workspace.positions, atol=1e-9)
    with pytest.raises(InvalidSetting, match=r"\.csv or \.ply"):
        save_points(workspace, tmp_path / "p.stl")
    assert run("analyse", "stroke_100", "--cells", 12, "--points", tmp_path / "q.ply").exit_code == 0
    assert isinstance(run("analyse", "stroke_100", "--points", tmp_path / "q.stl").exception, InvalidSetting)


def test_forward_kinematics_on_the_command_line():
    geometry = reference().geometry
    d = leg_lengths(geometry, pose_at((0.01, 0.02, 0.36), (0.05, 0, 0)))
    lengths = [f"{1e3 * value:.9f}" for value in d]
    result = run("forward", "reference_6x6", *lengths)
    assert result.exit_code == 0
    assert "10, 20, 360 mm; roll, pitch, yaw 2.86479, 0, 0 deg" in result.output
    every = json.loads(run("forward", "reference_6x6", *lengths, "--all", "--json").stdout)
    assert every["complete"] is True
    assert len(every["poses"]) == len(all_forward(geometry, d))
    below = json.loads(run("forward", "reference_6x6", *lengths, "--start", 0, 0, -360, 0, 0, 0, "--json").stdout)
    assert below["poses"][0][2][3] < 0
    assert run("forward", "reference_6x6", *(["200", "900"] * 3)).exit_code == 1
    assert isinstance(run("forward", "reference_6x6", 400).exception, MetaIKError)


def test_the_jacobian_is_shown_at_a_pose():
    result = run("analyse", "stroke_100", "--cells", 12, "--pose", 0, 0, 230, 0, 0, 0)
    assert "leg 6:  0.392050,  0.457442,  0.798150, -0.033289, -0.005630,  0.019578" in result.output


@pytest.mark.parametrize("type", ["3x3", "6x3", "5x4", "6x6"])
def test_a_new_mechanism_can_be_designed_at_once(type, tmp_path):
    path = tmp_path / "new.toml"
    result = run("new", type, "--base", 20, "--platform", 9, "--lengths", 25, 35, "--unit", "cm", "-o", path)
    assert result.exit_code == 0
    mechanism = load_mechanism(path)
    assert mechanism == new_mechanism(type, 0.2, 0.09, 0.25, 0.35, unit="cm")
    assert mechanism.geometry.type == type
    assert run("design", path, "--evaluations", 60, "--cells", 8, "-o", tmp_path / "found.toml").exit_code == 0
    assert f'name = "{type}"' in run("new", type).stdout
    for nonsense in (("7x3",), (type, "--unit", "inch"), (type, "--base", 0), (type, "--lengths", 3, 2)):
        assert isinstance(run("new", *nonsense).exception, MetaIKError)


def test_the_types_are_compared_for_one_task(tmp_path):
    mechanism = new_mechanism("6x6", 0.2, 0.09, 0.25, 0.35)
    task = replace(mechanism.task, algorithm=PSO(agents=10), evaluations=60)
    found = compare_types(replace(mechanism, task=task), ("3x3", "6x3", "6x6"), 2)
    assert {one.type for one in found} == {"3x3", "6x3", "6x6"}
    fitness = [one.designed.score.fitness for one in found]
    assert sorted(fitness, reverse=True) == fitness
    assert all(max(one.runs) == one.designed.score.fitness and len(one.runs) == 2 for one in found)
    run("new", "6x6", "-o", tmp_path / "new.toml")
    result = run("types", tmp_path / "new.toml", "3x3", "4x4", "--evaluations", 60, "-o", tmp_path / "found")
    assert result.exit_code == 0
    assert load_mechanism(tmp_path / "found" / "4x4.toml").geometry.type == "4x4"
    assert isinstance(run("types", tmp_path / "new.toml", "2x2").exception, MetaIKError)
    with pytest.raises(InvalidSetting, match="no design settings"):
        compare_types(reference())


def test_a_mechanism_is_drawn_from_above(tmp_path):
    pytest.importorskip("matplotlib")
    figure = draw_above(stroke(100), pose_at((0.01, 0, 0.23)))
    labels = {text.get_text() for text in figure.axes[0].texts}
    assert {"B1", "B3", "M1", "M3", "6"} <= labels
    assert run("show", "stroke_100", "--above", tmp_path / "above.svg").exit_code == 0
    assert (tmp_path / "above.svg").exists()
