import numpy as np
import pinocchio as pin
import pytest

import pin_metaik as mik
from pin_metaik.collision import Box, Obstacle, load_scene, scene_names
from pin_metaik.errors import InvalidSetting
from pin_metaik.ik.clearance.qp import Push
from pin_metaik.ik.clearance.search import ClearSearch
from pin_metaik.ik.state import SearchState
from pin_metaik.optimize import make
from tests.collision.worlds import brute_force, robot_of, world_of
from tests.robots_under_test import chain_of


def free_targets(
    name: str, world: mik.CollisionWorld, count: int, within: float = 0.9, beyond: float = -1.0
) -> list[pin.SE3]:
    """Poses of random configurations free of collisions, ``within`` m of the origin and with x ``beyond``."""
    chain = chain_of(name)
    poses: list[pin.SE3] = []
    for q in chain.q(chain.box.sample(np.random.default_rng(2), 60 * count)):
        (pose,) = chain.placements(q)
        if np.linalg.norm(pose.translation) < within and pose.translation[0] > beyond and not world.in_collision(q):
            poses.append(pose)
    return poses[:count]


@pytest.mark.parametrize("name", ["xarm7", "panda", "ur5"])
def test_every_reachable_target_is_solved_free_of_self_collisions(name: str) -> None:
    world = mik.CollisionWorld(robot_of(name))
    chain = chain_of(name)
    for pose in free_targets(name, world, 50):
        target = mik.Target(pose, position_tolerance=1e-3, orientation_tolerance=1e-2)
        result = mik.solve_ik(chain, target, world=world)
        assert result.success
        assert result.verify()
        assert not brute_force(world, result.q)


@pytest.mark.parametrize("scene", scene_names())
@pytest.mark.parametrize("name", ["panda", "ur5"])
def test_targets_with_a_free_solution_are_solved_in_every_scene(name: str, scene: str) -> None:
    world = world_of(name, scene)
    poses = free_targets(name, world, 30, beyond=0.4)  # where the obstacles are
    results = [mik.solve_ik(chain_of(name), pose, world=world) for pose in poses]
    assert all(result.success and result.verify() for result in results)
    alone = [mik.solve_ik(chain_of(name), result.problem.targets[0].pose) for result in results]
    assert any(world.in_collision(result.q) for result in alone)


def test_the_same_call_gives_the_same_answer() -> None:
    world = world_of("panda", "shelf")
    for pose in free_targets("panda", world, 10):
        a, b = (mik.solve_ik(chain_of("panda"), pose, world=world) for _ in range(2))
        assert (a.q == b.q).all()
        assert a.evaluations == b.evaluations


def test_joints_off_the_chain_stay_and_count() -> None:
    world = world_of("panda", "table")
    chain = chain_of("panda")
    q0 = chain.reference.copy()
    q0[7] = 0.03
    for pose in free_targets("panda", world, 10):
        result = mik.solve_ik(chain, pose, q0, world=world)
        assert result.q[7] == 0.03


def test_a_target_inside_an_obstacle_is_told_at_once_with_names_and_depth() -> None:
    world = world_of("panda", "shelf")
    pose = pin.SE3(pin.utils.rotate("y", np.pi / 2), np.array([0.6, 0.0, 0.45]))
    result = mik.solve_ik(chain_of("panda"), pose, world=world)
    assert result.status is mik.IKStatus.IN_COLLISION
    assert not result.verify()
    assert result.evaluations < 1000
    assert "panda_hand with middle_board" in result.why
    assert result.contacts[0].depth > 0.01


def test_a_target_that_holds_a_finger_in_an_obstacle_is_told_at_once() -> None:
    pose = pin.SE3(pin.utils.rotate("x", np.pi), np.array([0.5, 0.0, 0.3]))
    ball = Obstacle("pin", Box((0.1, 0.004, 0.02)), pose.act(np.array([0.0, 0.0, 0.005])))
    world = mik.CollisionWorld(robot_of("panda"), [ball])
    result = mik.solve_ik(chain_of("panda"), pose, world=world)
    assert result.status is mik.IKStatus.IN_COLLISION
    assert all("finger" in contact.first + contact.second for contact in result.contacts)
    assert result.evaluations < 1000


def test_an_obstacle_around_the_base_is_told_at_once() -> None:
    world = mik.CollisionWorld(robot_of("ur5"), [Obstacle("block", Box((0.3, 0.3, 0.08)), (0.0, 0.0, 0.04))])
    chain = chain_of("ur5")
    for pose in free_targets("ur5", world_of("ur5"), 5):
        result = mik.solve_ik(chain, pose, world=world)
        assert result.status is mik.IKStatus.IN_COLLISION
        assert ("base_link", "block") in {contact[:2] for contact in result.contacts}
        assert result.evaluations < 1000


def test_a_target_no_branch_reaches_freely_is_in_collision_after_all_were_seen() -> None:
    wall = Obstacle("wall", Box((0.02, 4.0, 4.0)), (0.25, 0.0, 0.5))
    pose = pin.SE3(pin.utils.rotate("y", np.pi / 2), np.array([0.6, 0.0, 0.45]))
    result = mik.solve_ik(chain_of("ur5"), pose, world=mik.CollisionWorld(robot_of("ur5"), [wall]))
    assert result.status is mik.IKStatus.IN_COLLISION
    assert result.evaluations < 20_000
    assert result.position_error < 1e-5


def test_what_is_out_of_reach_stays_so() -> None:
    result = mik.solve_ik(chain_of("ur5"), [3.0, 0.0, 0.0], world=world_of("ur5"))
    assert result.status is mik.IKStatus.UNREACHABLE


def test_what_is_grasped_and_the_margin_are_respected() -> None:
    world = mik.CollisionWorld(robot_of("panda"), load_scene("table"), margin=0.02)
    world.attach("pole", Box((0.03, 0.03, 0.3)), "panda_hand_tcp", (0.0, 0.0, 0.1))
    chain = chain_of("panda")
    free = [q for q in chain.q(chain.box.sample(np.random.default_rng(0), 300)) if not world.in_collision(q)][:15]
    for q in free:
        result = mik.solve_ik(chain, chain.placements(q)[0], world=world)
        assert result.success
        assert not world.in_collision(result.q)
        others = {first for first, reason in world.pairs.items() if not reason and "pole" in first}
        assert others  # the pole is checked against the table and the arm


@pytest.mark.parametrize("select", ["nearest", "manipulability", "limits"])
def test_the_chosen_solution_is_free(select: str) -> None:
    world = world_of("ur5", "table")
    solver = mik.IKSolver(select=select)
    for pose in free_targets("ur5", world, 10, within=0.6):
        result = mik.solve_ik(chain_of("ur5"), pose, world=world, solver=solver)
        assert result.success
        assert result.verify()


def test_all_solutions_in_a_world_are_those_free_of_collisions() -> None:
    world, chain = world_of("ur5", "table"), chain_of("ur5")
    for pose in free_targets("ur5", world, 5, within=0.6):
        every, free = mik.solve_ik_all(chain, pose), mik.solve_ik_all(chain, pose, world=world)
        assert len(free) == sum(not world.in_collision(q) for q in every)


def test_a_path_in_a_world_is_free_at_every_pose() -> None:
    world, chain = world_of("ur5", "table"), chain_of("ur5")
    down = pin.utils.rotate("x", np.pi)
    poses = [pin.SE3(down, np.array([0.4, y, 0.3])) for y in np.linspace(-0.1, 0.1, 9)]
    path = mik.solve_ik_path(chain, poses, world=world)
    assert path.continuous
    assert not world.in_collision_batch(path.q).any()


def collided(scene: str, count: int) -> list[tuple[mik.IKProblem, np.ndarray]]:
    """Problems of the Panda with a solution that collides, although a free one exists."""
    world, chain = world_of("panda", scene), chain_of("panda")
    results = [mik.solve_ik(chain, pose) for pose in free_targets("panda", world, 100, beyond=0.3)]
    return [
        (mik.IKProblem.of(chain, result.target, world), result.x)
        for result in results
        if result.success and world.in_collision(result.q)
    ][:count]


def test_pushing_frees_some_and_what_it_calls_free_is() -> None:
    problems = collided("shelf", 12)
    base = chain_of("panda").reference
    pushed = [Push().refine(problem, world_of("panda", "shelf"), x, base, 100) for problem, x in problems]
    assert sum(p.met for p in pushed) >= len(problems) / 5
    for (problem, _), refinement in zip(problems, pushed, strict=True):
        assert problem.accepts(problem.chain.q(refinement.x)) == refinement.met
        assert 1 <= refinement.evaluations <= 100


@pytest.mark.slow
def test_metaheuristic_seeds_alone_find_free_solutions() -> None:
    found = 0
    problems = collided("table", 6)
    for problem, x in problems:
        state = SearchState(problem, mik.Budget(evaluations=50_000), 0.0, x)
        search = ClearSearch(problem, chain_of("panda").reference, state, mik.DLS().descent(), 0)
        free = search.seed(make("mtde"))
        found += free is not None
        assert free is None or problem.accepts(problem.chain.q(free))
        assert state.spent > 0
    assert found >= len(problems) / 3


def test_a_budget_is_kept() -> None:
    wall = Obstacle("wall", Box((0.02, 4.0, 4.0)), (0.25, 0.0, 0.5))
    world = mik.CollisionWorld(robot_of("panda"), [wall])
    pose = pin.SE3(pin.utils.rotate("y", np.pi / 2), np.array([0.6, 0.0, 0.45]))
    result = mik.solve_ik(
        chain_of("panda"), pose, world=world, solver=mik.IKSolver(budget=mik.Budget(evaluations=5_000))
    )
    assert result.status is mik.IKStatus.IN_COLLISION
    assert result.evaluations <= 5_000


def test_another_models_world_is_refused() -> None:
    with pytest.raises(InvalidSetting, match="panda"):
        mik.solve_ik(chain_of("ur5"), [0.3, 0.2, 0.4], world=world_of("panda"))
