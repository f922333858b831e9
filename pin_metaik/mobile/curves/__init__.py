"""Vehicles that cannot turn on the spot: curves of bounded curvature, and what a footprint sweeps along them."""
