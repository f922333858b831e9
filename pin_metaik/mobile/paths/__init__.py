"""Paths of a point among polygons: the shortest, those of other homotopy classes, and those of metaheuristics."""
