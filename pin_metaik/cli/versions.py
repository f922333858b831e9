"""The versions an answer depends on, for whoever reads it later."""

from __future__ import annotations

from importlib.metadata import version

from pin_metaik import __version__

PACKAGES = ("pin", "coal", "numpy", "numba")


def versions() -> dict[str, str]:
    """Of this package and of those whose numbers an answer is."""
    return {"pin_metaik": __version__, **{name: version(name) for name in PACKAGES}}
