"""Results as JSON, with their units and the versions that they depend on."""

from __future__ import annotations

import json
from collections.abc import Mapping
from importlib.metadata import version
from types import MappingProxyType

from pin_metaik import __version__

PACKAGES = ("pin", "coal", "numpy", "numba")
SI: Mapping[str, str] = MappingProxyType({"length": "m", "angle": "rad", "time": "s"})


def versions() -> dict[str, str]:
    """Versions of this package and of those that compute its answers."""
    return {"pin_metaik": __version__, **{name: version(name) for name in PACKAGES}}


def print_json(answer: Mapping[str, object], units: Mapping[str, str] = SI) -> None:
    """Print an answer as one JSON object, versions and units first."""
    print(json.dumps({"versions": versions(), "units": dict(units), **answer}, allow_nan=False))
