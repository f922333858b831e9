"""The figures of a report, of the robots, case and methods that are chosen."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import numpy as np

from pin_metaik.compare import Results
from pin_metaik.compare.results import series
from pin_metaik.compare.trials.trial import CURVE
from pin_metaik.gui.look.charts import intervals, matrix
from pin_metaik.gui.look.curves import CurvePlot

RATIOS = (
    "How many times the evaluations of the method of a column that of a row takes, in the median over tasks: blue is "
    "fewer, red is more, grey numbers are not significant (Wilcoxon, Holm, 0.05)."
)


class Figures:
    """Four figures, a folder each.

    Args:
        gui: Of one tab.
        results: What they are of.
    """

    def __init__(self, gui: Any, results: Results) -> None:
        self._results, self._at = results, series.evaluations_of(results)
        self._budget = results.manifest.budget
        with gui.add_folder("Share solved within so many evaluations"):
            self._shares = CurvePlot(gui, "kernel evaluations", "share of trials solved", log_x=True)
        with gui.add_folder("Share solved"):
            self._rates = gui.add_html("")
        with gui.add_folder("Every method against every other"):
            self._duels = gui.add_html("")
            self._duel_words = gui.add_markdown(RATIOS)
        self._costs_folder = gui.add_folder("Best cost so far", visible=False)
        with self._costs_folder:
            self._costs = CurvePlot(gui, "kernel evaluations", "best cost so far, m + rad", log=True, log_x=True)
            gui.add_markdown("Median over the trials; between the quartiles it is shaded.")

    def show(self, robot: str | None, case: str, methods: Collection[str]) -> None:
        """Show them for a case, of one robot or of all together."""
        results = self._results
        shares = series.distributions(results, case, self._at, robot)
        self._shares.show({method: (self._at, share) for method, share in shares.items() if method in methods})
        rates = series.rates(results, case, robot)
        self._rates.content = intervals({method: rate for method, rate in rates.items() if method in methods})
        fought = series.duels(results, case, robot)
        chosen = None if fought is None else fought.among(methods)
        self._duels.content = "" if chosen is None else matrix(chosen)
        self._duel_words.content = "There are no two methods to compare." if chosen is None else RATIOS
        curves = series.convergence(results, case, robot)
        kept = {method: curves[method] for method in methods if method in curves}
        self._costs_folder.visible = bool(kept)
        at = CURVE * self._budget
        shown = {}
        for method, quartiles in kept.items():
            known = ~np.isnan(quartiles[1])
            low, middle, high = quartiles[:, known]
            shown[method] = (at[known], middle, low, high)
        self._costs.show(shown)
