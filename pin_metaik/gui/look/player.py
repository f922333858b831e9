"""Something that moves in time: played, held, and looked at at any moment."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

from pin_metaik.gui.tab import Tab

FRAME = 0.05  # s between two pictures


class Player:
    """Controls in the panel that play a motion.

    Args:
        tab: The tab.
        show: Called with the time, s, of the moment to show.
    """

    def __init__(self, tab: Tab, show: Callable[[float], None]) -> None:
        self._tab, self._show = tab, show
        self._playing = threading.Event()
        self._closed = False
        gui = tab.client.gui
        self._time = gui.add_slider("Time, s", min=0.0, max=1.0, step=0.01, initial_value=0.0, disabled=True)
        self._time.on_update(tab.doing(lambda: self._show(self._time.value)))
        self._button = gui.add_button("Play", disabled=True)
        self._button.on_click(tab.doing(self._toggle))

    def take(self, seconds: float) -> None:
        """Take a motion of so many seconds, from its beginning."""
        self.stop()
        self._time.max = max(seconds, 0.01)
        self._time.disabled = self._button.disabled = False
        self._time.value = 0.0
        self._show(0.0)

    def stop(self) -> None:
        """Hold it where it is."""
        self._playing.clear()
        self._button.label = "Play"

    def close(self) -> None:
        """End it for good."""
        self._closed = True
        self._playing.clear()

    def _toggle(self) -> None:
        if self._playing.is_set():
            self.stop()
            return
        if self._time.value >= self._time.max:
            self._time.value = 0.0
        self._playing.set()
        self._button.label = "Hold"
        threading.Thread(target=self._run, name="plays a motion", daemon=True).start()

    def _run(self) -> None:
        last = time.monotonic()
        while self._playing.is_set():
            time.sleep(FRAME)
            with self._tab.lock:
                if self._closed or self._tab.closed or not self._playing.is_set():
                    return
                now = time.monotonic()
                moment, last = min(self._time.value + now - last, self._time.max), now
                self._time.value = moment
                with self._tab.client.atomic():
                    self._show(moment)
                if moment >= self._time.max:
                    self.stop()
