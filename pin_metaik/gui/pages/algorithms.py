"""A metaheuristic as pages choose it: a name, and inputs for the settings that it has."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from pin_metaik.errors import InvalidSetting
from pin_metaik.gui.forms import SettingsForm
from pin_metaik.gui.tab import Tab
from pin_metaik.lookup import lookup
from pin_metaik.optimize import ALGORITHMS, Metaheuristic

POPULATION = ("agents", "frogs")  # what algorithms call the size of theirs
OWN_SIZE = 50  # for the number of evaluations, where an algorithm chooses the size itself


def made(name: str, settings: Mapping[str, Any]) -> Metaheuristic:
    """A metaheuristic with some settings.

    Raises:
        UnknownName: None is so called.
        InvalidSetting: It has no such settings.
    """
    kind = lookup("metaheuristic", name, ALGORITHMS)
    try:
        return kind(**settings)
    except TypeError as error:
        raise InvalidSetting(f"{name} has not all of the settings {', '.join(settings)}: {error}") from None


def population(algorithm: Metaheuristic) -> int:
    """How many search at a time."""
    sizes = (getattr(algorithm, name, None) for name in POPULATION)
    return next((size for size in sizes if size), OWN_SIZE)


class AlgorithmForm:
    """A list of the metaheuristics, and the settings of the one that is chosen.

    Args:
        tab: The tab.
        label: Of the list.
        name: The one at first.
        settings: Those of it that are not the usual ones.
        expanded: Whether the settings are open at first.
    """

    def __init__(self, tab: Tab, label: str, name: str, settings: Mapping[str, Any], *, expanded: bool = True) -> None:
        self._tab = tab
        gui = tab.client.gui
        self._name = gui.add_dropdown(label, tuple(ALGORITHMS), initial_value=name)
        self._name.on_update(tab.doing(lambda: self._furnish({})))
        self._folder = gui.add_folder(f"Settings: {label.lower()}", expand_by_default=expanded)
        self._box: Any = None
        self._form: SettingsForm
        self._furnish(settings)

    @property
    def name(self) -> str:
        """The one that is chosen."""
        return str(self._name.value)

    @property
    def algorithm(self) -> Metaheuristic:
        """It, with its settings.

        Raises:
            InvalidSetting: One of them makes no sense.
        """
        algorithm: Metaheuristic = self._form.settings
        return algorithm

    @property
    def changed(self) -> dict[str, Any]:
        """The settings that are not the usual ones."""
        settings: Any = self.algorithm
        usual = asdict(type(settings)())
        return {name: value for name, value in asdict(settings).items() if value != usual[name]}

    def _furnish(self, settings: Mapping[str, Any]) -> None:
        """Inputs for the one that is chosen, and none of another's."""
        if self._box is not None:
            self._box.remove()
        with self._folder:
            self._box = self._tab.client.gui.add_folder(None)
        with self._box:
            self._form = SettingsForm(self._tab, made(self.name, settings))
