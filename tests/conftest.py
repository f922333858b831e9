"""Nothing that tests work out stays in the user's cache; and the browser that looks at pages."""

import os
import shutil

import pytest

FLAGS = [
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-component-update",
    "--disable-background-networking", "--disable-sync", "--hide-scrollbars", "--enable-logging=stderr",
]  # fmt: skip


@pytest.fixture(scope="session", autouse=True)
def own_cache(tmp_path_factory: pytest.TempPathFactory) -> None:
    os.environ["PIN_METAIK_CACHE"] = str(tmp_path_factory.mktemp("cache"))


@pytest.fixture(scope="session")
def browser() -> list[str]:
    """The command that runs Chromium without a window; a test adds a profile of its own."""
    found = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if found is None and os.environ.get("PIN_METAIK_REQUIRE_CHROMIUM") == "1":
        pytest.fail("PIN_METAIK_REQUIRE_CHROMIUM=1 and there is no chromium")
    if found is None:
        pytest.skip("no chromium here")
    return [found, *FLAGS]
