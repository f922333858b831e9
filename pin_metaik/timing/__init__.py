"""Time parametrisation of paths: the quickest motion within limits of velocity and acceleration, or one also of jerk.

from pin_metaik import timing

timed = timing.time_path(chain, q)                    # or path.timed() of what solve_ik_path found
timed = timing.time_path(chain, q, jerk=500.0)
timed.duration, timed.sample(0.01).v
timed.write_joint_trajectory("motion.json")           # trajectory_msgs/JointTrajectory
"""

from pin_metaik.timing.limits import MotionLimits
from pin_metaik.timing.plots import draw_timed
from pin_metaik.timing.timed import TimedPath, TimedSamples, time_path

__all__ = ["MotionLimits", "TimedPath", "TimedSamples", "draw_timed", "time_path"]
