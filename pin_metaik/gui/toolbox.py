"""The toolbox: a server for browsers, a session for each of their tabs, and an end that leaves nothing running."""

from __future__ import annotations

import contextlib
import io
import os
import secrets
import threading
from typing import Any

import viser

from pin_metaik.arguments import checked
from pin_metaik.errors import InvalidSetting
from pin_metaik.gui.gate import Gate, on_loopback
from pin_metaik.gui.pages import PAGES
from pin_metaik.gui.served import page_of
from pin_metaik.gui.tab import Tab
from pin_metaik.processes import Crew

HIGHEST_PORT = 65_535


class _Server(viser.ViserServer):
    """viser's server without its tunnel: a page may ask for one, to a host on the internet."""

    def request_share_url(self, verbose: bool = True) -> str | None:
        """Give none."""
        return None


class Toolbox:
    """A toolbox that browsers can open.

    Attributes:
        url: Its address; off loopback with the token.
        tabs: The tabs that are open, by viser's number.
    """

    def __init__(self, host: str, port: int) -> None:
        if os.environ.get("_VISER_PORT_OVERRIDE"):
            raise InvalidSetting("_VISER_PORT_OVERRIDE is set, which would let viser take the port of the toolbox")
        with contextlib.redirect_stdout(io.StringIO()):  # viser prints an address that is not for people
            self._server = _Server(host="127.0.0.1", port=0, verbose=False)
        token = None if on_loopback(host) else secrets.token_urlsafe(16)
        try:
            inner = self._server.get_port()
            self._gate = Gate(host, port, inner, token, page_of(inner))
        except InvalidSetting:
            self._server.stop()
            raise
        shown = f"[{host}]" if ":" in host else host
        self._base = f"http://{shown}:{self._gate.port}"
        self.url = self._base + ("/" if token is None else f"/?token={token}")
        self.tabs: dict[int, Tab] = {}
        self._lock = threading.Lock()
        self._crew = Crew()
        self._server.on_client_connect(self._opened)
        self._server.on_client_disconnect(self._closed)

    @property
    def pids(self) -> list[int]:
        """The processes that work for it."""
        return self._crew.pids

    @property
    def busy(self) -> int:
        """How many runs work for all tabs together, or wait for a process."""
        return self._crew.busy

    def close(self) -> None:
        """End all tabs and all work."""
        self._gate.close()
        with self._lock:
            tabs, self.tabs = list(self.tabs.values()), {}
        for tab in tabs:
            tab.close()
        self._crew.close()
        with contextlib.redirect_stdout(io.StringIO()):
            self._server.stop()

    def wait(self) -> None:
        """Wait until Ctrl-C."""
        threading.Event().wait()

    def __enter__(self) -> Toolbox:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _opened(self, client: Any) -> None:
        tab = Tab(client, PAGES, self._crew, self._base, _place(self._server, client))
        with self._lock:
            self.tabs[client.client_id] = tab
            gone = client.client_id not in self._server.get_clients()
        if gone:  # while it was being furnished
            self._closed(client)
        self._crew.prepare()

    def _closed(self, client: Any) -> None:
        with self._lock:
            tab = self.tabs.pop(client.client_id, None)
        if tab is not None:
            tab.close()


@checked
def open_toolbox(host: str = "127.0.0.1", port: int = 8080) -> Toolbox:
    """Start the toolbox, and return.

    Args:
        host: Address to listen on. Off loopback, whoever opens it needs the token that ``url`` has.
        port: Port to listen on; 0 for any that is free.

    Returns:
        The toolbox: its ``url`` is for a browser, ``close()`` ends it and all work, ``wait()`` waits until Ctrl-C.

    Raises:
        InvalidSetting: The port is taken or none, or the host is not this machine's.
    """
    if not 0 <= port <= HIGHEST_PORT:
        raise InvalidSetting(f"a port is 0 to {HIGHEST_PORT}, got {port}")
    return Toolbox(host, port)


def _place(server: Any, client: Any) -> str:
    """The path of the address that a tab was opened with.

    viser has no public name for it; should its inside change, an address opens the first page.
    """
    try:
        path = server._websock_server._live_connections[client.client_id].request.path
    except (AttributeError, KeyError):
        return "/"
    return str(path)
