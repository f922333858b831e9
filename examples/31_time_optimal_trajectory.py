"""From a path to the quickest trajectory along it, and why the shortest path is not the quickest.

python examples/31_time_optimal_trajectory.py [picture.png]
"""

import sys

import numpy as np

from pin_metaik import mobile


def main() -> None:
    robot = mobile.NOMAD_200
    scene = mobile.random_scene(15, rng=3, gap=0.75)
    problem = mobile.PathProblem.of(scene, robot.radius, margin=0.1)  # curves cut corners: they need the margin
    shortest, *others = problem.alternatives(3)

    # Straights at full acceleration, curves at constant speed; the speeds come from dynamic programming.
    plan = mobile.plan_trajectory(shortest, robot, scene.obstacles)
    print(f"shortest path, {shortest.length:.2f} m: {plan}")
    for path in others:
        print(f"longer by {path.length - shortest.length:.2f} m:", mobile.plan_trajectory(path, robot, scene.obstacles))

    samples = plan.trajectory.sample(dt=0.05)
    x, y, heading = plan.trajectory.end
    print(f"{len(samples.t)} samples; ends at ({x:.6f}, {y:.6f}) heading {np.degrees(heading):.1f} degrees")
    print(f"never nearer than {plan.clearance:.3f} m to an obstacle; the robot's radius is {robot.radius} m")

    # The same speeds planned with a network's tangent lengths: its millimetres add up at the goal.
    learned = mobile.plan_trajectory(shortest, robot, scene.obstacles, method="ann")
    print(f"with a learned turn: {learned.time:.3f} s, {1e3 * learned.end_error:.1f} mm from the goal")

    # Pinocchio knows the robot as a planar joint: show it in any viewer next to the arms.
    body = mobile.mobile_robot(robot)
    q = mobile.configurations(samples)
    print(f"Pinocchio model {body.name!r} with nq = {body.model.nq}: {q.shape[0]} configurations to play")

    if len(sys.argv) > 1:
        from pin_metaik.mobile import plots

        plots.save(sys.argv[1], lambda figure: plots.draw_trajectory(figure, plan, scene), (11.0, 7.0))


if __name__ == "__main__":
    main()
