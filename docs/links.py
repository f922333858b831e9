"""Check the links of the site as it is built: every page, picture and anchor that a page names is there.

python docs/links.py build/docs
"""

from __future__ import annotations

import sys
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

NAMES = {"a": "href", "link": "href", "img": "src", "script": "src", "source": "src", "object": "data"}
TYPES = {".html"}


class Page(HTMLParser):
    """What a page names, and what it can be named by.

    Attributes:
        links: Addresses of what it links to or shows.
        anchors: Names of places in it.
    """

    def __init__(self) -> None:
        super().__init__()
        self.links: list[str] = []
        self.anchors: set[str] = {"", "top"}

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Take what the tag names."""
        given = {name: value for name, value in attrs if value is not None}
        self.anchors |= {given[name] for name in ("id", "name") if name in given}
        if tag in NAMES and NAMES[tag] in given:
            self.links.append(given[NAMES[tag]])


@cache
def read(file: Path) -> Page:
    """A page of the site."""
    page = Page()
    page.feed(file.read_text(encoding="utf-8"))
    return page


def broken(site: Path) -> list[str]:
    """Links inside the site that lead nowhere, each with the page that has it."""
    found = []
    for file in sorted(set(site.rglob("*.html")) - set((site / "_static").rglob("*"))):  # there the theme has templates
        for link in read(file).links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = file if not parts.path else (file.parent / unquote(parts.path)).resolve()
            if not target.is_file():
                found.append(f"{file.relative_to(site)}: {link}")
            elif target.suffix in TYPES and unquote(parts.fragment) not in read(target).anchors:
                found.append(f"{file.relative_to(site)}: {link}, which has no such place")
    return found


if __name__ == "__main__":
    missing = broken(Path(sys.argv[1]).resolve())
    print("\n".join(missing) or "every internal link leads somewhere")
    sys.exit(1 if missing else 0)
