"""What a page is: something that a tab opens with what it keeps, and closes with all of its work."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import Any, Protocol


class Page(Protocol):
    """A page that is open in a tab. It is built inside a folder of the panel and under a node of the scene."""

    def kept(self) -> dict[str, Any]:
        """What it keeps, as plain values: opening it with them shows the same again."""
        ...

    def close(self) -> None:
        """End its work. What it has in the panel and in the scene is taken away by the tab."""
        ...


@dataclass(frozen=True)
class Entry:
    """A page in the registry. Its module is imported when it is first opened: the first page need not wait for others.

    Attributes:
        title: In the list of pages.
        module: Where its class is.
        name: Of its class, which takes a ``Tab`` and what the page keeps.
    """

    title: str
    module: str
    name: str

    def open(self, tab: Any, values: Mapping[str, Any]) -> Page:
        """Open it in a tab with what it keeps."""
        page: Page = getattr(import_module(self.module), self.name)(tab, values)
        return page
