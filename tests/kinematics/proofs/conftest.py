"""The generator of feasible targets that the large runs use, too."""

import sys
from importlib import import_module
from pathlib import Path
from types import ModuleType

import pytest

BENCHMARKS = Path(__file__).parents[3] / "benchmarks"


@pytest.fixture(scope="session")
def soundness() -> ModuleType:
    """``benchmarks/proof_soundness.py``."""
    sys.path.insert(0, str(BENCHMARKS))
    try:
        return import_module("proof_soundness")
    finally:
        sys.path.remove(str(BENCHMARKS))
