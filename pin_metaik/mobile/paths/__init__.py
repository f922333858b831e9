"""Paths of a point among polygons: the shortest, its homotopic alternatives, and those metaheuristics find."""
