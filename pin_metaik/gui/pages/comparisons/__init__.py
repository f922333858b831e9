"""Comparisons: a results folder, its rates and curves, and its hardest targets in the page of arms."""

from pin_metaik.gui.pages.comparisons.page import ComparisonsPage

__all__ = ["ComparisonsPage"]
