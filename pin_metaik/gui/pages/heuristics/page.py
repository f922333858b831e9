"""The page of metaheuristics: a problem, an algorithm with its own settings, and its runs."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import Any, get_args

from pin_metaik.gui.kept import plain_of, state_of
from pin_metaik.gui.look.curves import CurvePlot
from pin_metaik.gui.pages.algorithms import AlgorithmForm, made, population
from pin_metaik.gui.pages.heuristics import state as states
from pin_metaik.gui.pages.heuristics.record import Record
from pin_metaik.gui.pages.heuristics.stage import Stage, set_up
from pin_metaik.gui.pages.heuristics.state import PAPER, HeuristicsState, Problem
from pin_metaik.gui.pages.heuristics.tasks import ArmTask, PathTask
from pin_metaik.gui.tab import Tab
from pin_metaik.mobile import FITNESSES, Scene, load_scene, random_scene, scene_names
from pin_metaik.optimize import Metaheuristic
from pin_metaik.processes import Order, Run, Told
from pin_metaik.robots.library import catalogue

REDRAW = 0.08  # s between two drawings of a population
MOST_RECORDS = 6  # runs whose curves are shown over each other


class HeuristicsPage:
    """One problem, and runs on it.

    Args:
        tab: The tab.
        values: What the page keeps.
    """

    def __init__(self, tab: Tab, values: Mapping[str, Any]) -> None:
        self._tab = tab
        self._state = state_of(HeuristicsState, values, "the page of metaheuristics")
        self._records: list[Record] = []
        self._runs: list[Run] = []
        self._stages: list[Stage] = []
        self._count = 0
        gui = tab.client.gui
        with gui.add_folder("Examples of the paper"):
            example = gui.add_dropdown("Example", tuple(PAPER), hint="Toz, Erdogmus and Sahin 2011.")
            take = gui.add_button("Set up")
            take.on_click(tab.doing(lambda: tab.show_with(tab.name, plain_of(PAPER[example.value]()))))
        with gui.add_folder("Problem"):
            self._furnish_problem(gui)
        with gui.add_folder("Algorithm"):
            self._furnish_algorithms()
        with gui.add_folder("Run"):
            self._furnish_run(gui)
        with gui.add_folder("Results"):
            self._words = gui.add_markdown("No run yet.")
            self._plot = CurvePlot(gui, "evaluations", "best objective", log=True)
            self._replay = gui.add_slider("Generation", min=0, max=1, step=1, initial_value=0, disabled=True)
            self._replay.on_update(tab.doing(self._show_generation))
            save = gui.add_button("Download the last run")
            save.on_click(tab.doing(self._save))
            load = gui.add_upload_button("Open a run", mime_type="application/json")
            load.on_upload(tab.doing(lambda: self._load(load), "That run is not taken"))
            clear = gui.add_button("Forget all runs")
            clear.on_click(tab.doing(self._forget))
        self._preview()

    def kept(self) -> dict[str, Any]:
        """See ``Page``."""
        return plain_of(self._read())

    def close(self) -> None:
        """See ``Page``. Runs are the tab's, which ends them."""

    # --- what is asked ---------------------------------------------------------------------------------------------

    def _furnish_problem(self, gui: Any) -> None:
        tab, state = self._tab, self._state
        self._problem = gui.add_dropdown("Problem", get_args(Problem), initial_value=state.problem)
        self._problem.on_update(tab.doing(lambda: self._again()))
        self._inputs: dict[str, Any] = {}
        if state.problem == "path":
            maps = (*scene_names(), states.RANDOM)
            chosen = state.scene if state.scene in maps else states.RANDOM
            self._inputs["scene"] = gui.add_dropdown("Map", maps, initial_value=chosen)
            self._inputs["obstacles"] = gui.add_number(
                "Obstacles", state.obstacles, min=0, step=1, hint="Of a random map."
            )
            self._inputs["scene_seed"] = gui.add_number("Seed of the map", state.scene_seed, min=0, step=1)
            self._inputs["via"] = gui.add_number("Via points", state.via, min=1, step=1)
            self._inputs["fitness"] = gui.add_dropdown("Objective", tuple(FITNESSES), initial_value=state.fitness)
            self._inputs["penalty"] = gui.add_number("Penalty, widths", state.penalty, min=0.0, step=0.1)
        else:
            arms = tuple(catalogue())
            self._inputs["robot"] = gui.add_dropdown("Arm", arms, initial_value=state.robot)
            self._inputs["goal"] = gui.add_vector3("Goal x, y, z, m", state.goal, step=0.01)
            self._inputs["p"] = gui.add_number("Penalty p", state.p, min=0.0, step=1.0)
        for name in ("scene", "obstacles", "scene_seed", "robot", "goal"):
            if name in self._inputs:
                self._inputs[name].on_update(tab.doing(self._preview))

    def _furnish_algorithms(self) -> None:
        tab, state = self._tab, self._state
        self._forms = {
            "algorithm": AlgorithmForm(tab, "Algorithm", state.algorithm, state.settings),
            "against": AlgorithmForm(tab, "Beside it", state.against, state.against_settings, expanded=False),
        }

    def _furnish_run(self, gui: Any) -> None:
        tab, state = self._tab, self._state
        self._iterations = gui.add_number(
            "Iterations", state.iterations, min=1, step=1, hint="Of the first population."
        )
        self._seed = gui.add_number("Seed", state.seed, min=0, step=1)
        self._pause = gui.add_number(
            "Pause, s", state.pause, min=0.0, max=10.0, step=0.01, hint="After each generation."
        )
        run = gui.add_button("Run")
        run.on_click(tab.doing(lambda: self._begin(("algorithm",), held=False)))
        both = gui.add_button("Run both side by side", hint="At equal evaluations.")
        both.on_click(tab.doing(lambda: self._begin(("algorithm", "against"), held=False)))
        self._orders = gui.add_button_group("Going", ("Pause", "Step", "Go on", "Stop"))
        self._orders.on_click(tab.doing(lambda: self._order(self._orders.value)))

    def _again(self) -> None:
        """Open the page anew: another problem has other inputs."""
        self._tab.show_with(self._tab.name, plain_of(replace(self._read(), problem=self._problem.value)))

    def _read(self) -> HeuristicsState:
        """The state with what was typed."""
        typed = {name: handle.value for name, handle in self._inputs.items()}
        return replace(
            self._state,
            **typed,
            algorithm=self._forms["algorithm"].name,
            settings=self._forms["algorithm"].changed,
            against=self._forms["against"].name,
            against_settings=self._forms["against"].changed,
            iterations=int(self._iterations.value),
            seed=int(self._seed.value),
            pause=float(self._pause.value),
        )

    def _scene(self, state: HeuristicsState) -> Scene:
        if state.scene != states.RANDOM:
            return load_scene(state.scene)
        return random_scene(state.obstacles, state.scene_seed)

    def _task(self, state: HeuristicsState, algorithm: Metaheuristic, evaluations: int) -> PathTask | ArmTask:
        if state.problem == "path":
            scene = self._scene(state)
            return PathTask(scene, 0.0, algorithm, state.fitness, state.penalty, state.via, evaluations, state.seed)
        parameters = tuple(state.parameters.items()) if state.robot == self._state.robot else ()
        return ArmTask(state.robot, parameters, state.goal, state.p, algorithm, evaluations, state.seed)

    # --- runs ------------------------------------------------------------------------------------------------------

    def _preview(self) -> None:
        """Draw the problem before anything is run."""
        state = self._read()
        self._set_up([self._task(state, self._forms["algorithm"].algorithm, 1)])

    def _set_up(self, tasks: list[PathTask | ArmTask]) -> None:
        for stage in self._stages:
            stage.remove()
        self._stages = []
        for number, task in enumerate(tasks):
            self._stages.append(set_up(self._tab, number, len(tasks), task))

    def _begin(self, roles: tuple[str, ...], held: bool) -> None:
        state = self._read()
        for run in self._runs:
            run.stop()
        algorithms = [self._forms[role].algorithm for role in roles]
        evaluations = state.iterations * population(algorithms[0])
        tasks = [self._task(state, algorithm, evaluations) for algorithm in algorithms]
        self._set_up(tasks)
        self._runs = []
        shown = plain_of(state)
        self._replay.disabled = True
        for role, task, stage in zip(roles, tasks, self._stages, strict=True):
            self._count += 1
            record = Record(f"{self._forms[role].name} {self._count}", shown)
            self._records = [*self._records, record][-MOST_RECORDS:]
            drawn = [0.0]
            run = self._tab.begin(
                task,
                partial(self._tell, record, stage, drawn),
                partial(self._end, record, stage, task),
                held=held,
                pause=state.pause,
            )
            self._runs.append(run)
        self._say()

    def _order(self, what: str) -> None:
        going = [run for run in self._runs if not run.over]
        if what == "Step" and not going:
            self._begin(("algorithm",), held=True)
            return
        orders = {"Pause": Order.HOLD, "Step": Order.STEP, "Go on": Order.GO, "Stop": Order.STOP}
        for run in going:
            run.order(orders[what])

    def _tell(self, record: Record, stage: Stage, drawn: list[float], told: Told) -> None:
        record.add(told)
        now = time.monotonic()
        if now - drawn[0] >= REDRAW:
            drawn[0] = now
            self._draw(record, stage)

    def _draw(self, record: Record, stage: Stage) -> None:
        best = None if record.outcome is None else record.outcome.x
        with self._tab.client.atomic():
            if stage in self._stages and record.populations:
                stage.show(record.populations[-1], best)
            self._plot.show({one.label: one.curve for one in self._records if one.evaluations})
            self._say()

    def _end(self, record: Record, stage: Stage, task: PathTask | ArmTask, run: Run) -> None:
        if run.result is not None:
            record.outcome = task.outcome(run.result)
        self._draw(record, stage)
        generations = len(record.populations)
        if generations > 1:
            self._replay.max = generations - 1
            self._replay.value = generations - 1
            self._replay.disabled = False

    def _say(self) -> None:
        """The runs in a table."""
        rows = ["| run | objective | evaluations | s | |", "|---|---|---|---|---|"]
        for record in reversed(self._records):
            ended = record.outcome
            if ended is not None:
                cells = (
                    f"{ended.cost:.6g} | {ended.evaluations:,} | {ended.seconds:.3g} | {ended.status}; {ended.words}"
                )
            elif record.best:
                cells = f"{record.best[-1]:.6g} | {record.evaluations[-1]:,.0f} | {record.seconds:.3g} | goes on"
            else:
                cells = "| | | waits for a process"
            rows.append(f"| {record.label} | {cells} |")
        self._words.content = "\n".join(rows) if self._records else "No run yet."

    # --- replayed, saved -------------------------------------------------------------------------------------------

    def _show_generation(self) -> None:
        number = int(self._replay.value)
        shown = self._records[-len(self._stages) :] if self._stages else []
        for record, stage in zip(shown, self._stages, strict=False):
            if record.populations:
                X = record.populations[min(number, len(record.populations) - 1)]
                stage.show(X, None)

    def _save(self) -> None:
        if self._records:
            self._tab.download("run.json", self._records[-1].to_text())

    def _load(self, handle: Any) -> None:
        path = self._tab.received(handle, ".json")
        record = Record.from_text(path.read_bytes(), path.name)
        state = state_of(HeuristicsState, record.task, path.name)
        task = self._task(state, made(state.algorithm, state.settings), 1)
        dimension = {X.shape[1] for X in record.populations}
        self._set_up([task])
        self._records = [*self._records, record][-MOST_RECORDS:]
        if len(dimension) == 1:
            self._draw(record, self._stages[0])
            self._replay.max = max(1, len(record.populations) - 1)
            self._replay.disabled = False

    def _forget(self) -> None:
        for run in self._runs:
            run.stop()
        self._records, self._runs = [], []
        self._plot.show({})
        self._say()
