"""A toolbox and a Chromium for the tests of a module: one of each, and a fresh tab a test."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest

WAIT = 60_000.0  # ms, of a machine that does other things as well
ARGUMENTS = (
    "--headless --no-sandbox --disable-gpu --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader "
    "--disable-quic --no-first-run --disable-background-networking --disable-component-update --disable-sync"
)


@pytest.fixture(scope="module")
def toolbox() -> Iterator[Any]:
    """A toolbox on loopback, at any port."""
    for package in ("viser", "trimesh", "shapely"):
        pytest.importorskip(package)
    from pin_metaik.gui import open_toolbox

    with open_toolbox(port=0) as opened:
        yield opened
    assert not opened.tabs and not opened.pids


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    """Debian's Chromium, driven by Playwright."""
    found = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    playwright = pytest.importorskip("playwright.sync_api")
    if found is None and os.environ.get("PIN_METAIK_REQUIRE_CHROMIUM") == "1":
        pytest.fail("PIN_METAIK_REQUIRE_CHROMIUM=1 and there is no chromium")
    if found is None:
        pytest.skip("no chromium here")
    with playwright.sync_playwright() as started:
        browser = started.chromium.launch(executable_path=found, args=ARGUMENTS.split())
        yield browser
        browser.close()


class Page:
    """A tab, in the words of somebody who uses it.

    Attributes:
        page: Playwright's.
        asked: Hosts that the tab asked for anything.
    """

    def __init__(self, chromium: Any, url: str) -> None:
        self._context = chromium.new_context(viewport={"width": 1000, "height": 640})
        self._context.set_default_timeout(WAIT)
        self.page = self._context.new_page()
        self.asked: set[str] = set()
        self.faults: list[str] = []
        self.page.on("request", lambda request: self.asked.add(urlsplit(request.url).hostname or ""))
        self.page.on("websocket", lambda socket: self.asked.add(urlsplit(socket.url).hostname or ""))
        self.page.on("pageerror", lambda error: self.faults.append(str(error)))
        self.page.goto(url)
        self.see("This tab")

    def see(self, text: str) -> None:
        """Wait until a text is there."""
        self.page.get_by_text(text).first.wait_for()

    def text(self) -> str:
        """All that is written."""
        return str(self.page.locator("body").inner_text())

    def open(self, *folders: str) -> None:
        """Open folders of the panel that are closed."""
        for folder in folders:
            self.page.get_by_text(folder, exact=True).last.click()

    def click(self, button: str) -> None:
        """Click a button."""
        self.page.get_by_role("button", name=button, exact=True).first.click()

    def choose(self, label: str, value: str) -> None:
        """Choose an entry of a list."""
        self.page.get_by_label(label, exact=True).first.click()
        self.page.get_by_role("option", name=value, exact=True).first.click()

    def type(self, label: str, value: str) -> None:
        """Type into an input."""
        box = self.page.get_by_label(label, exact=True).first
        box.fill(value)
        box.press("Enter")

    def send(self, button: str, file: Path) -> None:
        """Send a file by an upload button."""
        with self.page.expect_file_chooser() as chooser:
            self.click(button)
        chooser.value.set_files(file)

    def close(self) -> None:
        """Close it."""
        self._context.close()


@pytest.fixture
def tab(toolbox: Any, chromium: Any) -> Iterator[Page]:
    """A tab with the first page; nothing that it asks for leaves this machine."""
    opened = Page(chromium, toolbox.url)
    yield opened
    opened.close()
    assert opened.asked <= {"127.0.0.1", ""}, opened.asked  # "": data that the page carries itself
    assert not opened.faults
