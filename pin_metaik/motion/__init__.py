"""Control tick by tick: joints that follow targets within limits of velocity and acceleration.

import pin_metaik as mik

follower = mik.Follower(chain, rate=500.0)         # limits= of your own, world= for obstacles
step = follower.step(target, q)                    # q: where the robot is, then step.q
step.q, step.v, step.status
"""

from pin_metaik.motion.follower import Follower
from pin_metaik.motion.step import FollowerStatus, FollowerStep

__all__ = ["Follower", "FollowerStatus", "FollowerStep"]
