"""A toolbox and a Chromium for the tests of a module: one of each, and a fresh tab a test."""

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
SMALL = (900, 600)  # pixels: what draws them is the processor


@pytest.fixture(scope="module")
def toolbox() -> Iterator[Any]:
    """A toolbox on loopback, at any port."""
    for package in ("viser", "trimesh", "shapely"):
        pytest.importorskip(package)
    from pin_metaik.gui import open_toolbox

    with open_toolbox(port=0) as opened:
        yield opened
    assert not opened.tabs and not opened.pids


def browsing_of() -> ModuleType:
    """How the benchmarks use a browser; they are no package."""
    sys.path.insert(0, str(BENCHMARKS))
    try:
        return importlib.import_module("toolbox_browser")
    finally:
        sys.path.remove(str(BENCHMARKS))


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    """Debian's Chromium, driven by Playwright."""
    playwright, browsing = pytest.importorskip("playwright.sync_api"), browsing_of()
    found = browsing.chromium_path()
    if found is None and os.environ.get("PIN_METAIK_REQUIRE_CHROMIUM") == "1":
        pytest.fail("PIN_METAIK_REQUIRE_CHROMIUM=1 and there is no chromium")
    if found is None:
        pytest.skip("no chromium here")
    with playwright.sync_playwright() as started:
        browser = browsing.launched(started)
        yield browser
        browser.close()


@pytest.fixture
def tab(toolbox: Any, chromium: Any) -> Iterator[Any]:
    """A tab with the first page; nothing that it asks for leaves this machine."""
    opened = browsing_of().Page(chromium, toolbox.url, SMALL)
    yield opened
    opened.close()
    assert opened.asked <= {"127.0.0.1", ""}, opened.asked
    assert not opened.faults
