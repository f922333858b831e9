"""Metaheuristics at work: populations that search, seen from generation to generation."""

from pin_metaik.gui.pages.heuristics.page import HeuristicsPage

__all__ = ["HeuristicsPage"]
