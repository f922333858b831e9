"""Kinematics: chains over any Pinocchio model, their limits, and the compiled loops behind them."""

from pin_metaik.kinematics.chain import RESTARTS, Chain
from pin_metaik.kinematics.limits import Limits

__all__ = ["RESTARTS", "Chain", "Limits"]
