"""Planners that others made: A* on a grid, and trees and roadmaps of random samples, for comparison."""
