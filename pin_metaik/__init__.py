"""Global inverse kinematics for Pinocchio."""

__version__ = "0.1.0"
