"""Joint motions around obstacles, planned by OMPL (Sucan, Moll and Kavraki 2012), if it is installed."""

from pin_metaik.planning.adapter import Adapter
from pin_metaik.planning.plan import JointPlan, installed, plan_joint_move

__all__ = ["Adapter", "JointPlan", "installed", "plan_joint_move"]
