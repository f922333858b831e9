"""The compiled loops of kinematics: numbers in, numbers out."""
