"""The pages of the toolbox, in the order of their list."""

from __future__ import annotations

from pin_metaik.gui.page import Entry
from pin_metaik.gui.pages.arms import ArmsPage

PAGES: dict[str, Entry] = {
    "arms": Entry("Arms", ArmsPage),
}
