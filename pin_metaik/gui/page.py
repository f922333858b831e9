"""What a page is: something that a tab opens with what it keeps, and closes with all of its work."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol


class Page(Protocol):
    """A page that is open in a tab. It is built inside a folder of the panel and under a node of the scene."""

    def kept(self) -> dict[str, Any]:
        """What it keeps, as plain values: opening it with them shows the same again."""
        ...

    def close(self) -> None:
        """End its work. What it has in the panel and in the scene is taken away by the tab."""
        ...


Open = Callable[[Any, Mapping[str, Any]], Page]
"""Of a ``Tab`` and what the page keeps."""


@dataclass(frozen=True)
class Entry:
    """A page in the registry.

    Attributes:
        title: In the list of pages.
        open: Opens it in a tab with what it keeps.
    """

    title: str
    open: Open
