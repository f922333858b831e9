"""Self-motion: all solutions of a chain with one spare degree of freedom, as curves."""

from pin_metaik.ik.self_motion.curve import CurveEnd, CurvePoint, EndReason, SelfMotionCurve
from pin_metaik.ik.self_motion.motions import SelfMotions, self_motions

__all__ = ["CurveEnd", "CurvePoint", "EndReason", "SelfMotionCurve", "SelfMotions", "self_motions"]
