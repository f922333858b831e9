"""Avoid collisions: a world of the robot, obstacles and what it holds, and solutions that keep clear of all.

python examples/10_avoid_collisions.py [picture.png]
"""

import sys

import numpy as np
import pinocchio as pin

import pin_metaik as mik
from pin_metaik.collision import Box, Obstacle, load_scene, save_world


def main() -> None:
    robot = mik.load_robot("panda")
    chain = mik.Chain(robot.model, robot.frame)
    world = mik.CollisionWorld(robot, load_scene("shelf"), margin=0.005)  # m; a name, or a .toml of your own
    print(world)

    forward = pin.utils.rotate("y", np.pi / 2)
    on_the_board = pin.SE3(forward, np.array([0.68, -0.25, 0.6]))
    alone = mik.solve_ik(chain, on_the_board)
    print("\nwithout the world:", "; ".join(map(str, world.pairs_in_collision(alone.q))) or "no collision, by luck")
    result = mik.solve_ik(chain, on_the_board, world=world)
    nearest = world.min_distance(result.q)
    print(f"in the world:      {result}")
    print(f"                   nearest: {nearest.first} and {nearest.second}, {1e3 * nearest.distance:.1f} mm apart")

    print("\nA target inside a board is told at once:")
    print("  ", mik.solve_ik(chain, pin.SE3(forward, np.array([0.6, 0.0, 0.45])), world=world).why)

    # Obstacles come, move and go; what is grasped moves with its frame.
    world.add(Obstacle("book", Box((0.15, 0.03, 0.2)), (0.65, -0.2, 0.56)))
    world.move("book", (0.65, 0.1, 0.56))
    world.attach("cup", Box((0.06, 0.06, 0.1)), "panda_hand_tcp", (0.0, 0.0, 0.03))
    result = mik.solve_ik(chain, on_the_board, world=world)
    print(f"\nwith a cup in the hand, next to a book: {result}")
    world.detach("cup", result.q)  # it stays where it is, as an obstacle
    print("left behind:", ", ".join(obstacle.name for obstacle in world.obstacles))

    # Which pairs of links are checked is yours to read and to change.
    reasons = [reason or "checked" for pair, reason in world.pairs.items() if all("panda" in name for name in pair)]
    print("\npairs of links:", ", ".join(f"{reasons.count(reason)} {reason}" for reason in sorted(set(reasons))))

    if len(sys.argv) > 1:  # faint: the solution that collides; opaque: the one that does not
        save_world(sys.argv[1], world, [alone.q, result.q], [on_the_board])


if __name__ == "__main__":
    main()
