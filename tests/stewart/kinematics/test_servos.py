"""Platforms moved by servos: their inverse and forward kinematics, and their rates."""

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

from pin_metaik.errors import InvalidConfiguration, InvalidGeometry, InvalidSetting, InvalidTarget
from pin_metaik.stewart import (
    Geometry,
    LegLimits,
    ServoLimits,
    all_forward,
    closed_model,
    conditioning,
    forward,
    homogenised,
    inverse,
    jacobian,
    judge_poses,
    leg_distances,
    leg_vectors,
    load_mechanism,
    pose_at,
    survey,
    transmission,
    velocity_equation,
)
from pin_metaik.stewart.platform.servos import each
from tests.stewart.cases import general_servos, reference, servo_platforms, servo_poses

PLATFORMS = servo_platforms()
BRANCHES = (1, -1, (1, -1, 1, -1, -1, 1))


@pytest.fixture(params=PLATFORMS)
def platform(request) -> Geometry:
    return PLATFORMS[request.param]


def moved(pose, twist):
    """A pose moved by a small twist (v of P, omega) in the base frame."""
    out = pose.copy()
    out[:3, 3] += twist[:3]
    out[:3, :3] = pin.exp3(twist[3:]) @ pose[:3, :3]
    return out


def derivative(f, x, h):
    """f'(x) by five points."""
    return (8.0 * (f(x + h) - f(x - h)) - (f(x + 2 * h) - f(x - 2 * h))) / (12.0 * h)


@pytest.mark.parametrize("branches", BRANCHES)
def test_rods_keep_their_lengths(platform, branches):  # N21
    poses = servo_poses(10_000, platform)
    q = inverse(platform, poses, branches).coordinates
    assert not np.isnan(q).any()
    servos = platform.servos
    horns = np.cos(q)[..., None] * servos.frames[:, 0] + np.sin(q)[..., None] * servos.frames[:, 1]
    tips = platform.b + each(servos, "horn")[:, None] * horns
    ends = platform.b + leg_vectors(platform, poses)
    assert_allclose(np.linalg.norm(ends - tips, axis=-1), np.broadcast_to(servos.rod, q.shape), atol=1e-12, rtol=0)


@pytest.mark.parametrize("branches", BRANCHES)
def test_forward_of_inverse_is_the_pose_on_either_branch(platform, branches):  # N21
    poses = servo_poses(10_000, platform)
    start = poses @ pose_at((0.002, -0.001, 0.001), (0.02, 0.01, -0.02))
    found = forward(platform, inverse(platform, poses, branches).coordinates, start)
    assert found.solved.all()
    assert_allclose(found.poses, poses, atol=1e-9, rtol=0)


def test_the_two_branches_are_two_and_push_opposite_ways(platform):
    poses = servo_poses(100, platform)
    up, down = (inverse(platform, poses, branch) for branch in (1, -1))
    assert (np.abs(up.coordinates - down.coordinates) > 0.1).all()
    assert (up.pushes > 0.0).all()
    assert_allclose(down.pushes, -up.pushes)
    own = np.broadcast_to(platform.servos.branches, 6)
    each = np.where(own > 0, up.coordinates, down.coordinates)
    assert_allclose(inverse(platform, poses).coordinates, each)


@pytest.mark.parametrize(
    ("name", "height", "level"), [("servo_esp32", 0.132943591247488, 1e-7), ("servo_sg90", 0.115, 0.027)]
)
def test_at_their_makers_home_heights_horns_are_level(name, height, level):
    q = inverse(load_mechanism(name).geometry, pose_at((0, 0, height))).coordinates
    assert np.abs(q).max() < level  # the second maker rounds his height to a millimetre


def test_with_level_horns_a_platform_is_as_high_as_its_maker_says():
    found = forward(load_mechanism("servo_esp32").geometry, np.zeros(6)).pose
    assert_allclose(found, pose_at((0, 0, 0.132943591247488)), atol=1e-12)


def test_angles_are_those_that_a_search_along_the_arc_finds(platform):
    servos, pose = platform.servos, servo_poses(1, platform, 3)[0]
    ends = leg_vectors(platform, pose)[0]
    angles = np.linspace(-np.pi, np.pi, 20_001)
    for leg in range(6):
        (u, w, _), horn, rod = servos.frames[leg], each(servos, "horn")[leg], each(servos, "rod")[leg]
        tips = horn * (np.outer(np.cos(angles), u) + np.outer(np.sin(angles), w))
        over = np.linalg.norm(ends[leg] - tips, axis=1) - rod
        k = np.flatnonzero(over[:-1] * over[1:] < 0.0)
        crossed = angles[k] - over[k] * (angles[k + 1] - angles[k]) / (over[k + 1] - over[k])
        both = sorted(float(inverse(platform, pose, branch).coordinates[0, leg]) for branch in (1, -1))
        assert_allclose(both, crossed, atol=1e-6)


def test_a_rod_that_does_not_reach_is_named_with_what_is_missing():
    geometry = load_mechanism("servo_sg90").geometry
    level = inverse(geometry, pose_at((0, 0, 0.115)))
    assert level.reached.all()
    assert level.why == ""
    far = inverse(geometry, pose_at((0, 0, 0.16), (0, 0.2, 0)))
    assert not far.reached.any()
    leg, missing = int(far.missing[0].argmax()), far.missing[0].max()
    assert far.why == f"the rod of leg {leg + 1} is {missing:.6g} m too short"
    assert np.isnan(far.coordinates[0, leg])
    assert_allclose(np.linalg.norm(far.vectors[0, leg]) - geometry.servos.rod, missing, atol=1e-12)
    near = inverse(geometry, pose_at((0, 0, 0.05)))
    assert "too long" in near.why
    assert_allclose(geometry.servos.rod - np.linalg.norm(near.vectors, axis=-1), -near.missing, atol=1e-12)
    with pytest.raises(InvalidTarget, match="the legs do not reach this pose: the rod of leg"):
        closed_model(load_mechanism("servo_sg90")).configuration(pose_at((0, 0, 0.05)))


def test_rates_are_the_derivative_of_the_angles(platform):
    for pose in servo_poses(20, platform, 1):
        J = jacobian(platform, pose)
        for column, h in enumerate((1e-4, 1e-4, 1e-4, 1e-3, 1e-3, 1e-3)):
            way = np.eye(6)[column]
            along = derivative(
                lambda x, way=way, pose=pose: inverse(platform, moved(pose, x * way)).coordinates[0], 0, h
            )
            assert_allclose(J[:, column], along, atol=1e-7 * np.abs(J).max())


def test_the_twist_of_given_rates_is_the_derivative_of_forward_kinematics(platform):
    pose = servo_poses(1, platform, 2)[0]
    q = inverse(platform, pose).coordinates[0]
    twists = np.linalg.inv(jacobian(platform, pose))
    for leg in range(6):

        def at(x, leg=leg):
            return forward(platform, q + x * np.eye(6)[leg], pose).pose

        slope = derivative(at, 0.0, 1e-3)
        omega = slope[:3, :3] @ pose[:3, :3].T
        assert_allclose(slope[:3, 3], twists[:3, leg], atol=1e-9)
        assert_allclose([omega[2, 1], omega[0, 2], omega[1, 0]], twists[3:, leg], atol=1e-8)


def test_pinocchio_closes_the_loops_where_the_angles_say_and_moves_them_as_the_jacobian_says(platform):
    mechanism = replace(load_mechanism("servo_sg90"), geometry=platform, limits=ServoLimits(-3.0, 3.0))
    closed = closed_model(mechanism)
    for pose in servo_poses(3, platform, 4):
        q = closed.configuration(pose)
        assert_allclose(closed.residual(q)[0], 0.0, atol=1e-12)
        J = jacobian(platform, pose)
        assert_allclose(closed.rates(pose), J, atol=1e-10 * np.abs(J).max())
        start = pose @ pose_at((0.001, 0, 0), (0.01, 0, 0))
        assert_allclose(closed.forward(inverse(platform, pose).coordinates[0], start), pose, atol=1e-9)


def test_dexterity_is_that_of_the_jacobian_by_numpy(platform):
    poses = servo_poses(50, platform, 5)
    J = homogenised(platform, poses)
    by_numpy = 6.0 / np.sqrt([np.trace(j @ j.T) * np.trace(np.linalg.inv(j @ j.T)) for j in J])
    assert_allclose(conditioning(platform, poses), by_numpy, rtol=1e-9)


def test_every_assembly_has_its_rods_and_the_pose_is_among_them():
    for geometry in PLATFORMS.values():
        pose = servo_poses(1, geometry, 6)[0]
        q = inverse(geometry, pose).coordinates[0]
        found = all_forward(geometry, q)
        assert found.complete
        assert np.abs(found.poses - pose).max(axis=(1, 2)).min() < 1e-9
        starts, rods = geometry.actuation.held(geometry.b, q[None])
        ends = geometry.b + leg_vectors(geometry, found.poses)
        assert_allclose(np.linalg.norm(ends - starts, axis=-1), np.broadcast_to(rods, (len(found), 6)), atol=1e-12)
        both = [inverse(geometry, found, branch).coordinates for branch in (1, -1)]
        nearer = np.minimum(*(np.abs((angles - q + np.pi) % (2 * np.pi) - np.pi) for angles in both))
        assert_allclose(nearer, 0.0, atol=1e-6)


def test_where_a_rod_is_in_line_with_its_horn_the_branches_meet_and_nothing_is_transmitted():
    geometry = load_mechanism("servo_sg90").geometry

    def tilted(height):
        return pose_at((0.01, 0.0, height), (0.03, 0.02, 0.0))

    low, high = 0.115, 0.2  # the height at which the platform is as high as its rods let it
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if inverse(geometry, tilted(middle)).reached.all() else (low, middle)
    up, down = (inverse(geometry, tilted(low), branch).coordinates for branch in (1, -1))
    leg = int(np.abs(up - down).argmin())
    assert abs(up - down)[0, leg] < 1e-6
    assert transmission(geometry, tilted(low))[leg] < 1e-6
    assert conditioning(geometry, tilted(low)) < 1e-5


def test_the_velocity_equation_holds_for_slides_and_servos(platform):
    pose = servo_poses(1, platform, 8)[0]
    A, B = velocity_equation(platform, pose)
    assert_allclose(A, B[:, None] * jacobian(platform, pose), atol=1e-12)
    shares = transmission(platform, pose)
    assert ((shares > 0.0) & (shares <= 1.0)).all()
    A, B = velocity_equation(reference().geometry, pose_at((0, 0, 0.37)))
    assert_allclose(A, jacobian(reference().geometry, pose_at((0, 0, 0.37))))
    assert (B == 1.0).all()
    assert (transmission(reference().geometry, pose_at((0, 0, 0.37))) == 1.0).all()


def test_distances_are_between_rods(platform):
    pose = servo_poses(1, platform, 9)[0]
    links = inverse(platform, pose)
    s = np.linspace(0.0, 1.0, 201)[:, None]
    for (i, j), distance in zip(platform.pairs, leg_distances(platform, pose), strict=True):
        one, two = (links.starts[0, leg] + s * links.vectors[0, leg] for leg in (i, j))
        by_points = np.linalg.norm(one[:, None] - two[None], axis=-1).min()
        assert distance <= by_points + 1e-12
        assert by_points < distance + 0.001


def test_limits_and_branches_of_the_other_kind_are_refused():
    servos, slides = load_mechanism("servo_sg90"), reference()
    with pytest.raises(InvalidGeometry, match="legs that are servos have ServoLimits, got LegLimits"):
        survey(servos.geometry, LegLimits(0.1, 0.2))
    with pytest.raises(InvalidGeometry, match="legs that are linear actuators have LegLimits, got ServoLimits"):
        judge_poses(slides.geometry, ServoLimits(-1, 1), np.eye(4))
    with pytest.raises(InvalidGeometry, match="legs that are servos have ServoLimits"):
        replace(servos, limits=LegLimits(0.1, 0.2))
    with pytest.raises(InvalidSetting, match="linear actuators have no branches"):
        inverse(slides.geometry, np.eye(4), 1)
    with pytest.raises(InvalidGeometry, match="branches of servos are 1 or -1, got 2"):
        inverse(servos.geometry, np.eye(4), 2)
    with pytest.raises(InvalidConfiguration, match=r"servo angles have shape \(6,\)"):
        forward(servos.geometry, [0.0] * 5)
    with pytest.raises(InvalidConfiguration, match="servo angles are finite"):
        forward(servos.geometry, [np.nan] * 6)


def test_fewer_servos_leave_freedoms():
    three = general_servos(1)
    geometry = Geometry.of_joints(
        three.base[::2],
        three.platform[::2],
        servos=replace(three.servos, horn=0.02, rod=0.12, axes=three.servos.axes[::2], zeros=None),
    )
    pose = pose_at((0.0, 0.0, 0.115))
    links = inverse(geometry, pose)
    assert links.reached.all()
    found = forward(geometry, links.coordinates[0], pose @ pose_at((0.001, 0, 0)))
    assert found.solved.all()
    assert_allclose(inverse(geometry, found.pose).coordinates, links.coordinates, atol=1e-9)
