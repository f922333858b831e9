"""Information: the documentation's own text, and what the code says of itself, a page for each subject."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Mapping
from functools import partial
from importlib.resources import files
from pathlib import Path
from typing import Any

from pin_metaik import goals
from pin_metaik.compare import CASES
from pin_metaik.errors import InvalidSetting
from pin_metaik.gui.tab import Tab
from pin_metaik.mobile import FITNESSES
from pin_metaik.optimize import ALGORITHMS
from pin_metaik.stewart import DesignTask

PACKAGED = "docs"  # in the package of a wheel, which is built with these files; else they are beside the package
DOCUMENTS: dict[str, str] = {
    "Problem: paths among polygons": "teaching_paths.md",
    "Problem: Stewart platforms": "teaching_stewart.md",
    "Problem: all solutions of an arm": "complete_sets.md",
    "Problem: goals of an arm": "goals.md",
    "Problem: motions": "motions.md",
    "Problem: vehicles": "vehicles.md",
    "Problem: platforms moved by servos": "servo_platforms.md",
    "Paper: paths by GA and PSO": "papers/path_planning.md",
    "Paper: Puma by GA and PSO": "papers/puma_offset.md",
    "Paper: Stewart platforms": "papers/stewart.md",
    "Paper: RV-7FL": "papers/rv7fl.md",
    "Paper: aerial arm": "papers/aerial_arm.md",
    "Paper: time-optimal trajectories": "papers/trajectory.md",
    "This toolbox": "toolbox.md",
}
IMAGE = re.compile(r"!\[([^\]]*)\]\([^)]*\)")
LINK = re.compile(r"\[([^\]]+)\]\((?!https?:)[^)]*\)")
ENTRY = re.compile(r"^ {4}(\w[\w, ]*): ")


def document(name: str) -> str:
    """A page of the documentation as Markdown; pictures are named, as they are not in the package."""
    packaged = files("pin_metaik.gui") / PACKAGED / name
    beside = Path(__file__).parents[3] / PACKAGED / name
    text = (packaged if packaged.is_file() else beside).read_text(encoding="utf-8")
    return LINK.sub(r"\1", IMAGE.sub(r"*picture: \1*", text))


def docstring(thing: Any) -> str:
    """What the code says of something, with its settings as a list."""
    lines = (inspect.getdoc(thing) or "").splitlines()
    return "\n".join(ENTRY.sub(r"- **\1**: ", line) for line in lines).replace("``", "`")


def _of_case(name: str) -> str:
    case = CASES[name]
    return f"{case.about}\n\n{case.success}"


SUBJECTS: dict[str, Callable[[], str]] = {
    **{title: partial(document, name) for title, name in DOCUMENTS.items()},
    **{f"Algorithm: {name}": partial(docstring, kind) for name, kind in ALGORITHMS.items()},
    **{f"Objective of paths: {name}": partial(docstring, kind) for name, kind in FITNESSES.items()},
    "Objective of platforms": partial(docstring, DesignTask),
    **{f"Goal: {name}": partial(docstring, kind) for name, kind in goals.GOALS.items()},
    **{f"Case: {name}": partial(_of_case, name) for name in CASES},
}


class InformationPage:
    """One subject.

    Args:
        tab: The tab.
        values: The subject.
    """

    def __init__(self, tab: Tab, values: Mapping[str, Any]) -> None:
        subject = values.get("subject", next(iter(SUBJECTS)))
        if set(values) - {"subject"} or subject not in SUBJECTS:
            raise InvalidSetting(f"the page of information keeps a subject, got {values!r}")
        gui = tab.client.gui
        self._subject = gui.add_dropdown("Subject", tuple(SUBJECTS), initial_value=subject)
        self._text = gui.add_markdown(SUBJECTS[subject]())
        self._subject.on_update(tab.doing(self._show))

    def kept(self) -> dict[str, Any]:
        """See ``Page``."""
        return {"subject": self._subject.value}

    def close(self) -> None:
        """See ``Page``. There is no work."""

    def _show(self) -> None:
        self._text.content = SUBJECTS[self._subject.value]()
