"""Workspaces of platforms moved by servos, against numpy and nothing else."""

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from pin_metaik.errors import InvalidGeometry
from pin_metaik.stewart import (
    EmptyWorkspace,
    Geometry,
    Grid,
    PoseState,
    ServoLimits,
    Servos,
    Trajectory,
    conditioning,
    crossings,
    follow,
    inverse,
    judge_poses,
    leg_distances,
    load_mechanism,
    pose_at,
    singularities,
    straight,
    survey,
    transmission,
)
from pin_metaik.stewart.workspace.cells import room
from tests.stewart.cases import general_servos, servo_platforms, some_poses

PLATFORMS = servo_platforms()
LOOSE = ServoLimits(-np.pi, np.pi)
HOME = (0.0, 0.0, 0.12)


def by_numpy(geometry, limits, poses):
    """What is reached, from the angles and rods of ``inverse`` and the limits as they are described."""
    links, servos = inverse(geometry, poses), geometry.servos
    q, rods = links.coordinates, links.vectors / np.linalg.norm(links.vectors, axis=-1, keepdims=True)
    inside = links.reached & ((q >= limits.lowest) & (q <= limits.highest)).all(axis=1)
    u, w, a = (servos.frames[:, row] for row in range(3))
    c, s = np.cos(q)[..., None], np.sin(q)[..., None]
    horn, way = c * u + s * w, c * w - s * u
    at_base = np.broadcast_to(servos.branches, 6)[:, None] * way
    at_platform = np.broadcast_to(-poses[:, None, :3, 2], rods.shape)
    if limits.home is not None:
        home = inverse(geometry, pose_at(limits.home))
        z = home.vectors[0] / np.linalg.norm(home.vectors[0], axis=-1, keepdims=True)
        c0, s0 = np.cos(home.coordinates[0])[:, None], np.sin(home.coordinates[0])[:, None]
        parts = [(z * axis).sum(axis=-1)[:, None] for axis in (c0 * u + s0 * w, c0 * w - s0 * u, a)]
        at_base = parts[0] * horn + parts[1] * way + parts[2] * a
        at_platform = -z @ poses[:, :3, :3].transpose(0, 2, 1)
    inside &= ((rods * at_base).sum(axis=-1) >= np.cos(limits.base_angle) - 1e-15).all(axis=1)
    inside &= ((-rods * at_platform).sum(axis=-1) >= np.cos(limits.platform_angle) - 1e-15).all(axis=1)
    return inside & (leg_distances(geometry, poses) >= limits.distance).all(axis=1)


@pytest.mark.parametrize("platform", PLATFORMS)
@pytest.mark.parametrize(
    "limits",
    [
        LOOSE,
        ServoLimits(-1.2, 0.9),
        ServoLimits(-1.0, 1.4, base_angle=0.7),
        ServoLimits(-1.4, 1.4, platform_angle=0.5),
        ServoLimits(-1.4, 1.4, base_angle=0.8, platform_angle=0.6, home=HOME),
        ServoLimits(-1.5, 1.5, distance=0.003),
    ],
    ids=str,
)
def test_poses_are_reached_as_numpy_says(platform, limits):
    geometry = PLATFORMS[platform]
    poses = some_poses(4000, HOME, (0.03, 0.03, 0.03), 0.25, 1)
    states = judge_poses(geometry, limits, poses)
    reached = (states >= PoseState.POSITIVE) & (states <= PoseState.SINGULAR)
    expected = by_numpy(geometry, limits, poses)
    assert_array_equal(reached, expected)
    assert 0 < expected.sum() < len(poses)
    missing = inverse(geometry, poses).missing
    assert ((states == PoseState.TOO_LONG) <= (missing > 0.0).any(axis=1)).all()
    assert ((states == PoseState.TOO_SHORT) <= (missing < 0.0).any(axis=1)).all()


@pytest.mark.parametrize("platform", PLATFORMS)
def test_a_survey_judges_as_poses_are_judged(platform):
    geometry, limits = PLATFORMS[platform], ServoLimits(-1.3, 1.2, base_angle=0.8, distance=0.004)
    grid = Grid((14, 14, 14), steps=(3, 1, 2), roll=(-0.2, 0.2), yaw=(-0.1, 0.3))
    found = survey(geometry, limits, grid)
    poses = found.poses(np.ones_like(found.reached))
    assert_array_equal(found.states.ravel(), judge_poses(geometry, limits, poses))
    assert_allclose(found.nu[found.regular], conditioning(geometry, found.poses(found.regular)), rtol=1e-9)


@pytest.mark.parametrize("platform", PLATFORMS)
@pytest.mark.parametrize("span", [(-np.pi, np.pi), (-1.2, 1.0), (-0.1, 0.05), (0.5, 0.6)], ids=str)
def test_the_room_of_servos_holds_all_that_is_reached(platform, span):
    geometry, limits = PLATFORMS[platform], ServoLimits(*span)
    box = room(Grid(), geometry, limits)
    poses = some_poses(60_000, HOME, (0.08, 0.08, 0.05), 0.0, 2)
    states = judge_poses(geometry, limits, poses)
    reached = poses[(states >= PoseState.POSITIVE) & (states <= PoseState.SINGULAR), :3, 3]
    assert (box is None) == (platform == "general" and span[1] - span[0] < 1.0)  # its servos agree on no such angle
    assert len(reached) == 0 or ((reached >= box[0]) & (reached <= box[1])).all()


def test_servos_that_hardly_move_have_a_workspace_as_narrow():
    geometry = load_mechanism("servo_sg90").geometry
    for half in (0.1, 0.01, 0.001):
        found = survey(geometry, ServoLimits(-half, half))
        assert found.cells_reached > 200
        q = inverse(geometry, found.poses(found.reached)).coordinates
        assert np.abs(q).max() <= half
        finer = survey(geometry, ServoLimits(-half, half), Grid((60, 60, 60)))
        assert_allclose(found.volume, finer.volume, rtol=0.05)


def test_where_no_rod_reaches_is_proved_empty():
    geometry = load_mechanism("servo_sg90").geometry
    long = replace(geometry, servos=replace(geometry.servos, rod=0.01, horn=0.002))
    with pytest.raises(EmptyWorkspace) as error:
        survey(long, LOOSE)
    assert error.value.room is None
    with pytest.raises(InvalidGeometry, match=r"at home the rod of leg \d is .* m too short"):
        survey(geometry, ServoLimits(-1, 1, base_angle=0.5, home=(0, 0, 0.3)))


def test_the_other_branch_has_another_workspace():
    geometry = load_mechanism("servo_sg90").geometry
    other = replace(geometry, servos=replace(geometry.servos, branches=-1))
    up, down = (survey(each, LOOSE) for each in (geometry, other))
    assert_allclose(up.volume, down.volume)  # every rod has both, but not within the same angles
    q = inverse(other, down.poses(down.reached))
    assert (q.pushes < 0.0).all()
    assert survey(geometry, ServoLimits(-1.4, 1.4)).volume > 0.0
    with pytest.raises(EmptyWorkspace, match="beyond the angle of a servo"):
        survey(
            other,
            ServoLimits(-1.4, 1.4),
            Grid(
                (20, 20, 20),
                *[tuple(ends) for ends in (up.cells.xs[[0, -1]], up.cells.ys[[0, -1]], up.cells.zs[[0, -1]])],
            ),
        )


def test_singularities_of_both_kinds_are_told_apart():
    geometry = general_servos(1)
    found = survey(geometry, LOOSE, Grid((20, 20, 20)))
    seen = singularities(found)
    every = transmission(geometry, found.poses(found.reached)).min(axis=1)
    assert seen.transmission == every.min()
    assert_allclose(transmission(geometry, seen.weakest).min(), every.min())
    # turned by a right angle the rods no longer hold a platform of one plane: the second kind, at full transmission
    flat = load_mechanism("servo_esp32").geometry
    way = straight(pose_at((0, 0, 0.13)), pose_at((0, 0, 0.09), (0, 0, 2.2)), 1.0, 201)
    reached = follow(flat, way).states <= PoseState.SINGULAR
    last = int(np.flatnonzero(reached).max())
    part = Trajectory(way.times[: last + 1], way.poses[: last + 1], way.twists[: last + 1])
    for crossing in crossings(flat, part):
        assert conditioning(flat, crossing.pose) < 1e-6


def test_a_way_out_of_reach_is_followed_and_told():
    mechanism = load_mechanism("servo_sg90")
    way = straight(pose_at((0, 0, 0.115)), pose_at((0, 0, 0.15)), 2.0)
    motion = follow(mechanism.geometry, way, replace(mechanism.limits, speed=1.0))
    assert motion.states[0] == PoseState.POSITIVE
    assert motion.states[-1] == PoseState.TOO_LONG
    assert np.isnan(motion.coordinates[-1]).all()
    assert np.isfinite(motion.fastest)
    assert motion.least_seconds == pytest.approx(2.0 * motion.fastest)
    assert all(crossing.time < 2.0 for crossing in crossings(mechanism.geometry, way))
    k = np.flatnonzero(motion.reached)[5:-12]
    slopes = np.gradient(motion.coordinates, way.times, axis=0)
    assert_allclose(motion.rates[k], slopes[k], atol=0.02 * np.abs(motion.rates[k]).max())


def random_platform(rng):
    """A platform of servos with axes anywhere, some vertical, a pose that its rods reach, and the angles there."""
    base = np.column_stack((rng.uniform(-0.2, 0.2, (6, 2)), rng.uniform(-0.05, 0.05, 6)))
    moving = np.column_stack((rng.uniform(-0.12, 0.12, (6, 2)), rng.uniform(-0.03, 0.03, 6)))
    pose = pose_at((*rng.uniform(-0.05, 0.05, 2), rng.uniform(0.08, 0.2)), rng.uniform(-0.5, 0.5, 3))
    q, horn = rng.uniform(-2.5, 2.5, 6), rng.uniform(0.02, 0.09, 6)
    axes = rng.standard_normal((6, 3))
    axes[: rng.integers(4), :2] = 0.0
    servos = Servos(tuple(horn), 0.1, axes=axes, zeros=rng.standard_normal((6, 3)))
    u, w, _ = servos.frames.transpose(1, 0, 2)
    c, s = np.cos(q)[:, None], np.sin(q)[:, None]
    rods = pose[:3, 3] + moving @ pose[:3, :3].T - base - horn[:, None] * (c * u + s * w)
    branches = np.sign((rods * (c * w - s * u)).sum(axis=1)).astype(int)
    servos = replace(servos, rod=tuple(np.linalg.norm(rods, axis=1)), branches=tuple(branches))
    return Geometry.of_joints(base, moving, servos=servos), pose, q


def test_laws_of_servos_hold_whatever_their_axes():
    rng = np.random.default_rng(5)
    for _ in range(25):
        geometry, pose, q = random_platform(rng)
        assert_allclose(inverse(geometry, pose).coordinates[0], q, atol=1e-6)
        limits = ServoLimits(max(-np.pi, q.min() - rng.uniform(0, 1)), min(np.pi, q.max() + rng.uniform(0, 1)))
        poses = np.array([pose, *(pose @ some_poses(1000, (0.0, 0.0, 0.0), (0.02, 0.02, 0.02), 0.2, rng.integers(99)))])
        links, states = inverse(geometry, poses), judge_poses(geometry, limits, poses)
        reached = (states >= PoseState.POSITIVE) & (states <= PoseState.SINGULAR)
        inside = ((links.coordinates >= limits.lowest) & (links.coordinates <= limits.highest)).all(axis=1)
        assert_array_equal(reached, links.reached & inside)
        assert reached[0]
        rods = np.linalg.norm(links.vectors[links.reached], axis=-1)
        assert_allclose(rods, np.broadcast_to(geometry.servos.rod, rods.shape), atol=1e-12, rtol=0)
        level = np.tile(pose, (4000, 1, 1))
        level[1:, :3, 3] += rng.uniform(-0.05, 0.05, (3999, 3))
        states = judge_poses(geometry, limits, level)
        places = level[(states >= PoseState.POSITIVE) & (states <= PoseState.SINGULAR), :3, 3]
        turn = {
            name: (angle, angle)
            for name, angle in zip(("roll", "pitch", "yaw"), pin.rpy.matrixToRpy(pose[:3, :3]), strict=True)
        }
        box = room(Grid(z=(-1.0, 1.0), **turn), geometry, limits)
        assert ((places >= box[0] - 1e-12) & (places <= box[1] + 1e-12)).all()
