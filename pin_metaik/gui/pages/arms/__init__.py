"""Arms: a robot, a target that is dragged, and the answer that follows."""

from pin_metaik.gui.pages.arms.page import ArmsPage

__all__ = ["ArmsPage"]
