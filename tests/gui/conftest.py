"""A toolbox and a Chromium for the tests of a module: one of each, and one tab in it, as opening one takes long."""

from __future__ import annotations

import importlib
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"
SMALL = (1000, 640)  # pixels


@pytest.fixture(scope="module")
def toolbox() -> Iterator[Any]:
    """A toolbox on loopback, at any port."""
    for package in ("viser", "trimesh", "shapely"):
        pytest.importorskip(package)
    from pin_metaik.gui import open_toolbox

    with open_toolbox(port=0) as opened:
        yield opened
    assert not opened.tabs and not opened.pids


def benchmark(name: str) -> ModuleType:
    """A module of the benchmarks, which are no package."""
    sys.path.insert(0, str(BENCHMARKS))
    try:
        return importlib.import_module(name)
    finally:
        sys.path.remove(str(BENCHMARKS))


@pytest.fixture(scope="module")
def chromium(browser: list[str]) -> Iterator[Any]:
    """Debian's Chromium, driven by Playwright; ``browser`` says whether it is there."""
    load = importlib.import_module if os.environ.get("PIN_METAIK_REQUIRE_CHROMIUM") == "1" else pytest.importorskip
    with load("playwright.sync_api").sync_playwright() as started:
        opened = benchmark("toolbox_browser").launched(started)
        yield opened
        opened.close()


@pytest.fixture
def socket(toolbox: Any) -> Iterator[Any]:
    """A tab without a browser, which only speaks with the toolbox."""
    opened = benchmark("toolbox_socket").SocketTab(toolbox.url)
    yield opened
    opened.close()


@pytest.fixture(scope="module")
def tab(toolbox: Any, chromium: Any) -> Iterator[Any]:
    """A tab of a browser; nothing that it asks for leaves this machine."""
    browsing = benchmark("toolbox_browser")
    opened = browsing.Page(chromium, toolbox.url + browsing.COARSE, SMALL)
    yield opened
    opened.close()
    assert opened.asked <= {"127.0.0.1", ""}, opened.asked
    assert not opened.faults
