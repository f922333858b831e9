"""Where tests keep what they work out; how long properties are looked at; Ctrl-C; the browser for pages."""

import os
import shutil
import signal

import pytest
from hypothesis import HealthCheck, settings

COMMON = {"deadline": None, "suppress_health_check": [*HealthCheck], "print_blob": True}
settings.register_profile("quick", max_examples=12, derandomize=True, database=None, **COMMON)
settings.register_profile("deep", max_examples=2_000, **COMMON)  # make soak
settings.load_profile("quick")

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:  # as a shell has it for what it starts in the background
    signal.signal(signal.SIGINT, signal.default_int_handler)

FLAGS = [
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-component-update",
    "--disable-background-networking", "--disable-sync", "--hide-scrollbars", "--enable-logging=stderr",
]  # fmt: skip


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """The slow tests first, so that no worker is left alone with one at the end."""
    items.sort(key=lambda item: item.get_closest_marker("slow") is None)


@pytest.fixture(scope="session", autouse=True)
def own_cache(tmp_path_factory: pytest.TempPathFactory) -> None:
    """One for all workers, so that what is known of a robot's links is worked out once."""
    folder = tmp_path_factory.getbasetemp()
    folder = folder.parent if "PYTEST_XDIST_WORKER" in os.environ else folder
    os.environ["PIN_METAIK_CACHE"] = str(folder / "cache")


@pytest.fixture(scope="session")
def browser() -> list[str]:
    """The command that runs Chromium without a window; a test adds a profile of its own."""
    found = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if found is None and os.environ.get("PIN_METAIK_REQUIRE_CHROMIUM") == "1":
        pytest.fail("PIN_METAIK_REQUIRE_CHROMIUM=1 and there is no chromium")
    if found is None:
        pytest.skip("no chromium here")
    return [found, *FLAGS]
