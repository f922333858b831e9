"""A robot on two wheels planned again in motion, and a car that parks: wheels, turning circles and outlines."""

import sys
from pathlib import Path

import numpy as np
import shapely
from matplotlib.figure import Figure

from pin_metaik import mobile
from pin_metaik.mobile.plots import BLUE, EDGE, GREEN, GREY, RED, draw_scene

CAR = mobile.Footprint.rectangle(length=4.4, width=1.8, behind=1.0)  # m; paths are of the middle of the rear axle
TURNING_RADIUS = 5.0  # m, of that point


def replanned(axes) -> None:
    """A TurtleBot3 on its way, a crate that appears, and the way it takes without stopping."""
    robot = mobile.TURTLEBOT3_WAFFLE
    crate = [(2.6, -0.35), (3.0, -0.35), (3.0, 0.4), (2.6, 0.4)]
    before = mobile.plan_trajectory([(0, 0), (5, 0)], robot)
    now = before.trajectory.state(6.0)
    scene = mobile.Scene((0, 0), (5, 0), [crate], (-0.5, -1.2, 5.5, 1.2))
    after = mobile.replan(scene, robot, start=now)
    motion = after.trajectory.sample()
    wheels = robot.wheels(motion.v, motion.omega)
    print(f"planned again at {now.v:.2f} m/s: {after}")
    slowest = motion.v[motion.t < motion.t[-1] - 1].min()  # before it brakes at the goal
    print(f"wheels reach {np.abs(wheels).max():.3f} of {robot.wheel_speed} m/s; the slowest speed is {slowest:.2f} m/s")

    draw_scene(axes[0], scene)
    axes[0].plot(*before.trajectory.sample().xy.T, "--", color=GREY)
    axes[0].plot(*motion.xy.T, color=BLUE, linewidth=2)
    axes[0].plot(now.x, now.y, "s", color=RED)
    axes[0].set(title="planned again at the red square", xlabel="x, m", ylabel="y, m")
    for wheel, colour, name in zip(wheels.T, (BLUE, RED), ("left", "right"), strict=True):
        axes[1].plot(motion.t, wheel, color=colour, label=name)
    axes[1].axhline(robot.wheel_speed, color=GREY, linestyle=":", label="limit")
    axes[1].set(title="what its wheels do", xlabel="time, s", ylabel="m/s")
    axes[1].legend()


def parked(axes) -> None:
    """A gap between two cars: driven past, then backwards into it, and the outline checked on the whole way."""
    row = [shapely.box(x, -1.0, x + 4.4, 0.8) for x in (-6.4, 5.6)] + [shapely.box(-8, -1.6, 14, -1.3)]
    start, goal = (-7.0, 2.4, 0.0), (0.0, -0.1, 0.0)
    shortest = mobile.shortest_curve(start, goal, TURNING_RADIUS, reverse=True)
    hit = mobile.first_contact(shortest, CAR, row)
    print(f"the shortest curve, {shortest.word}, {shortest.length:.1f} m, hits car {hit.obstacle} after {hit.s:.2f} m")

    for ahead in np.arange(8.0, 20.0, 0.5):  # how far to drive past the gap
        past = mobile.Curve(start, TURNING_RADIUS, "S", (float(ahead),))
        back = mobile.shortest_curve(past.end, goal, TURNING_RADIUS, reverse=True)
        if not any(mobile.first_contact(curve, CAR, row) for curve in (past, back)):
            break
    print(f"after {ahead} m straight on, {back.word}, {back.length:.1f} m, {len(back.cusps)} cusps: free, for certain")
    for curve, colour, way in ((shortest, GREY, "--"), (past, BLUE, "-"), (back, BLUE, "-")):
        axes.plot(*curve.poses(curve.places()).T[:2], way, color=colour)
    for outline, colour in ((CAR.at(back.poses(np.linspace(0, back.length, 9))), GREEN), (row, EDGE)):
        for shape in outline:
            axes.plot(*shapely.get_coordinates(shape).T, color=colour, linewidth=0.8)
    axes.set(title="parking: Reeds and Shepp, outline checked", xlabel="x, m", ylabel="y, m", aspect="equal")
    mobile.write_nav_path("parking.yaml", back)  # nav_msgs/Path, for ROS


def main() -> None:
    picture = Path(sys.argv[1] if len(sys.argv) > 1 else "vehicles.png")
    figure = Figure(figsize=(11, 6.5), layout="constrained")
    grid = figure.add_gridspec(2, 2)
    replanned([figure.add_subplot(grid[0, 0]), figure.add_subplot(grid[0, 1])])
    parked(figure.add_subplot(grid[1, :]))
    figure.savefig(picture, dpi=130)
    print(f"drawn: {picture}")


if __name__ == "__main__":
    main()
