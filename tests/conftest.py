"""Nothing that tests work out stays in the user's cache; and how long properties are looked at."""

import os

import pytest
from hypothesis import HealthCheck, settings

COMMON = {"deadline": None, "suppress_health_check": [*HealthCheck], "print_blob": True}
settings.register_profile("quick", max_examples=12, derandomize=True, database=None, **COMMON)
settings.register_profile("deep", max_examples=2_000, **COMMON)  # make soak
settings.load_profile("quick")


@pytest.fixture(scope="session", autouse=True)
def own_cache(tmp_path_factory: pytest.TempPathFactory) -> None:
    os.environ["PIN_METAIK_CACHE"] = str(tmp_path_factory.mktemp("cache"))
