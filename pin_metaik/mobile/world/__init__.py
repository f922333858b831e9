"""Where mobile robots move: polygons, occupancy grids, scenes and their free space."""
