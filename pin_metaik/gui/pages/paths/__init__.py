"""Path planning: obstacles that are drawn, the shortest path, a metaheuristic's beside it, and a robot that drives it."""

from pin_metaik.gui.pages.paths.page import PathsPage

__all__ = ["PathsPage"]
