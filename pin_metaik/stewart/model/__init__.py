"""The mechanism for other programs: URDF, and closed loops in Pinocchio."""
