"""Nothing that tests work out stays in the user's cache."""

import os

import pytest


@pytest.fixture(scope="session", autouse=True)
def own_cache(tmp_path_factory: pytest.TempPathFactory) -> None:
    os.environ["PIN_METAIK_CACHE"] = str(tmp_path_factory.mktemp("cache"))
