"""The page of comparisons: what a results folder says of the methods that are chosen."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pinocchio as pin

from pin_metaik.compare import CASES, Results, Task, read_results, summarise
from pin_metaik.compare.folder.manifest import MANIFEST
from pin_metaik.compare.report.parts import Value
from pin_metaik.compare.report.worst import worst
from pin_metaik.compare.trials.work_item import WorkItem
from pin_metaik.errors import InvalidSetting
from pin_metaik.gui.pages.arms.arm import names
from pin_metaik.gui.pages.comparisons.figures import Figures
from pin_metaik.gui.tab import Tab
from pin_metaik.lookup import lookup

ALL = "all"
ARMS = "arms"


class ComparisonsPage:
    """One results folder. It is sent as a .zip and kept with the tab: the page keeps nothing else.

    Args:
        tab: The tab.
        values: Nothing.
    """

    def __init__(self, tab: Tab, values: Mapping[str, Any]) -> None:
        if values:
            raise InvalidSetting(f"the page of comparisons keeps nothing, got {', '.join(values)}")
        self._tab = tab
        self._results: Results | None = None
        self._inputs: dict[str, Any] = {}
        self._hardest: dict[str, tuple[Value, ...]] = {}
        gui = tab.client.gui
        gui.add_markdown("Send the folder of `pin-metaik compare --out FOLDER` as a .zip.")
        upload = gui.add_upload_button("Open a results folder: .zip", mime_type=".zip")
        upload.on_upload(tab.doing(lambda: self._open(tab.received(upload, ".json")), "These results are not taken"))
        self._holder = gui.add_folder(None)
        self._box: Any = None

    def kept(self) -> dict[str, Any]:
        """See ``Page``."""
        return {}

    def close(self) -> None:
        """See ``Page``. There is no work."""

    def _open(self, meant: Path) -> None:
        manifests = sorted(self._tab.folder.rglob(MANIFEST), key=lambda path: path.stat().st_mtime)
        self._results = read_results(manifests[-1].parent if manifests else meant.parent)
        self._furnish(self._results)

    def _furnish(self, results: Results) -> None:
        gui, tab = self._tab.client.gui, self._tab
        if self._box is not None:
            self._box.remove()
        with self._holder:
            self._box = gui.add_folder(None)
        with self._box:
            with gui.add_folder("Choose"):
                for label, options in (
                    ("Robot", (ALL, *results.robots)),
                    ("Case", tuple(results.cases)),
                ):
                    self._inputs[label] = gui.add_dropdown(label, options)
                    self._inputs[label].on_update(tab.doing(self._show))
                with gui.add_folder("Methods", expand_by_default=len(results.methods) <= 8):
                    for method in results.methods:
                        self._inputs[method] = gui.add_checkbox(method, True)
                        self._inputs[method].on_update(tab.doing(self._show))
            self._about = gui.add_markdown("")
            self._table = gui.add_markdown("")
            self._figures = Figures(gui, results)
            with gui.add_folder("Hardest targets"):
                rows = worst(results, "FOLDER").tables[0].rows
                self._hardest = {f"{row[0]} / {row[1]} / {row[2]}: {row[3]}": tuple(row) for row in rows}
                if self._hardest:
                    which = gui.add_dropdown("Target", tuple(self._hardest), hint="Of each case, the hardest first.")
                    go = gui.add_button("See it in Arms")
                    go.on_click(tab.doing(lambda: self._replay(self._hardest[which.value])))
        self._show()

    def _show(self) -> None:
        results = self._results
        if results is None:
            return
        robot = None if self._inputs["Robot"].value == ALL else self._inputs["Robot"].value
        case = self._inputs["Case"].value
        methods = [method for method in results.methods if self._inputs[method].value]
        entry = results.cases[case]
        self._about.content = f"{entry.about} {entry.success}"
        lines = ["| method | solved | 95 % interval | evaluations | ms |", "|---|---|---|---|---|"]
        for method in methods:
            rows = results.rows(robot=robot, case=case, method=method)
            found = summarise(rows)
            low, high = found.interval
            spent = "-" if found.evaluations is None else f"{found.evaluations[0]:,.0f}"
            ms = "-" if found.seconds is None else f"{1e3 * found.seconds[0]:.3g}"
            shares = f"{100 * low:.1f} to {100 * high:.1f} %"
            lines.append(f"| {method} | {found.solved} of {found.trials} | {shares} | {spent} | {ms} |")
        self._table.content = "\n".join(lines)
        self._figures.show(robot, case, methods)

    def _replay(self, row: tuple[Value, ...]) -> None:
        """Open the page of arms with the target of a task, which is drawn again."""
        robot, case, number = str(row[0]), str(row[1]), int(str(row[2]))
        task = self._task(robot, case, number)
        chain, pose = task.chain, task.targets[-1]
        values: dict[str, Any] = {"robot": robot, "target": pin.SE3ToXYZQUAT(pose).tolist()}
        if task.start is not None:
            values["q"] = chain.q(task.start).tolist()
        if task.world is not None:
            values["avoid"] = True
        self._tab.show_with(ARMS, values)

    def _task(self, robot: str, case: str, number: int) -> Task:
        """A task of the comparison, if its robot and its case have names: what was sent imports nothing.

        Raises:
            UnknownName: One of them has none.
        """
        assert self._results is not None
        manifest = self._results.manifest
        spec = lookup("robot by name", manifest.robots[robot], dict.fromkeys(names(), manifest.robots[robot]))
        drawn = lookup("case by name", manifest.cases[case].spec, CASES)
        return WorkItem(robot, spec, drawn, number, (), manifest.budget, manifest.rng).draw()
