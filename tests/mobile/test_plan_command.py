"""``pin-metaik plan`` and the package at its edges, as a user meets them."""

import csv
import json
import subprocess
import sys

import numpy as np
import pytest
import shapely
from typer.testing import CliRunner

from pin_metaik.cli import app
from pin_metaik.errors import MetaIKError


def call(*arguments):
    return CliRunner().invoke(app, ["plan", *map(str, arguments)])


def test_the_shortest_path_of_a_shipped_scene_is_planned():
    done = call("ten_obstacles", "--json")
    assert done.exit_code == 0
    path = json.loads(done.stdout)["path"]
    assert path["length"] == pytest.approx(11.815274943, abs=1e-6)
    assert path["collision_free"] is True
    assert "OPTIMAL: length 11.8153" in call("ten_obstacles").stdout


def test_a_path_that_collides_is_said_to_and_ends_with_1():
    done = call("u_trap", "--method", "pso", "--fitness", "paper", "--evaluations", 500, "--via", 1)
    assert done.exit_code == 1
    assert "it goes through an obstacle" in done.stdout


def test_everything_is_written_to_the_folder(tmp_path):
    done = call("random:3", "--trajectory", "dp", "--paths", 3, "--out", tmp_path)
    assert done.exit_code == 0
    names = {"scene.json", "path.json", "path.csv", "path.png", "trajectory.csv", "trajectory.json", "trajectory.png"}
    assert {file.name for file in tmp_path.iterdir()} == names
    assert "quickest: path" in done.stdout
    trajectory = json.loads((tmp_path / "trajectory.json").read_text())
    path = json.loads((tmp_path / "path.json").read_text())
    with (tmp_path / "path.csv").open() as file:
        points = [(float(row["x"]), float(row["y"])) for row in csv.DictReader(file)]
    assert points == [tuple(point) for point in path["path"]]
    assert len(path["alternatives"]) == 2
    assert path["alternatives"][0]["length"] < path["alternatives"][1]["length"]
    assert trajectory["time"] == trajectory["samples"]["t"][-1]
    again = call(tmp_path / "scene.json", "--radius", 0.23, "--margin", 0.1, "--json")
    assert json.loads(again.stdout)["path"]["optimum"] == pytest.approx(path["optimum"])


@pytest.mark.parametrize("method", ["dp", "de", "ann"])
def test_every_kind_of_trajectory_is_planned_from_the_command_line(method):
    done = call("random:1", "--trajectory", method, "--json", "--margin", 0.15)
    report = json.loads(done.stdout)["trajectory"]
    assert report["method"] == method
    assert done.exit_code == (0 if report["success"] else 1)
    assert report["path"][0] == [0.5, 0.5]


def test_polygons_and_grids_are_planned_from_files(tmp_path):
    (tmp_path / "map.geojson").write_text(shapely.to_geojson(shapely.box(4, 4, 6, 6)))
    np.save(tmp_path / "grid.npy", np.zeros((5, 5)))
    for name in ("map.geojson", "grid.npy"):
        assert call(tmp_path / name, "--start", 0.5, 0.5, "--goal", 4.5, 0.5).exit_code == 0


def test_a_robot_of_ones_own_is_a_json_file(tmp_path):
    (tmp_path / "slow.json").write_text('{"v_max": 0.25}')
    done = call("random:1", "--trajectory", "dp", "--vehicle", tmp_path / "slow.json", "--json")
    trajectory = json.loads(done.stdout)["trajectory"]
    assert trajectory["vehicle"]["name"] == "slow"
    assert max(trajectory["speeds"]) <= 0.25


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("nowhere",), "no scene named 'nowhere'"),
        (("random:x",), "random:SEED"),
        (("ten_obstacles", "--method", "rrx"), "no path planner named 'rrx'"),
        (("ten_obstacles", "--method", "ga", "--fitness", "eq5"), "no fitness named 'eq5'"),
        (("ten_obstacles", "--trajectory", "toppra"), "known: dp, de, ann"),
        (("ten_obstacles", "--start", "9", "3"), "nearest free place"),
        (("ten_obstacles", "--join", "bevel"), "'mitre' or 'round'"),
        (("ten_obstacles", "--vehicle", "tank"), "no vehicle named 'tank'"),
        (("ten_obstacles", "--method", "ga", "--paths", "2"), "--paths is for --method exact"),
        (("ten_obstacles", "--radius", "2", "--start", "2", "2", "--goal", "8", "8"), "grown by 2"),
    ],
)
def test_calls_that_make_no_sense_are_named(arguments, said):
    done = call(*arguments)
    assert isinstance(done.exception, MetaIKError)
    assert said in str(done.exception)


def test_without_shapely_the_extra_is_named():
    script = "import sys; sys.modules['shapely'] = None; import pin_metaik; import pin_metaik.mobile"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert "MissingExtra: planning for mobile robots needs an optional dependency: pip install" in done.stderr
    assert "[mobile]" in done.stderr


def test_the_package_and_its_command_line_do_not_import_shapely():
    script = "import sys, pin_metaik, pin_metaik.cli; assert not {'shapely', 'pin_metaik.mobile'} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", script], check=True)
