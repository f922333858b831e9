"""The steps of a design: what kind of platform, what is fixed and what is free, where it is judged, and by what."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pin_metaik.errors import InvalidGeometry, InvalidSetting
from pin_metaik.gui.forms import SettingsForm
from pin_metaik.gui.pages.algorithms import AlgorithmForm
from pin_metaik.gui.tab import Tab
from pin_metaik.optimize import ALGORITHMS, make
from pin_metaik.processes import Run, Told
from pin_metaik.stewart import (
    NAMED,
    Designed,
    DesignTask,
    Mechanism,
    design,
    legs_of,
    load_mechanism,
    mechanism_names,
    new_mechanism,
    new_servo_mechanism,
    read_mechanism,
    to_toml,
)
from pin_metaik.stewart.show.report import outcome
from pin_metaik.watching import Watch

SIZES = ("base_radius", "platform_radius", "base_angles", "platform_angles")
LINEAR, SERVO = "change their length", "are rods moved by servos"
OF_LEGS = {LINEAR: ("shortest", "longest"), SERVO: ("horn", "rod", "directions")}
ELSEWHERE = ("ranges", "grid", "algorithm")  # of a task: steps of their own
MM = 1e-3

Take = Callable[[Mechanism], None]


@dataclass(frozen=True, eq=False)
class Designing:
    """A design in another process.

    Attributes:
        mechanism: With the task.
    """

    mechanism: Mechanism

    def __call__(self, watch: Watch) -> Designed:
        """Design it."""
        return design(self.mechanism, watch=watch)


class Wizard:
    """The steps as folders, and the run at their end.

    Args:
        tab: The tab.
        mechanism: What to begin with.
        take: Called with another mechanism, which is then everybody's.
    """

    def __init__(self, tab: Tab, mechanism: Mechanism, take: Take) -> None:
        self._tab, self._mechanism, self._take = tab, mechanism, take
        self._run: Run | None = None
        gui = tab.client.gui
        with gui.add_folder("1 Mechanism"):
            self._furnish_source(gui)
        with gui.add_folder("2 Joints and legs", expand_by_default=False):
            self._furnish_joints(gui)
        with gui.add_folder("3 Fixed and free", expand_by_default=False):
            self._furnish_ranges(gui)
        with gui.add_folder("4 Workspace", expand_by_default=False):
            self._grid = SettingsForm(tab, mechanism.grid)
            self._dexterity = SettingsForm(tab, mechanism.dexterity)
        with gui.add_folder("5 Goal and search", expand_by_default=False):
            self._furnish_task()
        with gui.add_folder("6 Everything, before the run", expand_by_default=False):
            gather = gui.add_button("Show all settings", hint="As the file that the command line reads.")
            gather.on_click(tab.doing(self._gather))
            self._text = gui.add_text("Settings", to_toml(mechanism), multiline=True)
            use = gui.add_button("Use these settings")
            use.on_click(tab.doing(lambda: self._take(self._read(self._text.value)), "These settings are not taken"))
        run = gui.add_button("Design")
        run.on_click(tab.doing(self._design))
        stop = gui.add_button("Stop the design")
        stop.on_click(tab.doing(lambda: self._run.stop() if self._run is not None else None))
        self._bar = gui.add_progress_bar(0.0, visible=False)
        self._words = gui.add_markdown("")
        self._found: Designed | None = None
        self._result = gui.add_button("Take the design", visible=False, hint="Into the simulator and the steps above.")
        self._result.on_click(tab.doing(self._take_result))

    def _furnish_source(self, gui: Any) -> None:
        tab, geometry, limits = self._tab, self._mechanism.geometry, self._mechanism.limits
        known = gui.add_dropdown("Catalogue", tuple(mechanism_names()))
        load = gui.add_button("Take it from the catalogue")
        load.on_click(tab.doing(lambda: self._take(load_mechanism(known.value))))
        upload = gui.add_upload_button("Open a mechanism: .toml", mime_type=".toml")
        upload.on_upload(
            tab.doing(lambda: self._take(read_mechanism(tab.received(upload, ".toml"))), "That mechanism is not taken")
        )
        save = gui.add_button("Download the mechanism")
        save.on_click(tab.doing(lambda: tab.download(f"{self._mechanism.name}.toml", to_toml(self._mechanism))))
        legs = gui.add_number("Legs", 6, min=3, max=6, step=1)
        kind = gui.add_text("Type", geometry.type, hint=f"Joints a side, base first: {', '.join(NAMED)} ...")
        moved = gui.add_dropdown("Legs that", tuple(OF_LEGS), initial_value=self._moved)
        radii = gui.add_vector2("Radii, mm", _mm(geometry.base_radius, geometry.platform_radius), step=0.1)
        low, high = limits.span if geometry.servos is None else (0.25, 0.35)
        lengths = gui.add_vector2("Shortest and longest, mm", _mm(low, high), step=0.1)
        servos = geometry.servos
        horn, rod = (0.02, 0.12) if servos is None else (float(np.ravel(each)[0]) for each in (servos.horn, servos.rod))
        parts = gui.add_vector2("Horn and rod, mm", _mm(horn, rod), step=0.1)

        def show() -> None:
            lengths.visible, parts.visible = moved.value == LINEAR, moved.value == SERVO

        def begin() -> None:
            new, pair = (new_mechanism, lengths) if moved.value == LINEAR else (new_servo_mechanism, parts)
            sizes = [value * MM for value in (*radii.value, *pair.value)]
            self._take(new(kind.value, *sizes, legs=int(legs.value)))

        show()
        moved.on_update(tab.doing(show))
        fresh = gui.add_button("Begin with this type")
        fresh.on_click(tab.doing(begin))

    @property
    def _moved(self) -> str:
        """What its legs do."""
        return LINEAR if self._mechanism.geometry.servos is None else SERVO

    def _furnish_joints(self, gui: Any) -> None:
        tab, mechanism = self._tab, self._mechanism
        rows = "\n".join("".join(map(str, row)) for row in mechanism.geometry.connection)
        matrix = gui.add_text(
            "Connections", rows, multiline=True, hint="A row a base joint, a column a platform joint."
        )
        connect = gui.add_button("Connect so")
        connect.on_click(tab.doing(lambda: self._connect(matrix.value)))
        self._limits = SettingsForm(tab, mechanism.limits)

    def _connect(self, text: str) -> None:
        """Legs where the matrix has ones."""
        rows = [line.strip() for line in text.strip().splitlines()]
        if not rows or any(set(row) - set("01") or len(row) != len(rows[0]) for row in rows):
            raise InvalidGeometry("connections are rows of 0 and 1, all of one length, e.g. 110, 011 and 101")
        legs = legs_of(np.array([[int(cell) for cell in row] for row in rows]))
        self._take(replace(self._assembled(), geometry=replace(self._mechanism.geometry, legs=legs)))

    def _furnish_ranges(self, gui: Any) -> None:
        self._spans: SettingsForm | None = None
        if self._mechanism.task is None:
            gui.add_markdown("This mechanism has no task: begin with a type, or take one that has.")
            return
        gui.add_markdown("A number is fixed, `0.1..0.2` is free in between; m and rad; empty as it is.")
        ranges, free = self._mechanism.task.ranges, (*SIZES, *OF_LEGS[self._moved])
        rest = tuple(name for name in vars(ranges) if name not in free)
        self._spans = SettingsForm(self._tab, ranges, skip=rest)

    def _furnish_task(self) -> None:
        self._task: SettingsForm | None = None
        task = self._mechanism.task
        if task is None:
            return
        self._task = SettingsForm(self._tab, task, skip=ELSEWHERE)
        algorithm: Any = make(task.algorithm)
        name = next(name for name, kind in ALGORITHMS.items() if type(algorithm) is kind)
        self._algorithm = AlgorithmForm(self._tab, "Search by", name, dict(vars(algorithm)), expanded=False)

    def _assembled(self) -> Mechanism:
        """The mechanism with everything that was typed.

        Raises:
            MetaIKError: Something of it makes no sense.
        """
        task = self._mechanism.task
        if task is not None and self._task is not None and self._spans is not None:
            typed: DesignTask = self._task.settings
            task = replace(typed, ranges=self._spans.settings, algorithm=self._algorithm.algorithm)
        return replace(
            self._mechanism,
            limits=self._limits.settings,
            grid=self._grid.settings,
            dexterity=self._dexterity.settings,
            task=task,
        )

    def _gather(self) -> None:
        self._text.value = to_toml(self._assembled())

    def _read(self, text: str) -> Mechanism:
        path = self._tab.folder / "mechanism.toml"
        path.write_text(text, encoding="utf-8")
        return read_mechanism(path)

    def _design(self) -> None:
        mechanism = self._assembled()
        if mechanism.task is None:
            raise InvalidSetting("this mechanism has no task: begin with a type, or take one that has")
        if self._run is not None:
            self._run.stop()
        self._words.content, self._bar.visible, self._bar.value = "waits for a process", True, 0.0
        self._run = self._tab.begin(Designing(mechanism), self._tell, self._designed)

    def _tell(self, told: Told) -> None:
        at = told.progress
        self._bar.value = 100.0 * at.done / at.total if at.total else 0.0
        best = "" if at.best is None or at.best >= 0.0 else f", best fitness {-at.best:.4f}"
        self._words.content = f"{at.done:,.0f} of {at.total:,.0f} designs{best}"

    def _designed(self, run: Run) -> None:
        self._bar.visible = False
        if run.result is None:
            self._words.content = "ended without a design"
            return
        found: Designed = run.result
        rows = "\n".join(f"| {name} | {value} |" for name, value in outcome(found))
        self._words.content = f"| | |\n|---|---|\n{rows}"
        self._found, self._result.visible = found, found.success

    def _take_result(self) -> None:
        if self._found is not None:
            self._take(self._found.mechanism)


def _mm(first: float, second: float) -> tuple[float, float]:
    """Two lengths, m, as they are shown: to a nanometre."""
    return round(first / MM, 6), round(second / MM, 6)
