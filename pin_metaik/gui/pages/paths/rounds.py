"""Other ways round: the shortest path of each of the best homotopy classes."""

from __future__ import annotations

from dataclasses import dataclass

from pin_metaik.gui.look.map import MapDrawing
from pin_metaik.gui.pages.paths.plans import needed
from pin_metaik.gui.tab import Tab
from pin_metaik.mobile import PathPlan, PathProblem, Scene, plan_alternatives
from pin_metaik.processes import Run
from pin_metaik.watching import Watch

OTHERS, CHOSEN = (110, 175, 130), (20, 110, 50)
MOST = 20


@dataclass(frozen=True, eq=False)
class Rounding:
    """The search for them, in another process.

    Attributes:
        scene: The map.
        clearance: That the robot keeps, m.
        count: How many.
    """

    scene: Scene
    clearance: float
    count: int

    def __call__(self, watch: Watch) -> list[PathPlan]:
        """Find them."""
        return plan_alternatives(PathProblem.of(self.scene, self.clearance), self.count)


class WaysRound:
    """Controls that find them, and step through them.

    Args:
        tab: The tab.
        drawing: The map.
        count: How many are looked for at first.
    """

    def __init__(self, tab: Tab, drawing: MapDrawing, count: int) -> None:
        self._tab, self._map = tab, drawing
        self._problem: PathProblem | None = None
        self._run: Run | None = None
        self._plans: list[PathPlan] = []
        gui = tab.client.gui
        self._count = gui.add_number(
            "Ways", count, min=1, max=MOST, step=1, hint="At most so many, the shortest first."
        )
        find = gui.add_button("Find ways round")
        find.on_click(tab.doing(self._find))
        self._which = gui.add_slider("Way", min=1, max=2, step=1, initial_value=1, disabled=True)
        self._which.on_update(tab.doing(self._draw))
        self._words = gui.add_markdown("Of paths that can be bent into each other, one: the shortest.")

    @property
    def count(self) -> int:
        """How many are looked for."""
        return int(self._count.value)

    @property
    def plan(self) -> PathPlan | None:
        """The one that is chosen."""
        return self._plans[min(int(self._which.value), len(self._plans)) - 1] if self._plans else None

    def show(self, problem: PathProblem | None) -> None:
        """Forget what was found: there is another map, or another robot. None: nobody can plan there."""
        self._problem = problem
        if self._run is not None:
            self._run.stop()
        if self._plans:
            self._plans = []
            self._which.disabled = True
            self._words.content = ""
            self._draw()

    def _find(self) -> None:
        problem = needed(self._problem)
        self._words.content = "waits for a process"
        task = Rounding(problem.scene, problem.space.clearance, self.count)
        self._run = self._tab.begin(task, lambda told: None, self._found)

    def _found(self, run: Run) -> None:
        if run.result is None:
            return
        self._plans = run.result
        lines = ["| way | length, m | longer than the shortest |", "|---|---|---|"]
        for number, plan in enumerate(self._plans, start=1):
            lines.append(f"| {number} | {plan.length:.6f} | {100 * (plan.gap or 0.0):.2f} % |")
        self._words.content = "\n".join(lines)
        self._which.disabled, self._which.max = len(self._plans) < 2, max(2, len(self._plans))
        self._which.value = 1
        self._draw()

    def _draw(self) -> None:
        chosen = self.plan
        self._map.lines("ways round", [plan.path.points for plan in self._plans if plan is not chosen], OTHERS, 2.5)
        self._map.lines("way round", [] if chosen is None else [chosen.path.points], CHOSEN, 4.0)
