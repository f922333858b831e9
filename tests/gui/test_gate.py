"""Who may come in: pages of this server, on loopback or with the token."""

from __future__ import annotations

from collections.abc import Iterator
from urllib.request import urlopen

import pytest

from pin_metaik.gui.gate import COOKIE, MOST_TABS, Gate, Refused, Request, on_loopback

TOKEN = "rather-secret"
PAGE = b"<html></html>"


def asked(target: str = "/", **headers: str) -> Request:
    lines = [f"GET {target} HTTP/1.1", *(f"{name.replace('_', '-')}: {value}" for name, value in headers.items())]
    return Request.read(("\r\n".join(lines) + "\r\n\r\n").encode())


@pytest.fixture(scope="module")
def gates() -> Iterator[tuple[Gate, Gate]]:
    opened = Gate("127.0.0.1", 0, 9, None, PAGE), Gate("127.0.0.1", 0, 9, TOKEN, PAGE)
    yield opened
    for gate in opened:
        gate.close()


def test_on_loopback_only_this_server_is_asked_and_only_by_its_own_pages(gates: tuple[Gate, Gate]) -> None:
    gate, _ = gates
    here = f"127.0.0.1:{gate.port}"
    gate.admit(asked(Host=here))
    gate.admit(asked(Host=here, Origin=f"http://{here}", Upgrade="websocket"))
    for request in (
        asked(Host="evil.example"),  # a name that leads here: DNS rebinding
        asked(Host=f"evil.example:{gate.port}"),
        asked(Host=here, Origin="http://evil.example", Upgrade="websocket"),
        asked(Host=here, Origin="null", Upgrade="websocket"),
        asked(Host=here, Origin=f"http://127.0.0.1:{gate.port + 1}", Upgrade="websocket"),
        asked(),
    ):
        with pytest.raises(Refused):
            gate.admit(request)


def test_off_loopback_the_token_is_asked_for_once_and_kept_in_a_cookie(gates: tuple[Gate, Gate]) -> None:
    _, gate = gates
    with pytest.raises(Refused, match="token=") as refused:
        gate.admit(asked(Host="robot.lab:8080"))
    assert refused.value.status == 403 and TOKEN not in refused.value.answer().decode()
    with pytest.raises(Refused, match="token="):
        gate.admit(asked("/?token=guessed", Host="robot.lab:8080", Cookie=f"{COOKIE}=guessed"))
    with pytest.raises(Refused) as welcome:
        gate.admit(asked(f"/state/abc?token={TOKEN}", Host="robot.lab:8080"))
    assert welcome.value.status == 303 and welcome.value.headers["Location"] == "/state/abc"
    cookie = welcome.value.headers["Set-Cookie"].partition(";")[0]
    gate.admit(asked(Host="robot.lab:8080", Cookie=f"other=1; {cookie}", Upgrade="websocket"))


def test_there_is_room_for_so_many_tabs(gates: tuple[Gate, Gate]) -> None:
    gate, _ = gates
    here, gate.tabs = f"127.0.0.1:{gate.port}", MOST_TABS
    gate.admit(asked(Host=here))
    with pytest.raises(Refused, match="close one"):
        gate.admit(asked(Host=here, Upgrade="websocket"))
    gate.tabs = 0


def test_any_address_with_a_state_in_it_is_the_one_page(gates: tuple[Gate, Gate]) -> None:
    gate, _ = gates
    for path in ("", "?fixedDpr=0.2", "state/abc", "state/abc?fixedDpr=0.2"):
        with urlopen(f"http://127.0.0.1:{gate.port}/{path}", timeout=20) as given:
            assert given.read() == PAGE and given.headers["Content-Type"].startswith("text/html")
    assert not asked("/state/abc", Host="x", Upgrade="websocket").wants_page
    assert not asked("/assets/a.js", Host="x").wants_page
    assert b"connection: close" in asked("/assets/a.js", Host="x", Connection="keep-alive").head()
    assert asked("/state/abc", Host="x", Upgrade="websocket").head().startswith(b"GET /state/abc ")


def test_loopback_is_known_by_its_addresses() -> None:
    assert all(map(on_loopback, ("127.0.0.1", "127.8.8.8", "::1", "localhost")))
    assert not any(map(on_loopback, ("0.0.0.0", "192.168.0.3", "robot.lab", "::")))
