"""What goes out to ROS has the shape of nav_msgs/Path, and says where the robot is when."""

import json

import numpy as np
import pytest
import yaml
from numpy.testing import assert_allclose
from typer.testing import CliRunner

from pin_metaik.cli import app
from pin_metaik.errors import InvalidSetting
from pin_metaik.mobile import Path, nav_path, plan_trajectory, shortest_curve, write_nav_path
from tests.mobile.routes import A


def read(message):
    """Times, places and headings of a nav_msgs/Path, with all its keys."""
    rows = []
    assert set(message) == {"header", "poses"}
    for stamped in message["poses"]:
        header, pose = stamped["header"], stamped["pose"]
        assert header["frame_id"] == message["header"]["frame_id"]
        assert isinstance(header["stamp"]["sec"], int)
        assert 0 <= header["stamp"]["nanosec"] < 10**9
        q = pose["orientation"]
        assert q["z"] ** 2 + q["w"] ** 2 == pytest.approx(1, abs=1e-12)
        assert (q["x"], q["y"], pose["position"]["z"]) == (0, 0, 0)
        heading = 2 * np.arctan2(q["z"], q["w"])
        t = header["stamp"]["sec"] + 1e-9 * header["stamp"]["nanosec"]
        rows.append((t, pose["position"]["x"], pose["position"]["y"], heading))
    return np.array(rows).T


def test_a_trajectorys_poses_are_stamped_with_their_times(tmp_path):
    motion = plan_trajectory(A).trajectory
    for name, load in (("path.yaml", yaml.safe_load), ("path.json", json.loads)):
        write_nav_path(tmp_path / name, motion, "odom", stamp=12.25, every=0.2)
        message = load((tmp_path / name).read_text())
        t, x, y, heading = read(message)
        assert message["header"] == {"stamp": {"sec": 12, "nanosec": 250_000_000}, "frame_id": "odom"}
        at = motion.at(t - 12.25)
        assert_allclose((x, y, heading), (at.x, at.y, at.heading), atol=1e-8)  # stamps are whole nanoseconds
        assert t[-1] == pytest.approx(12.25 + motion.duration, abs=1e-9)


def test_polylines_and_curves_have_poses_along_them():
    t, x, y, heading = read(nav_path(Path(A)))
    assert_allclose((x, y), np.array(A).T)
    assert_allclose(heading, [0, np.pi / 2, np.pi / 2])
    assert (t == 0).all()
    curve = shortest_curve((0, 0, 0), (3, 1, 2.0), 0.5)
    _, x, y, heading = read(nav_path(curve))
    assert_allclose((x[-1], y[-1], heading[-1]), (3, 1, 2.0), atol=1e-12)
    assert np.hypot(np.diff(x), np.diff(y)).max() <= 0.05 + 1e-12


def test_what_ros_cannot_take_is_refused(tmp_path):
    with pytest.raises(InvalidSetting, match=r"\.yaml or \.json"):
        write_nav_path(tmp_path / "path.csv", Path(A))
    with pytest.raises(InvalidSetting, match="stamp"):
        nav_path(Path(A), stamp=-1)


def test_the_command_line_writes_it(tmp_path):
    for extra in ((), ("--trajectory", "dp")):
        file = tmp_path / f"{len(extra)}.yaml"
        done = CliRunner().invoke(app, ["plan", "random:1", "--ros", str(file), *extra])
        assert done.exit_code == 0
        t, x, y, _ = read(yaml.safe_load(file.read_text()))
        assert_allclose((x[0], y[0], x[-1], y[-1]), (0.5, 0.5, 9.5, 9.5), atol=1e-8)
        assert (t[-1] > 0) == bool(extra)
    wrong = CliRunner().invoke(app, ["plan", "random:1", "--ros", "path.bag"])
    assert isinstance(wrong.exception, InvalidSetting)
