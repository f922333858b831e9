"""Platforms whose joints are points anywhere, legs with a dead length and a speed."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from typer.testing import CliRunner

from pin_metaik.cli import app
from pin_metaik.errors import InvalidBounds, InvalidGeometry, InvalidTable
from pin_metaik.optimize.pso import PSO
from pin_metaik.stewart import (
    DesignTask,
    Geometry,
    Grid,
    LegLimits,
    Mechanism,
    Ranges,
    all_forward,
    closed_model,
    design,
    draw,
    follow,
    forward,
    jacobian,
    leg_lengths,
    load_mechanism,
    pose_at,
    save_mechanism,
    straight,
    survey,
    to_toml,
)
from tests.stewart.cases import home_poses, reference, stroke


def calibrated(seed=0, apart=0.004):
    """The 6x6 reference as a measuring machine finds it: every joint some millimetres off, and none in a plane."""
    rng = np.random.default_rng(seed)
    geometry = reference().geometry
    b, m = (joints + rng.uniform(-apart, apart, (6, 3)) for joints in (geometry.base_joints, geometry.platform_joints))
    return Geometry.of_joints(b, m, geometry.legs)


def test_points_on_circles_are_the_platform_of_the_circles():
    circles = stroke(100).geometry
    points = Geometry.of_joints(circles.base_joints, circles.platform_joints, circles.legs)
    mixed = replace(circles, platform_radius=0.0, platform_angles=(), platform=points.platform)
    poses = home_poses(20)
    for geometry in (points, mixed):
        assert geometry.type == circles.type
        assert str(geometry) == str(circles)
        assert_allclose(geometry.joint_gap, circles.joint_gap)
        assert_allclose(leg_lengths(geometry, poses), leg_lengths(circles, poses), atol=1e-15)
        assert_allclose(geometry.platform_radius, circles.platform_radius, rtol=0.02)  # B1 ... are not quite even
    grid = Grid((20, 20, 20), (-0.05, 0.05), (-0.05, 0.05), (0.2, 0.27))
    assert (
        survey(points, stroke(100).limits, grid).cells_reached
        == survey(circles, stroke(100).limits, grid).cells_reached
    )


def test_joints_off_every_plane_have_kinematics_in_closed_form_and_by_pinocchio():
    geometry = calibrated()
    poses = home_poses(50)
    lengths = leg_lengths(geometry, poses)
    for T, d in zip(poses, lengths, strict=True):
        v = T[:3, :3] @ np.array(geometry.platform).T + T[:3, 3:] - np.array(geometry.base).T
        assert_allclose(d, np.linalg.norm(v, axis=0), atol=1e-15)
    found = forward(geometry, lengths)
    assert found.solved.all()
    assert_allclose(found.poses, poses, atol=1e-9)
    model = closed_model(replace(reference(), geometry=geometry))
    assert_allclose(model.forward(lengths[0], pose_at((0, 0, 0.37))), poses[0], atol=1e-9)
    assert_allclose(model.rates(poses[1]), jacobian(geometry, poses[1]), atol=1e-10)
    every = all_forward(geometry, lengths[0])
    assert every.complete
    assert np.abs(every.poses - poses[0]).max(axis=(1, 2)).min() < 1e-8


def test_the_workspace_of_joints_anywhere_is_found_however_narrow():
    geometry = calibrated()
    wide = survey(geometry, LegLimits(0.35, 0.47))
    assert_allclose(wide.volume, survey(reference().geometry, LegLimits(0.35, 0.47)).volume, rtol=0.1)
    assert survey(geometry, LegLimits(0.409, 0.411)).cells_reached > 1000


def test_a_file_keeps_points_and_limits_to_the_last_bit(tmp_path):
    mechanism = replace(reference(), geometry=calibrated(), limits=LegLimits(0.35, 0.47, dead_length=0.2, speed=0.05))
    moved = replace(mechanism.geometry, reference=(0.0, 0.0, 0.02))
    ranges = Ranges(base=(((0.2, 0.3), 0.0, (-0.01, 0.01)), *mechanism.geometry.base[1:]), shortest=(0.34, 0.35))
    for one in (
        mechanism,
        replace(mechanism, geometry=moved),
        replace(mechanism, geometry=replace(moved, base_radius=0.0, base=reference().geometry.base_joints)),
        replace(mechanism, task=DesignTask(ranges)),
    ):
        path = save_mechanism(one, tmp_path / "it.toml")
        again = load_mechanism(path)
        assert again == replace(one, geometry=again.geometry)
        assert_allclose(again.geometry.m, one.geometry.m, atol=0)
        assert_allclose(again.geometry.b, one.geometry.b, atol=0)
        assert to_toml(again) == path.read_text()


TABLE = """
name = "by hand"
length = "mm"
angle = "deg"
base = [[250, 0, 10], [-125, 217, 0], [-125, -217, -5]]
[platform]
radius = 100
angles = [60, 180, 300]
[legs]
base = [1, 1, 2, 2, 3, 3]
platform = [3, 1, 1, 2, 2, 3]
shortest = 350
longest = 450
dead_length = 150
speed = 40
"""


def test_a_file_by_hand_mixes_points_and_a_circle(tmp_path):
    path = tmp_path / "it.toml"
    path.write_text(TABLE)
    mechanism = load_mechanism(path)
    assert mechanism.geometry.base[0] == (0.25, 0.0, 0.01)
    assert mechanism.geometry.platform_radius == 0.1
    assert mechanism.limits.speed == 0.04
    shown = CliRunner().invoke(app, ["stewart", "show", str(path)])
    for text in ("B1 at 250, 0, 10 mm", "radius 100 mm, joints at 60, 180, 300 deg", "dead length", "up to 40 mm/s"):
        assert text in shown.output
    ends = ["--pose", "0", "0", "330", "0", "0", "0", "--to", "20", "0", "330", "0", "0", "0"]
    way = CliRunner().invoke(app, ["stewart", "analyse", str(path), *ends, "--cells", "10", "--seconds", "0.2"])
    assert "too fast for the legs: this way takes them" in way.output


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        (("[250, 0, 10], ", "[250, 0], "), InvalidTable, "is not a list of points"),
        (("[250, 0, 10], ", "[250, 0, 'x'], "), InvalidTable, "is not a number"),
        (("[250, 0, 10], ", "[-125, 217, 0], "), InvalidGeometry, "each in a place of its own"),
        (("dead_length = 150", "dead_length = 300"), InvalidGeometry, "it can be 0.4 m"),
        (("dead_length = 150", "dead_lenght = 150"), InvalidTable, "did you mean 'dead_length'"),
        (("speed = 40", "speed = 0"), InvalidGeometry, "speed of the legs is above zero"),
        (("radius = 100", "radius = 100\njoints = [[1, 2, 3]]"), InvalidTable, "unknown key 'radius'"),
    ],
)
def test_files_that_make_no_sense_are_refused_by_name(tmp_path, change, error, message):
    path = tmp_path / "it.toml"
    path.write_text(TABLE.replace(*change))
    with pytest.raises(error, match=message):
        load_mechanism(path)


def test_joints_are_designed_one_by_one():
    start = calibrated(apart=0.03)
    spans = tuple(tuple((value - 0.03, value + 0.03) for value in joint) for joint in start.base)
    task = DesignTask(
        Ranges(base=spans), algorithm=PSO(agents=20), evaluations=400, from_current=True, joint_gap=0.02, seed=1
    )
    mechanism = Mechanism("free", start, LegLimits(0.35, 0.47), task=task)
    before = design(replace(mechanism, task=replace(task, evaluations=1))).score.fitness
    found = design(mechanism)
    assert found.score.fitness > before + 0.005
    joints = np.array(found.mechanism.geometry.base)
    assert (np.abs(joints - np.array(start.base)) <= 0.03 + 1e-12).all()
    assert found.mechanism.geometry.platform == start.platform
    assert found.mechanism.geometry.joint_gap >= 0.02


def test_a_design_may_give_up_a_circle_and_keeps_a_dead_length():
    geometry = stroke(100).geometry
    ranges = Ranges(
        platform=tuple((float(x), float(y), (-0.01, 0.01)) for x, y, _ in geometry.platform_joints),
        longest=(0.3, 0.6),
    )
    limits = LegLimits(0.25, 0.35, dead_length=0.1)
    task = DesignTask(ranges, algorithm=PSO(agents=20), evaluations=200, weights=(0.0, 1.0), cube=0.2)
    found = design(Mechanism("x", geometry, limits, task=task))
    assert found.success
    assert found.mechanism.geometry.platform is not None
    assert found.mechanism.geometry.base_angles == geometry.base_angles
    assert 0.36 < found.mechanism.limits.longest <= 0.4  # as long as bodies of 250 mm and 100 mm of dead length allow


def test_ranges_for_a_circle_do_not_fit_joints_anywhere():
    task = DesignTask(Ranges(base_radius=(0.2, 0.3)))
    with pytest.raises(InvalidBounds, match="the joints of the base are points: give base ranges"):
        design(Mechanism("x", calibrated(), LegLimits(0.35, 0.47), task=task))
    task = DesignTask(Ranges(base=((0.0, 0.0, (0.0, 0.1)),)))
    with pytest.raises(InvalidBounds, match="base has 1 ranges for 6 joints"):
        design(Mechanism("x", calibrated(), LegLimits(0.35, 0.47), task=task))
    with pytest.raises(InvalidBounds, match="x, y, z of each joint"):
        Ranges(base=((0.0, 1.0),))


def test_points_and_a_circle_for_one_side_are_refused():
    circles = stroke(100).geometry
    with pytest.raises(InvalidGeometry, match="as points or by base_radius and base_angles, not both"):
        replace(circles, base=circles.base_joints)
    with pytest.raises(InvalidGeometry, match="not both"):
        replace(calibrated(), platform_radius=0.3)
    with pytest.raises(InvalidGeometry, match="give legs: pairs of one of 6 base and one of 3 platform joints"):
        Geometry.of_joints(calibrated().base, circles.platform_joints)
    with pytest.raises(InvalidGeometry, match="base"):
        Geometry.of_joints([[0, 0, np.nan]] * 3, circles.platform_joints)


def test_legs_are_as_fast_as_they_may_be():
    geometry = calibrated()
    ends = pose_at((0, 0, 0.36)), pose_at((0.03, 0, 0.38), (0.1, 0, 0))
    limits = LegLimits(0.35, 0.47, speed=0.05)
    slow = follow(geometry, straight(*ends, 10.0), limits)
    assert not slow.too_fast.any()
    quick = follow(geometry, straight(*ends, slow.least_seconds), limits)
    assert not quick.too_fast.any()
    assert_allclose(np.abs(quick.rates).max(), 0.05)
    assert follow(geometry, straight(*ends, 0.9 * slow.least_seconds), limits).too_fast.any()
    assert follow(geometry, straight(*ends, 1.0)).least_seconds is None


def test_joints_anywhere_are_drawn_without_circles(tmp_path):
    pytest.importorskip("matplotlib")
    mechanism = replace(reference(), geometry=calibrated())
    with_circles, without = (len(draw(one).axes[0].lines) for one in (reference(), mechanism))
    assert with_circles == without  # the circles are there, empty
    assert len(draw(mechanism).axes[0].lines[0].get_data_3d()[0]) == 0
