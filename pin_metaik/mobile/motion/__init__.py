"""Trajectories of a synchro-drive robot along a path: straights, curves, and the speeds that make them quick."""
