"""Where to put an arm: a map of what it reaches, and the best place of its base for ten poses on a table.

python examples/15_best_base.py [picture.png]
"""

import sys
from pathlib import Path

import numpy as np
import pinocchio as pin
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

import pin_metaik as mik
from pin_metaik.collision import Box, Obstacle
from pin_metaik.reachable import Grid, draw_reachability

TABLE = Obstacle("table", Box((1.2, 0.8, 0.04)), (3.0, 2.0, -0.02))


def poses(rng: np.random.Generator) -> list[pin.SE3]:
    """Ten poses above the table, the tool pointing down or a little to the side."""
    found = []
    for _ in range(10):
        turn = pin.rpy.rpyToMatrix(np.pi + rng.uniform(-0.4, 0.4), rng.uniform(-0.4, 0.4), rng.uniform(-1.0, 1.0))
        at = TABLE.pose.translation + rng.uniform([-0.45, -0.3, 0.12], [0.45, 0.3, 0.4])
        found.append(pin.SE3(turn, at))
    return found


def main() -> None:
    picture = Path(sys.argv[1] if len(sys.argv) > 1 else "best_base.png")
    robot = mik.load_robot("ur5")
    chain = mik.Chain(robot, "tool0")
    reached = mik.reachability(chain, Grid((-0.9, -0.9, 0.0), (0.9, 0.9, 0.8), 0.2), 12)
    print(reached)
    reached.save("reachability.npz")

    # Beside the table or on it; the robot is never put where it would stand in it or reach through it.
    world = mik.CollisionWorld(robot, [TABLE])
    targets = poses(np.random.default_rng(4))
    region = mik.Box([2.0, 1.0, -np.pi], [4.0, 3.0, np.pi])
    budget = mik.Budget(evaluations=300)
    place = mik.place_base(chain, targets, region=region, world=world, budget=budget)
    print(place)
    for number, (result, worth) in enumerate(zip(place.results, place.manipulability, strict=True)):
        print(f"  pose {number}: {result.status}, manipulability {worth:.3f}")

    figure = Figure(figsize=(13, 10), layout="constrained")
    above, below = figure.subfigures(2, 1)
    draw_reachability(above, reached, slices=4)
    axes = below.add_subplot()
    low = TABLE.pose.translation[:2] - 0.5 * np.array(TABLE.shape.size[:2])
    axes.add_patch(Rectangle(low, *TABLE.shape.size[:2], color="0.85"))
    good = np.array([result.success for result in place.results])
    tips = np.array([target.translation for target in targets])
    axes.scatter(*tips[good, :2].T, color="tab:green", label=f"{good.sum()} poses reached")
    axes.scatter(*tips[~good, :2].T, color="tab:red", label=f"{(~good).sum()} not")
    axes.quiver(place.x, place.y, np.cos(place.yaw), np.sin(place.yaw), color="tab:blue", label="the base, its x axis")
    axes.set(xlabel="x, m", ylabel="y, m", aspect="equal", xlim=(2.0, 4.0), ylim=(1.2, 2.8))
    axes.legend(loc="upper right")
    figure.savefig(picture, dpi=100)
    print(picture)


if __name__ == "__main__":
    main()
