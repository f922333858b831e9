"""Drive and reach: an arm on a base with wheels; one call says where to stand and how to reach, clear of a table."""

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import pin_metaik as mik
from pin_metaik import goals
from pin_metaik.collision import Box, Obstacle

ROOM = {"root_joint.x": (-3.0, 3.0), "root_joint.y": (-3.0, 3.0)}  # m
TABLE = Obstacle("table", Box((0.8, 1.6, 0.1)), (1.6, 0.0, 0.75))
LEG = Obstacle("leg", Box((0.1, 0.1, 0.7)), (1.6, 0.0, 0.35))
CUPS = [(1.4, 0.5, 0.95), (1.5, -0.6, 1.0), (1.85, 0.2, 1.1)]  # m


def main() -> None:
    picture = Path(sys.argv[1] if len(sys.argv) > 1 else "drive_and_reach.png")
    robot = mik.load_robot("tiago", planar=True)
    chain = mik.Chain(robot, robot.frame, limits=ROOM)
    print(f"{chain.n} coordinates: {', '.join(chain.names)}")
    world = mik.CollisionWorld(robot, [TABLE, LEG])

    figure = Figure(figsize=(13, 5), layout="constrained")
    here = chain.reference
    for part, cup in zip(figure.subfigures(1, len(CUPS)), CUPS, strict=True):
        asked = [
            mik.Target.at(cup, frame=robot.frame),
            goals.Pointing(robot.frame, "x", (1.0, 0.0, 0.0), tolerance=0.8),  # roughly ahead
            goals.Wish(goals.Posture(here)),  # and not farther than needed
        ]
        result = mik.solve_ik(chain, asked, here, world=world)
        x, y, yaw = chain.x(result.q)[:3]
        print(
            f"cup at {cup} m: {result.status}; stand at ({x:.2f}, {y:.2f}) m, turned by {np.degrees(yaw):.0f} degrees"
        )
        mik.ik.draw_arm(part, chain, result.q, np.array(cup), world)
        part.axes[0].view_init(elev=25, azim=-60)
        here = result.q
    figure.savefig(picture, dpi=110)
    print(f"drawn: {picture}")


if __name__ == "__main__":
    main()
