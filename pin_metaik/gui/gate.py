"""Who may come in: the one port that browsers see, in front of viser's, which takes anybody.

A page of some other site can open a socket to this machine's loopback, and viser would serve it; so every request has
to name this server as its host, and every socket has to come from a page of it. Off loopback, where a host may have any
name, a token is asked for once, in the address, and kept in a cookie.
"""

from __future__ import annotations

import asyncio
import contextlib
import hmac
import ipaddress
import threading
import time
from collections.abc import Mapping
from http import HTTPStatus
from typing import NamedTuple
from urllib.parse import parse_qs, urlsplit

from pin_metaik.errors import InvalidSetting

LONGEST_HEAD = 65_536  # bytes of a request without its body; a page's state in its address is most of it
PATIENCE = 10.0  # s for a request to arrive
MOST_TABS = 64
MOST_SENT = 96 * 2**20  # bytes that a tab may send in a window: twice the largest upload
WINDOW = 60.0  # s
CHUNK = 65_536
COOKIE = "pin_metaik_toolbox"
STATE = "/state/"  # in front of a page's state in an address
LOOPBACK_NAMES = ("localhost", "127.0.0.1", "[::1]")


def on_loopback(host: str) -> bool:
    """Whether an address is this machine's own, which nobody else reaches."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


class Request(NamedTuple):
    """The head of a request.

    Attributes:
        method: GET, mostly.
        target: Path and query.
        headers: Names in lower case.
        version: HTTP/1.1, mostly.
    """

    method: str
    target: str
    headers: Mapping[str, str]
    version: str

    @property
    def upgrades(self) -> bool:
        """Whether it asks for a socket."""
        return self.headers.get("upgrade", "").lower() == "websocket"

    @staticmethod
    def read(head: bytes) -> Request:
        """A request from its head. ValueError: it is none."""
        first, *lines = head.decode("latin-1").rstrip("\r\n").split("\r\n")
        method, target, version = first.split(" ")
        pairs = (line.partition(":") for line in lines)
        return Request(method, target, {name.strip().lower(): value.strip() for name, _, value in pairs}, version)

    @property
    def wants_page(self) -> bool:
        """Whether it asks for the one page, at its own address or at one with a state in it."""
        path = urlsplit(self.target).path
        return self.method == "GET" and not self.upgrades and (path == "/" or path.startswith(STATE))

    def head(self) -> bytes:
        """The request as viser gets it."""
        headers = {**self.headers} if self.upgrades else {**self.headers, "connection": "close"}
        lines = [f"{self.method} {self.target} {self.version}"]
        lines += [f"{name}: {value}" for name, value in headers.items()]
        return ("\r\n".join(lines) + "\r\n\r\n").encode("latin-1")


class Refused(Exception):
    """A request that is not let in.

    Attributes:
        status: HTTP's.
        headers: Of the answer.
    """

    def __init__(self, status: HTTPStatus, why: str, headers: Mapping[str, str] | None = None) -> None:
        self.status, self.headers = status, headers or {}
        super().__init__(why)

    def answer(self) -> bytes:
        """The answer, a line of text."""
        return answer(self.status, "text/plain", f"{self}\n".encode(), self.headers)


def answer(status: HTTPStatus, kind: str, body: bytes, more: Mapping[str, str]) -> bytes:
    """An answer with a body of a kind, after which the connection ends."""
    fixed = {"Content-Type": f"{kind}; charset=utf-8", "Content-Length": str(len(body)), "Connection": "close"}
    lines = [f"HTTP/1.1 {status.value} {status.phrase}"]
    lines += [f"{name}: {value}" for name, value in {**fixed, **more}.items()]
    return ("\r\n".join(lines) + "\r\n\r\n").encode() + body


class Gate:
    """A port that gives the page, and hands on to another one what else may come in.

    Args:
        host: Address to listen on.
        port: Port there; 0 for one that is free.
        inner: Port of viser, on loopback.
        token: What an address must have once as ``?token=``; None on loopback.
        page: The page.

    Attributes:
        port: The port it listens on.
        tabs: Sockets that are open.

    Raises:
        InvalidSetting: The port is taken, or the host is not this machine's.
    """

    def __init__(self, host: str, port: int, inner: int, token: str | None, page: bytes) -> None:
        self._host, self._inner, self._token = host, inner, token
        self._page = answer(HTTPStatus.OK, "text/html", page, {"Cache-Control": "no-store"})
        self.port, self.tabs = port, 0
        self._loop = asyncio.new_event_loop()
        self._end = asyncio.Event()
        listening: list[OSError | None] = []
        ready = threading.Event()

        def run() -> None:
            asyncio.set_event_loop(self._loop)
            self._loop.run_until_complete(self._listen(listening, ready))
            self._loop.close()

        self._thread = threading.Thread(target=run, name="gate of the toolbox", daemon=True)
        self._thread.start()
        ready.wait()
        if listening[0] is not None:
            reason = listening[0].strerror or listening[0]
            raise InvalidSetting(f"cannot listen on {host}, port {port}: {reason}; port 0 is any that is free")

    def close(self) -> None:
        """Stop listening, and cut what is open."""
        with contextlib.suppress(RuntimeError):  # closed already
            self._loop.call_soon_threadsafe(self._end.set)
        self._thread.join()

    async def _listen(self, listening: list[OSError | None], ready: threading.Event) -> None:
        try:
            server = await asyncio.start_server(self._serve, self._host, self.port, limit=LONGEST_HEAD)
        except OSError as error:
            listening.append(error)
            ready.set()
            return
        self.port = server.sockets[0].getsockname()[1]
        listening.append(None)
        ready.set()
        await self._end.wait()
        server.close()
        open_ones = asyncio.all_tasks() - {asyncio.current_task()}
        for task in open_ones:
            task.cancel()
        await asyncio.gather(*open_ones, return_exceptions=True)

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """One connection: a request, and what follows it if it is let in."""
        try:
            head = await asyncio.wait_for(reader.readuntil(b"\r\n\r\n"), PATIENCE)
            request = Request.read(head)
            self.admit(request)
            if request.wants_page:
                writer.write(self._page)
            else:
                await self._hand_on(request, reader, writer)
        except Refused as refused:
            writer.write(refused.answer())
        except (OSError, EOFError, ValueError, TimeoutError, asyncio.LimitOverrunError):
            pass  # gone, slow, or no HTTP
        except asyncio.CancelledError:
            pass  # the gate closes; asyncio would log a task that ends as cancelled
        finally:
            writer.close()
            with contextlib.suppress(OSError, asyncio.CancelledError):
                await writer.wait_closed()

    def admit(self, request: Request) -> None:
        """Let a request in.

        Raises:
            Refused: From another site, without the token, or one tab too many.
        """
        host = request.headers.get("host", "")
        name = host.rpartition(":")[0] or host
        if self._token is None and name not in LOOPBACK_NAMES:
            raise Refused(HTTPStatus.FORBIDDEN, f"this is localhost, port {self.port}, not {name}")
        origin = request.headers.get("origin")
        if origin is not None and urlsplit(origin).netloc != host:
            raise Refused(HTTPStatus.FORBIDDEN, f"a page of {origin} may not use this toolbox")
        if self._token is not None:
            self._ask_for_token(request, self._token)
        if request.upgrades and self.tabs >= MOST_TABS:
            raise Refused(HTTPStatus.SERVICE_UNAVAILABLE, f"{MOST_TABS} tabs are open already: close one")

    def _ask_for_token(self, request: Request, token: str) -> None:
        cookies = (part.partition("=") for part in request.headers.get("cookie", "").split(";"))
        if any(name.strip() == COOKIE and hmac.compare_digest(value.strip(), token) for name, _, value in cookies):
            return
        address = urlsplit(request.target)
        given = parse_qs(address.query).get("token", [""])[0]
        if not hmac.compare_digest(given.encode(), token.encode()):
            raise Refused(HTTPStatus.FORBIDDEN, "open the address that the toolbox printed: it ends in ?token=...")
        kept = {"Location": address.path, "Set-Cookie": f"{COOKIE}={token}; HttpOnly; SameSite=Strict; Path=/"}
        raise Refused(HTTPStatus.SEE_OTHER, "welcome", kept)

    async def _hand_on(self, request: Request, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Carry bytes both ways until one side ends."""
        inner_reader, inner_writer = await asyncio.open_connection("127.0.0.1", self._inner)
        self.tabs += request.upgrades
        try:
            inner_writer.write(request.head())
            ways = [
                asyncio.create_task(_carry(reader, inner_writer, MOST_SENT)),
                asyncio.create_task(_carry(inner_reader, writer, None)),
            ]
            await asyncio.wait(ways, return_when=asyncio.FIRST_COMPLETED)
            for way in ways:
                way.cancel()
            await asyncio.gather(*ways, return_exceptions=True)
        finally:
            self.tabs -= request.upgrades
            inner_writer.close()


async def _carry(reader: asyncio.StreamReader, writer: asyncio.StreamWriter, most: int | None) -> None:
    """Carry bytes one way until they end, or there are too many of them in a window of time."""
    sent, since = 0, time.monotonic()
    while data := await reader.read(CHUNK):
        if most is not None:
            now = time.monotonic()
            sent, since = (len(data), now) if now - since > WINDOW else (sent + len(data), since)
            if sent > most:
                return
        writer.write(data)
        await writer.drain()
