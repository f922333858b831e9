"""A tab of the toolbox in Chromium, in the words of somebody who uses it: for pictures, measurements and tests."""

from __future__ import annotations

import shutil
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

WAIT = 180_000.0  # ms, of a machine that does other things as well
TRIES = 6  # clicks, where one may be lost
ARGUMENTS = (
    "--headless --no-sandbox --disable-gpu --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader "
    "--disable-quic --no-first-run --disable-background-networking --disable-component-update --disable-sync"
)
SIZE = (1280, 800)
COARSE = "?fixedDpr=0.2"  # after an address: viser draws a fifth of the pixels each way


def chromium_path() -> str | None:
    """Where Chromium is."""
    return shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


def launched(playwright: Any) -> Any:
    """Chromium without a window; it draws by the processor."""
    return playwright.chromium.launch(executable_path=chromium_path(), args=ARGUMENTS.split())


class Page:
    """A tab, in the words of somebody who uses it.

    Attributes:
        page: Playwright's.
        folder: For files to send.
        asked: Hosts that the tab asked for anything; "" for data that the page carries itself.
        faults: What its scripts stumbled over.
    """

    def __init__(self, chromium: Any, url: str, size: tuple[int, int] = SIZE) -> None:
        self._context = chromium.new_context(viewport={"width": size[0], "height": size[1]})
        self._context.set_default_timeout(WAIT)
        self.page = self._context.new_page()
        self.folder = tempfile.mkdtemp()
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
            self._button(folder, "[aria-expanded]").last.click()

    def click(self, button: str) -> None:
        """Click a button."""
        self._button(button, "button").first.click()

    def _button(self, name: str, kind: str) -> Any:
        """Buttons of a name that are of a kind: folders are opened by buttons, too, which may have a name of one."""
        return self.page.get_by_role("button", name=name, exact=True).and_(self.page.locator(kind))

    def click_until(self, button: str, text: str) -> None:
        """Click a button until a text is there: a click is lost on a button that is just being made anew."""
        from playwright.sync_api import TimeoutError as TooLate

        for _ in range(TRIES):
            self.click(button)
            try:
                self.page.get_by_text(text).first.wait_for(timeout=WAIT / TRIES)
            except TooLate:
                continue
            return
        self.see(text)

    def choose(self, label: str, value: str) -> None:
        """Choose an entry of a list."""
        self.page.get_by_label(label, exact=True).first.click()
        self.page.get_by_role("option", name=value, exact=True).first.click()

    def type(self, label: str, value: str) -> None:
        """Type into an input."""
        box = self.page.get_by_role("textbox", name=label, exact=True).first
        box.fill(value)
        box.press("Enter")

    def wait_until(self, met: Callable[[], bool]) -> None:
        """Wait until something is so."""
        end = time.monotonic() + WAIT / 1e3
        while not met():
            if time.monotonic() > end:
                raise TimeoutError(self.text())
            time.sleep(0.1)

    def drag_mouse(self, start: tuple[float, float], end: tuple[float, float]) -> None:
        """Press, move in steps, and let go."""
        self.page.mouse.move(*start)
        self.page.mouse.down()
        self.page.mouse.move(*end, steps=8)
        self.page.mouse.up()

    def scroll_to(self, text: str) -> None:
        """Bring a part of the panel into sight."""
        self.page.get_by_text(text, exact=True).last.evaluate("element => element.scrollIntoView({block: 'start'})")

    def dismiss(self) -> None:
        """Take away what viser says of drawing without a graphics card."""
        for cross in self.page.locator(".mantine-Notification-closeButton").all():
            cross.click()

    def packed(self, folder: Path) -> Path:
        """A folder as a .zip beside it."""
        return Path(shutil.make_archive(str(folder), "zip", folder))

    def send(self, button: str, file: Path) -> None:
        """Send a file by an upload button."""
        with self.page.expect_file_chooser() as chooser:
            self.click(button)
        chooser.value.set_files(file)

    def close(self) -> None:
        """Close it."""
        self._context.close()
        shutil.rmtree(self.folder)
