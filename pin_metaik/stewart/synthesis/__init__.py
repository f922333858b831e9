"""Dimensional synthesis: designs, by a metaheuristic."""
