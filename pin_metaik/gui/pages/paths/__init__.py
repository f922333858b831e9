"""Path planning: obstacles drawn with the mouse, the shortest path, a metaheuristic beside it, and a motion along it."""

from pin_metaik.gui.pages.paths.page import PathsPage

__all__ = ["PathsPage"]
