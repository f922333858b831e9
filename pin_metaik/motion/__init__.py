"""From answers to motions: following targets tick by tick, and timing paths."""

from pin_metaik.motion.follower import Follower
from pin_metaik.motion.limits import MotionLimits
from pin_metaik.motion.step import FollowerStep, Following

__all__ = ["Follower", "FollowerStep", "Following", "MotionLimits"]
