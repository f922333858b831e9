"""Pick a box from a shelf: approach, grasp and retreat, with nothing touched at the poses or between them.

python examples/13_shelf_pick.py [picture.png]
"""

import sys
from pathlib import Path

import numpy as np
import pinocchio as pin
from matplotlib.figure import Figure

import pin_metaik as mik
from pin_metaik.collision import Box, Obstacle, draw_world, load_scene

FORWARD = pin.utils.rotate("y", np.pi / 2)
BOX, PLACE = Box((0.05, 0.05, 0.12)), np.array([0.66, 0.12, 0.522])  # m; it stands on the middle board
STEPS = 40


def straight(begin: np.ndarray, end: np.ndarray, turn: np.ndarray) -> list[pin.SE3]:
    """Poses along a line, as close as a path needs them."""
    return [pin.SE3(turn, begin + share * (end - begin)) for share in np.linspace(0.0, 1.0, STEPS)]


def main() -> None:
    picture = Path(sys.argv[1] if len(sys.argv) > 1 else "shelf_pick.png")
    robot = mik.load_robot("panda")
    chain = mik.Chain(robot, "panda_hand_tcp")
    world = mik.CollisionWorld(robot, [*load_scene("shelf"), Obstacle("box", BOX, PLACE, touching=["panda_hand"])])

    # Which of several grasps, turned about the vertical: the first that has a free answer.
    fingers = [f"panda_{side}finger" for side in ("left", "right")]
    for finger in fingers:
        world.allow("box", finger, "grasped")
    turns = [pin.utils.rotate("z", yaw) @ FORWARD for yaw in (-0.6, -0.3, 0.0, 0.3)]
    open_hand = chain.reference.copy()
    open_hand[-1] = 0.035  # m, each finger; they stay so, as the chain does not move them
    choice = mik.solve_ik_any(chain, [pin.SE3(turn, PLACE) for turn in turns], open_hand, world=world)
    print(choice)
    turn = turns[choice.index]

    # In front of the shelf, in to the box, and out again with it in the hand.
    before = PLACE - 0.22 * turn[:, 2]
    approach = mik.solve_ik_path(chain, straight(before, PLACE, turn), open_hand, max_step=0.1, world=world)
    print(f"approach: {approach.continuous}, {len(approach.q)} poses in {approach.seconds:.2f} s {approach.why}")
    grasp = approach.q[-1]
    world.remove("box")
    tip = chain.placements(grasp)[0]
    touching = ["middle_board", "panda_hand", *fingers]  # it stands on the board until it is lifted
    world.attach("box", BOX, "panda_hand_tcp", tip.inverse() * pin.SE3(np.eye(3), PLACE), touching=touching)
    lift = PLACE + np.array([0.0, 0.0, 0.03])
    out = [*straight(PLACE, lift, turn)[::4], *straight(lift, lift - 0.22 * turn[:, 2], turn)]
    retreat = mik.solve_ik_path(chain, out, grasp, max_step=0.1, world=world)
    print(f"retreat:  {retreat.continuous}, {len(retreat.q)} poses in {retreat.seconds:.2f} s {retreat.why}")

    # What happens between the poses is proved, too: every step of both ways.
    for name, path in (("approach", approach), ("retreat", retreat)):
        moves = world.first_contact_batch(path.q[:-1], path.q[1:])
        print(f"{name}: {sum(map(bool, moves))} of {len(moves)} steps are free once more, with the box in the hand")
    home = approach.q[0]
    print("straight back to where it began:", world.first_contact(retreat.q[-1], home))

    figure = Figure(figsize=(12, 6), layout="constrained")
    for k, (title, Q) in enumerate((("approach", approach.q[:: STEPS - 1]), ("retreat", retreat.q[:: len(out) - 1]))):
        axes = figure.add_subplot(1, 2, k + 1, projection="3d")
        draw_world(axes, world if k else without(world, "box"), Q)
        axes.set_title(title)
        axes.view_init(elev=22, azim=-125)
    figure.savefig(picture, dpi=110, bbox_inches="tight", pad_inches=0.15)  # labels of z stick out
    print(picture)


def without(world: mik.CollisionWorld, name: str) -> mik.CollisionWorld:
    """The same world with a box where it was before it was grasped."""
    empty = mik.CollisionWorld(world.robot, world.obstacles)
    empty.add(Obstacle(name, BOX, PLACE))
    return empty


if __name__ == "__main__":
    main()
