"""Looking up a name in a registry, and the packages of an extra."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.util import find_spec
from typing import TypeVar

from pin_metaik.errors import MissingExtra, UnknownName

T = TypeVar("T")


def lookup(kind: str, name: str, registry: Mapping[str, T]) -> T:
    """The entry of a registry by its name.

    Args:
        kind: Kind of the entry, for the message.
        name: The name.
        registry: By name, all that there are.

    Raises:
        UnknownName: It is not in the registry; the message says which was perhaps meant.
    """
    if name not in registry:
        raise UnknownName(kind, name, registry)
    return registry[name]


def need(feature: str, extra: str, *packages: str) -> None:
    """Make sure that a feature has the packages it needs.

    Args:
        feature: What needs them, for the message.
        extra: The extra of this package that installs them.
        packages: Their names as one imports them.

    Raises:
        MissingExtra: One is not installed; the message says how it is.
    """
    if not all(find_spec(package) for package in packages):
        raise MissingExtra(feature, extra)
