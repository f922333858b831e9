"""All solutions of a pose, and the one whose joints hold least against gravity.

python examples/09_choose_among_all_solutions.py [picture.png]
"""

import sys

import numpy as np

import pin_metaik as mik
from pin_metaik.collision import save_world


def main() -> None:
    # Six joints: separate solutions, all of them, and what proves that.
    robot = mik.load_robot("aerial_arm")
    arm = mik.Chain(robot, robot.frame)
    pose = arm.placements(arm.q([0.3, -0.6, 0.9, 0.4, -0.8, 0.5]))[0]
    every = mik.solve_ik_all(arm, pose)
    print(f"{robot.name}: {len(every)} solutions inside its limits, these are all: {every.complete}")

    # Seven joints: curves of solutions, each from a joint's limit to another's, or closed.
    robot = mik.load_robot("panda")
    arm = mik.Chain(robot, robot.frame)
    q0 = arm.q([0.4, 0.3, -0.2, -1.5, 0.5, 1.8, 0.3])
    grasp = arm.placements(q0)[0]
    motions = mik.self_motions(arm, grasp, q0)
    for curve in motions:
        print(f"{robot.name}: {curve.length:.2f} rad of self-motion, {curve.ends[0]} to {curve.ends[1]}")

    # The same grasp with 2 kg in the hand, held with as little torque as it can be.
    torque = mik.gravity_torque(arm, payload=2.0)
    best = motions.best(torque)
    print(f"torque at q0 {torque(q0):.1f} N m, least {best.value:.1f} N m, at {np.round(arm.x(best.q), 2)}")
    error = grasp.actInv(arm.placements(best.q)[0])
    print(f"off the grasp by {np.linalg.norm(error.translation):.0e} m")

    if len(sys.argv) > 1:  # along the longest curve, and the best of all, opaque
        save_world(sys.argv[1], mik.CollisionWorld(robot), [*motions.curves[0].sample(1.5), best.q], [grasp])


if __name__ == "__main__":
    main()
