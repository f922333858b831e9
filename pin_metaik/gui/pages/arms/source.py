"""Where the robot comes from: a name, link lengths, a DH table that is typed, a URDF that is sent."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from dataclasses import replace
from typing import Any, get_args

from pin_metaik.errors import InvalidModel
from pin_metaik.gui.look.pieces import Drawn
from pin_metaik.gui.pages.arms import arm as arms
from pin_metaik.gui.pages.arms.state import ArmsState
from pin_metaik.gui.pages.arms.table import FIRST, TableForm
from pin_metaik.gui.tab import Tab
from pin_metaik.robots import read_table, to_urdf
from pin_metaik.robots.library import catalogue

Take = Callable[[ArmsState], None]


class SourceControls:
    """What chooses the robot.

    Args:
        tab: The tab.
        state: What there is at first.
        take: Called with a state that has another robot.
    """

    def __init__(self, tab: Tab, state: ArmsState, take: Take) -> None:
        self._tab, self._state, self._take_state = tab, state, take
        gui = tab.client.gui
        known = arms.names()
        name = state.robot if state.robot in known else known[0]
        self._name = gui.add_dropdown(
            "Robot", known, initial_value=name, hint="By name: the catalogue, and example-robot-data."
        )
        self._name.on_update(tab.doing(lambda: self._choose(self._name.value)))
        drawn = gui.add_dropdown(
            "Drawn as", get_args(Drawn), initial_value=state.drawn, hint="Meshes of some take seconds."
        )
        drawn.on_update(tab.doing(lambda: self._take(replace(self._state, drawn=drawn.value))))
        upload = gui.add_upload_button("Open a URDF, an MJCF or a table", mime_type=".urdf,.xml,.toml,.zip")
        upload.on_upload(
            tab.doing(lambda: self._open(tab.received(upload, ".urdf", ".xml", ".toml")), "That robot is not taken")
        )
        self._lengths = gui.add_folder("Link lengths", expand_by_default=True, visible=False)
        self._lengths_box: Any = None
        with gui.add_folder("DH table", expand_by_default=bool(state.table)):
            begin = gui.add_button("Type a table", hint="Begins with the table of the robot above, if it has one.")
            begin.on_click(tab.doing(self._type))
            self._holder = gui.add_folder(None)
            self._box: Any = None
            self._form: Any = None
            as_toml = gui.add_button("Download as TOML")
            as_toml.on_click(tab.doing(lambda: tab.download("table.toml", self._table())))
            as_urdf = gui.add_button("Download as URDF")
            as_urdf.on_click(tab.doing(lambda: tab.download("robot.urdf", self._urdf())))
        if state.table:
            self._show_form(state.table)
        self._show_lengths()

    def _choose(self, name: str) -> None:
        self._take(replace(self._state, robot=name, table="", urdf="", parameters={}))
        self._show_lengths()

    def _take(self, state: ArmsState) -> None:
        """Have the page take a robot; one that it refuses is forgotten."""
        self._take_state(state)
        self._state = state

    def _open(self, path: Any) -> None:
        text = path.read_text(encoding="utf-8-sig", errors="replace")
        if path.suffix.lower() == ".toml":
            self._take(replace(self._state, table=text, urdf="", parameters={}))
            self._show_form(text)
        else:
            self._take(replace(self._state, table="", urdf=text, parameters={}))
        self._show_lengths()

    def _type(self) -> None:
        text = self._table() if self._state.table or self._named_table() else FIRST
        self._show_form(text)
        self._take(replace(self._state, table=self._form.text, urdf="", parameters={}))
        self._show_lengths()

    def _show_form(self, text: str) -> None:
        if self._box is not None:
            self._box.remove()
        with self._holder:
            self._box = self._tab.client.gui.add_folder(None)
        with self._box:
            self._form = TableForm(self._tab, text, lambda typed: self._take(replace(self._state, table=typed)))

    def _named_table(self) -> bool:
        return not self._state.urdf and self._state.robot in catalogue()

    def _table(self) -> str:
        """The TOML of the robot's table.

        Raises:
            InvalidModel: It comes from no table.
        """
        if self._state.table:
            return self._state.table
        if self._named_table():
            return catalogue()[self._state.robot].read_text(encoding="utf-8")
        raise InvalidModel(
            f"{self._state.robot} comes from no DH table: type one, or choose one of {', '.join(catalogue())}"
        )

    def _urdf(self) -> str:
        """The URDF of the robot's table, or of the robot."""
        if self._state.table or self._named_table():
            path = self._tab.folder / "download.toml"
            path.write_text(self._table(), encoding="utf-8")
            return to_urdf(read_table(path, self._state.parameters or None))
        return arms.Arm.of(self._state, self._tab.folder).robot.urdf

    def _show_lengths(self) -> None:
        """Inputs for the parameters of a table of the catalogue."""
        if self._lengths_box is not None:
            self._lengths_box.remove()
            self._lengths_box = None
        parameters = {}
        if not self._state.table and self._named_table():
            parameters = tomllib.loads(self._table()).get("parameters", {})
        self._lengths.visible = bool(parameters)
        if not parameters:
            return
        with self._lengths:
            self._lengths_box = self._tab.client.gui.add_folder(None)
        with self._lengths_box:
            handles = {
                name: self._tab.client.gui.add_number(name, float(self._state.parameters.get(name, value)), step=0.001)
                for name, value in parameters.items()
            }

        def typed() -> None:
            self._take(replace(self._state, parameters={name: handle.value for name, handle in handles.items()}))

        for handle in handles.values():
            handle.on_update(self._tab.doing(typed))
