"""Screen grasps on a shelf: which can be done, and why each of the others cannot.

python examples/12_screen_grasps.py [number of grasps] [picture.png]
"""

import re
import sys
from collections import Counter
from pathlib import Path

import numpy as np
import pinocchio as pin
from matplotlib.figure import Figure
from numpy.typing import NDArray

import pin_metaik as mik
from pin_metaik.collision import load_scene

ROBOTS = "panda", "ur5"
BOARDS = (0.16, 0.46)  # m; the tops of the two boards that things stand on
APPROACHES = 5  # grasps of one object
SHOWN = 4  # reasons of each status
NUMBER = re.compile(r"(?<![\w.])-?\d[\d,]*(\.\d+)?(e-?\d+)?(?!\w)")
COLOURS = {
    "SOLVED": "tab:green",
    "IN_COLLISION": "tab:red",
    "UNREACHABLE": "tab:blue",
    "OUT_OF_TOLERANCE": "tab:orange",
}


def grasps(count: int, rng: np.random.Generator) -> NDArray[np.float64]:
    """Poses (count, 4, 4) of a tool whose z axis points at what it grasps: objects on the boards, five ways each."""
    poses: list[NDArray[np.float64]] = []
    while len(poses) < count:
        height = rng.uniform(0.1, 0.24)
        at = np.array([rng.uniform(0.52, 0.78), rng.uniform(-0.36, 0.36), rng.choice(BOARDS) + 0.5 * height])
        for _ in range(APPROACHES):
            yaw, down, roll = rng.uniform(-1.4, 1.4), rng.uniform(-0.5, 1.4), rng.choice([0.0, np.pi / 2])
            forward = pin.utils.rotate("z", yaw) @ pin.utils.rotate("y", np.pi / 2 + down)
            poses.append(pin.SE3(forward @ pin.utils.rotate("z", roll), at).homogeneous)
    return np.array(poses[:count])


def in_short(why: str) -> str:
    """The first two parts of a reason, without its numbers, so that reasons can be counted."""
    return NUMBER.sub("…", "; ".join(why.split("; ")[:2]))


def reasons(batch: mik.IKBatch) -> str:
    """A table: how many grasps ended how, and in which words, most frequent first."""
    lines = []
    for status, many in Counter(batch.status).most_common():
        lines.append(f"  {many:4} {status}")
        if status is not mik.IKStatus.SOLVED:
            why = Counter(in_short(result.why) for result in batch if result.status is status)
            lines += [f"       {times:4} {words}" for words, times in why.most_common(SHOWN)]
            rest = why.total() - sum(times for _, times in why.most_common(SHOWN))
            lines += [f"       {rest:4} others"] if rest else []
    return "\n".join(lines)


def draw(axes, world: mik.CollisionWorld, batch: mik.IKBatch) -> None:
    """The shelf, and an arrow for each grasp: as long as a hand, to where it grasps, coloured by how it ended."""
    for obstacle in world.obstacles:
        low, size = obstacle.pose.translation - 0.5 * np.array(obstacle.shape.size), obstacle.shape.size
        axes.bar3d(*low, *size, color="0.6", alpha=0.12, edgecolor="0.5", linewidth=0.3)
    poses = np.asarray(batch.targets)
    for status, colour in COLOURS.items():
        here = poses[batch.status == status]
        tips, ways = here[:, :3, 3], 0.1 * here[:, :3, 2]
        axes.quiver(*(tips - ways).T, *ways.T, color=colour, linewidth=1.3, label=f"{len(here)} {status}")
    axes.set(title=batch.chain.model.name, xlabel="x, m", ylabel="y, m", zlabel="z, m")
    axes.set_aspect("equal")
    axes.set_box_aspect(None, zoom=1.15)
    axes.set_xticks([0.5, 0.8])
    axes.view_init(elev=18, azim=-158)
    axes.legend(loc="upper left")


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 300
    picture = Path(sys.argv[2] if len(sys.argv) > 2 else "grasps.png")
    poses = grasps(count, np.random.default_rng(0))
    figure = Figure(figsize=(13, 6.5), layout="constrained")
    for i, name in enumerate(ROBOTS):
        robot = mik.load_robot(name)
        chain = mik.Chain(robot.model, robot.frame)
        world = mik.CollisionWorld(robot, load_scene("shelf"))
        batch = mik.solve_ik_batch(chain, poses, world=world)
        print(f"{name}: {count} grasps in {batch.seconds:.2f} s\n{reasons(batch)}\n")
        draw(figure.add_subplot(1, len(ROBOTS), i + 1, projection="3d"), world, batch)
    figure.savefig(picture, dpi=130)
    print(f"{picture}: green are reached, red only in collision, blue are proved out of reach")


if __name__ == "__main__":
    main()
