"""Planners of other packages, for comparison: A* on a grid, and trees and roadmaps of random samples."""
