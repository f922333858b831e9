"""Path planners side by side, on scenes of one's own: runs, their table, and their pictures."""
