"""The pages of the toolbox, in the order of their list."""

from __future__ import annotations

from pin_metaik.gui.page import Entry
from pin_metaik.gui.pages.arms import ArmsPage
from pin_metaik.gui.pages.comparisons import ComparisonsPage
from pin_metaik.gui.pages.heuristics import HeuristicsPage
from pin_metaik.gui.pages.information import InformationPage
from pin_metaik.gui.pages.paths import PathsPage
from pin_metaik.gui.pages.platforms import PlatformsPage

PAGES: dict[str, Entry] = {
    "arms": Entry("Arms", ArmsPage),
    "metaheuristics": Entry("Metaheuristics at work", HeuristicsPage),
    "paths": Entry("Path planning", PathsPage),
    "platforms": Entry("Stewart platforms", PlatformsPage),
    "comparisons": Entry("Comparisons", ComparisonsPage),
    "information": Entry("Information", InformationPage),
}
