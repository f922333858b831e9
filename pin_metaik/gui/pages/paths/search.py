"""A metaheuristic beside the shortest path: its settings, its population while it searches, and the gap."""

from __future__ import annotations

from functools import partial
from typing import Any

from pin_metaik.gui.look.map import MapDrawing
from pin_metaik.gui.pages.algorithms import AlgorithmForm, population
from pin_metaik.gui.pages.heuristics.tasks import PathTask
from pin_metaik.gui.pages.paths.plans import needed
from pin_metaik.gui.pages.paths.state import PathsState
from pin_metaik.gui.tab import Tab
from pin_metaik.mobile import FITNESSES, PathProblem
from pin_metaik.processes import Run, Told

SEARCHED, SWARM = (210, 70, 50), (60, 120, 210)
MOST_WAYS = 100  # of a population, that are drawn


class PathSearch:
    """Controls of one search.

    Args:
        tab: The tab.
        drawing: The map.
        state: What is chosen at first.
    """

    def __init__(self, tab: Tab, drawing: MapDrawing, state: PathsState) -> None:
        self._tab, self._map = tab, drawing
        self._problem: PathProblem | None = None
        self._run: Run | None = None
        gui = tab.client.gui
        self._form = AlgorithmForm(tab, "Algorithm", state.algorithm, state.settings, expanded=False)
        self._via = gui.add_number("Number of via points", state.via, min=1, step=1)
        self._fitness = gui.add_dropdown("Objective", tuple(FITNESSES), initial_value=state.fitness)
        self._penalty = gui.add_number("Penalty, widths", state.penalty, min=0.0, step=0.1)
        self._iterations = gui.add_number("Iterations", state.iterations, min=1, step=1)
        self._seed = gui.add_number("Seed", state.seed, min=0, step=1)
        search = gui.add_button("Search")
        search.on_click(tab.doing(self._search))
        stop = gui.add_button("Stop")
        stop.on_click(tab.doing(lambda: self._run.stop() if self._run is not None else None))
        self._words = gui.add_markdown("")

    @property
    def kept(self) -> dict[str, Any]:
        """What is chosen, by fields of the page's state."""
        return {
            "algorithm": self._form.name,
            "settings": self._form.changed,
            "via": int(self._via.value),
            "fitness": self._fitness.value,
            "penalty": self._penalty.value,
            "iterations": int(self._iterations.value),
            "seed": int(self._seed.value),
        }

    def show(self, problem: PathProblem | None) -> None:
        """Take another map, or another robot, and draw no more what was found before."""
        self._problem = problem
        self._map.clear("swarm")
        self._map.clear("searched")

    def _search(self) -> None:
        if self._run is not None:
            self._run.stop()
        problem = needed(self._problem)
        algorithm = self._form.algorithm
        task = PathTask(
            problem.scene,
            problem.space.clearance,
            algorithm,
            self._fitness.value,
            self._penalty.value,
            int(self._via.value),
            int(self._iterations.value) * population(algorithm),
            int(self._seed.value),
        )
        self._words.content = "waits for a process"
        self._run = self._tab.begin(task, partial(self._tell, problem), partial(self._ended, problem, task))

    def _tell(self, problem: PathProblem, told: Told) -> None:
        at = told.progress
        if at.population is not None and problem is self._problem:
            ways = [problem.through(x).points for x in at.population.X[:MOST_WAYS]]
            self._map.lines("swarm", ways, SWARM, 1.0)
        self._words.content = f"{at.done:,.0f} of {at.total:,.0f} paths, best {at.best:.6g}"

    def _ended(self, problem: PathProblem, task: PathTask, run: Run) -> None:
        if run.result is None:
            return
        ended = task.outcome(run.result)
        if problem is self._problem:
            self._map.path("searched", run.result.path.points, SEARCHED, 5.0)
        self._words.content = (
            f"**{ended.status}**: objective {ended.cost:.6f}; {ended.words}; {ended.evaluations:,} paths in "
            f"{ended.seconds:.3g} s"
        )
