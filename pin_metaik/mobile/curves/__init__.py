"""Vehicles that cannot turn on the spot: curves of bounded curvature, and the area swept along them."""
