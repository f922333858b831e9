"""One toolbox, one Chromium and a tab in it for all tests that look, as opening them takes long."""

from __future__ import annotations

import importlib
import os
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"
SMALL = (1000, 640)  # pixels
LEFT = 60.0  # s, after which a tab that was closed is there for good


@pytest.fixture(scope="session")
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
    """A tab without a browser, which only speaks with the toolbox; nothing of it is left when it is closed."""
    before = len(toolbox.tabs)
    opened = benchmark("toolbox_socket").SocketTab(toolbox.url)
    yield opened
    opened.close()
    end = time.monotonic() + LEFT
    while len(toolbox.tabs) > before:
        assert time.monotonic() < end
        time.sleep(0.01)


@pytest.fixture(scope="session")
def results(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a small comparison."""
    for package in ("joblib", "pyarrow"):
        pytest.importorskip(package)
    from pin_metaik.compare import Suite, compare

    folder = tmp_path_factory.mktemp("compared") / "results"
    compare(Suite(("ur5",), ("random",), ("dls", "gwo"), tasks=3, budget=300), folder)
    return folder


@pytest.fixture(scope="module")
def tab(toolbox: Any, chromium: Any) -> Iterator[Any]:
    """A tab of a browser; nothing that it asks for leaves this machine."""
    browsing = benchmark("toolbox_browser")
    opened = browsing.Page(chromium, toolbox.url + browsing.COARSE, SMALL)
    yield opened
    opened.close()
    assert opened.asked <= {"127.0.0.1", ""}, opened.asked
    assert not opened.faults
