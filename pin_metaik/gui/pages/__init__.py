"""The pages of the toolbox, in the order of their list."""

from __future__ import annotations

from pin_metaik.gui.page import Entry

HERE = "pin_metaik.gui.pages"
PAGES: dict[str, Entry] = {
    "arms": Entry("Arms", f"{HERE}.arms", "ArmsPage"),
    "metaheuristics": Entry("Metaheuristics at work", f"{HERE}.heuristics", "HeuristicsPage"),
    "paths": Entry("Path planning", f"{HERE}.paths", "PathsPage"),
    "platforms": Entry("Stewart platforms", f"{HERE}.platforms", "PlatformsPage"),
    "comparisons": Entry("Comparisons", f"{HERE}.comparisons", "ComparisonsPage"),
    "information": Entry("Information", f"{HERE}.information", "InformationPage"),
}
