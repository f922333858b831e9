"""Trajectories along a path: straights, curves, and the speeds that make them quick; from rest or in motion."""
