"""A tab of a browser: a session of its own, with its pages, its folder and its work, which end when it is closed."""

from __future__ import annotations

import shutil
import tempfile
import threading
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from pin_metaik.errors import InvalidSetting, MetaIKError, UnknownName
from pin_metaik.gui import kept
from pin_metaik.gui.page import Entry, Page
from pin_metaik.gui.uploads import received
from pin_metaik.gui.words import FOLDER, RED, in_words, say, told
from pin_metaik.processes import Crew, Run, Told, Work

ROOT = "/page"
PANEL_WIDTH = 420.0  # pixels
MOST_RUNS = 4  # at a time, of one tab

Callback = Callable[[], None]


class Tab:
    """One browser tab.

    Args:
        client: Its ``viser.ClientHandle``.
        pages: The pages by name.
        crew: The processes for long work.
        address: Where the toolbox is.
        place: Path of the address it was opened with.

    Attributes:
        client: Its ``viser.ClientHandle``.
        folder: Where files that are uploaded here are kept; gone when the tab is.
        name: The page that is open.
        page: That page.
        lock: Held by whatever changes the tab: callbacks come one after the other.
    """

    def __init__(self, client: Any, pages: Mapping[str, Entry], crew: Crew, address: str, place: str) -> None:
        self.client, self._pages, self._crew, self._address = client, pages, crew, address
        self.folder = Path(tempfile.mkdtemp(prefix=FOLDER))
        self.lock = threading.RLock()
        self.closed = False
        self.page: Page | None = None
        self._opened = 0  # pages so far: what is told of work for one that is gone goes nowhere
        self.name = next(iter(pages))
        self._kept: dict[str, dict[str, Any]] = {}
        self._runs: list[Run] = []
        self._panel: Any = None
        self._titles = {entry.title: name for name, entry in pages.items()}
        with self.lock, client.atomic():
            self._furnish()
            with told(client, "The state in the address is left out"):
                self._take(kept.from_address(place))
            self.show(self.name)

    def show(self, name: str) -> None:
        """Open a page, and close the one that is open.

        Raises:
            UnknownName: There is no such page.
        """
        if name not in self._pages:
            raise UnknownName("page", name, self._pages)
        with self.lock, self.client.atomic():
            self._leave()
            self._opened += 1
            self.name, entry = name, self._pages[name]
            self._chosen.value = entry.title
            try:
                self._build(entry, self._kept.get(name, {}))
            except MetaIKError as error:  # of what it kept
                say(self.client, entry.title, f"{in_words(error)}; the page opens as new", RED)
                self._clear()
                self._build(entry, {})

    def show_with(self, name: str, values: Mapping[str, Any]) -> None:
        """Open a page with these values in place of what it kept."""
        with self.lock:
            self._kept[name] = dict(values)
            if self.name == name:
                self._drop()
            self.show(name)

    def doing(self, work: Callback, title: str = "That does not work") -> Callable[[Any], None]:
        """A callback for viser: one at a time, none once the tab is closed, and errors are said in words.

        What a page sets itself, in place of whoever looks at it, calls nothing.
        """

        def call(event: Any) -> None:
            if event.client is None:
                return
            with self.lock:
                if not self.closed:
                    with told(self.client, title):
                        work()

        return call

    def received(self, handle: Any, *suffixes: str) -> Path:
        """The file that was just sent with an upload button, kept in the tab's folder.

        Raises:
            InvalidSetting: It is too large, or of another kind.
        """
        sent = handle.value
        return received(sent.name, sent.content, self.folder, suffixes)

    def download(self, name: str, content: str | bytes) -> None:
        """Have the browser save a file."""
        data = content.encode() if isinstance(content, str) else content
        self.client.send_file_download(name, data, save_immediately=True)

    def begin(
        self,
        work: Work,
        tell: Callable[[Told], None],
        end: Callable[[Run], None],
        *,
        held: bool = False,
        pause: float = 0.0,
    ) -> Run:
        """Hand over long work of the page; what is told of it comes under the tab's lock, while the page is open.

        Raises:
            InvalidSetting: The tab has too many runs going on.
        """
        self._runs = [run for run in self._runs if not run.over]
        if len(self._runs) >= MOST_RUNS:
            raise InvalidSetting(f"{MOST_RUNS} runs are going on in this tab already: stop one")

        opened = self._opened

        def telling(message: Told) -> None:
            with self.lock:
                if not self.closed and opened == self._opened:
                    with told(self.client):
                        tell(message)

        def ending(run: Run) -> None:
            with self.lock:
                if not self.closed and opened == self._opened:
                    with told(self.client):
                        if run.error is not None:
                            raise run.error
                    with told(self.client):
                        end(run)

        run = self._crew.begin(work, telling, ending, held=held, pause=pause)
        self._runs.append(run)
        return run

    def close(self) -> None:
        """End all of its work, and take its folder away."""
        with self.lock:
            if self.closed:
                return
            self.closed = True
            page, self.page = self.page, None
            runs, self._runs = self._runs, []
        if page is not None:
            page.close()
        for run in runs:
            run.stop()
        shutil.rmtree(self.folder, ignore_errors=True)

    def state(self) -> tuple[str, dict[str, dict[str, Any]]]:
        """The page that is open, and what each page keeps."""
        with self.lock:
            self._remember()
            return self.name, {name: values for name, values in self._kept.items() if values}

    def _leave(self) -> None:
        """Close the page that is open, keeping what it keeps."""
        self._remember()
        self._drop()
        self._clear()

    def _remember(self) -> None:
        """Keep what the page keeps; where it makes no sense, what it kept before."""
        if self.page is not None:
            with told(self.client, "What was typed is not kept"):
                self._kept[self.name] = self.page.kept()

    def _build(self, entry: Entry, values: Mapping[str, Any]) -> None:
        """Open a page in the panel and in the scene."""
        self._panel = self.client.gui.add_folder(None, order=1.0)
        self.client.scene.add_frame(ROOT, show_axes=False)
        with self._panel:
            self.page = entry.open(self, values)

    def _clear(self) -> None:
        """Take away what the page has in the panel and in the scene."""
        if self._panel is not None:
            self._panel.remove()
            self._panel = None
            self.client.scene.remove_by_name(ROOT)

    def _drop(self) -> None:
        """End the work of the page that is open."""
        page, self.page = self.page, None
        if page is not None:
            page.close()
        for run in self._runs:
            run.stop()

    def _take(self, state: tuple[str, dict[str, dict[str, Any]]] | None) -> None:
        """Take over a state."""
        if state is not None:
            name, values = state
            for page in (name, *values):
                if page not in self._pages:
                    raise UnknownName("page", page, self._pages)
            self.name, self._kept = name, values

    def _furnish(self) -> None:
        """What is there on every page: the list of pages, and the tab's own folder below the page."""
        gui = self.client.gui
        self._look(dark=False)
        gui.set_panel_label("pin_metaik toolbox")
        gui.main_panel.dock_right()
        gui.main_panel.set_width(PANEL_WIDTH)
        self._chosen = gui.add_dropdown("Page", tuple(self._titles), order=0.0, hint="Pages keep what is in them.")
        self._chosen.on_update(self.doing(lambda: self._choose(self._titles[self._chosen.value])))
        for title, name in self._titles.items():
            command = gui.add_command(f"Page: {title}")
            command.on_trigger(self.doing(lambda name=name: self._choose(name)))  # type: ignore[misc]
        with gui.add_folder("This tab", order=2.0, expand_by_default=False):
            dark = gui.add_checkbox("Dark", initial_value=False, hint="Light or dark colours.")
            dark.on_update(self.doing(lambda: self._look(dark.value)))
            save = gui.add_button("Save to a file", hint="What all pages of this tab keep, as JSON.")
            save.on_click(self.doing(lambda: self.download("toolbox.json", kept.to_text(*self.state()))))
            load = gui.add_upload_button("Open a saved file", mime_type="application/json")
            load.on_upload(self.doing(lambda: self._load(load), "That file is not taken"))
            share = gui.add_button("Address to share", hint="What all pages of this tab keep, in an address.")
            self._link = gui.add_markdown("", visible=False)
            share.on_click(self.doing(self._share))

    def _look(self, dark: bool) -> None:
        self.client.gui.configure_theme(
            dark_mode=dark, show_logo=False, show_share_button=False, control_width="large", brand_color=(30, 90, 160)
        )

    def _choose(self, name: str) -> None:
        if name != self.name:
            self.show(name)

    def _load(self, handle: Any) -> None:
        path = self.received(handle, ".json")
        state = kept.from_text(path.read_bytes(), path.name)
        self._take(state)
        self._drop()
        self.show(self.name)

    def _share(self) -> None:
        address = self._address + kept.to_address(*self.state())
        self._link.content, self._link.visible = f"[this page, as it is now]({address})\n\n`{address}`", True
