"""Path planning: maps drawn with the mouse, the shortest path, a metaheuristic beside it, and a motion."""

from pin_metaik.gui.pages.paths.page import PathsPage

__all__ = ["PathsPage"]
