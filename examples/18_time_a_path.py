"""Give a path times: the quickest motion within limits of speed and acceleration, or a gentler one with less jerk.

python examples/18_time_a_path.py [picture.png]
"""

import sys

import numpy as np
import pinocchio as pin

import pin_metaik as mik

ACCELERATION = (15.0, 7.5, 10.0, 12.5, 15.0, 20.0, 20.0)  # rad/s^2, of panda's data sheet; no URDF has any


def main() -> None:
    robot = mik.load_robot("panda")
    chain = mik.Chain(robot, robot.frame)
    home = np.array([0.0, -0.3, 0.0, -2.0, 0.0, 1.8, 0.7, 0.0])
    start = chain.placements(home)[0]
    poses = [pin.SE3(start.rotation, start.translation + np.array([0.0, y, 0.0])) for y in np.linspace(0.0, 0.5, 100)]
    path = mik.solve_ik_path(chain, poses, home)

    quickest = path.timed(acceleration=ACCELERATION)
    gentler = path.timed(acceleration=ACCELERATION, jerk=3000.0)
    for name, timed in ("quickest, by toppra", quickest), ("with jerk below 3000 rad/s^3, by ruckig", gentler):
        samples = timed.sample(0.001)
        speed, acceleration = np.abs(samples.v) / timed.limits.velocity, np.abs(samples.a) / timed.limits.acceleration
        print(f"{name}: {timed.duration:.3f} s, the hand at most at {samples.tip_speed.max():.2f} m/s")
        print(f"  largest speed {speed.max():.3f}, acceleration {acceleration.max():.3f} of the limits")

    quickest.write_csv("motion.csv", every=0.01)
    quickest.write_joint_trajectory("motion.json", every=0.01)  # trajectory_msgs/JointTrajectory, for ROS controllers
    picture = sys.argv[1] if len(sys.argv) > 1 else "motion.png"
    quickest.plot(picture)
    print(f"written: motion.csv, motion.json; drawn: {picture}")


if __name__ == "__main__":
    main()
