"""Stewart platforms: a wizard that designs them, and a simulator that shows them."""

from pin_metaik.gui.pages.platforms.page import PlatformsPage

__all__ = ["PlatformsPage"]
