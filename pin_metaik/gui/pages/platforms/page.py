"""The page of Stewart platforms: one mechanism, in the wizard that designs it and the simulator that shows it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from pin_metaik.gui.kept import plain_of, state_of
from pin_metaik.gui.look.camera import aim
from pin_metaik.gui.pages.platforms.simulator import Simulator, home_of
from pin_metaik.gui.pages.platforms.state import FIRST, PlatformsState
from pin_metaik.gui.pages.platforms.wizard import Wizard
from pin_metaik.gui.tab import Tab
from pin_metaik.stewart import Mechanism, load_mechanism, pose_at, read_mechanism, to_toml


class PlatformsPage:
    """One mechanism.

    Args:
        tab: The tab.
        values: What the page keeps.
    """

    def __init__(self, tab: Tab, values: Mapping[str, Any]) -> None:
        self._tab = tab
        self._state = state_of(PlatformsState, values, "the page of Stewart platforms")
        self._mechanism = self._read(self._state.mechanism)
        gui = tab.client.gui
        pose = home_of(self._mechanism)
        if self._state.xyz:
            pose = pose_at(self._state.xyz, self._state.rpy)
        gui.add_markdown(f"**{self._mechanism.name}**: {self._mechanism.geometry}")
        with gui.add_folder("Simulator"):
            self._simulator = Simulator(tab, self._mechanism, pose)
        with gui.add_folder("Design wizard"):
            Wizard(tab, self._mechanism, self._take)
        height, radius = float(pose[2, 3]), float(self._mechanism.geometry.base_radius)
        eye = (2.2 * radius + height, 1.6 * radius + height, 1.1 * height + radius)
        aim(tab, eye, (0.0, 0.0, 0.5 * height))

    def kept(self) -> dict[str, Any]:
        """See ``Page``."""
        return plain_of(
            replace(
                self._state,
                mechanism=to_toml(self._mechanism),
                xyz=self._simulator.xyz,
                rpy=self._simulator.rpy,
            )
        )

    def close(self) -> None:
        """See ``Page``."""
        self._simulator.close()

    def _read(self, text: str) -> Mechanism:
        if not text:
            return load_mechanism(FIRST)
        path = self._tab.folder / "kept.toml"
        path.write_text(text, encoding="utf-8")
        return read_mechanism(path)

    def _take(self, mechanism: Mechanism) -> None:
        """Open the page with another mechanism."""
        self._tab.show_with(self._tab.name, {"mechanism": to_toml(mechanism)})
