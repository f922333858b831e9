"""The errors of this package: one family, each with the values given and what would have worked."""

from __future__ import annotations

import copyreg
import json
from collections.abc import Collection, Iterable
from difflib import get_close_matches
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from urllib.parse import unquote, urlsplit

LISTED, NEAR = 100, 8  # longer lists than this are cut to the nearest names
LONGEST = 80  # characters of a name in a message
MOST = 2_000  # characters of a message


def shortened(text: str) -> str:
    """The beginning of a text that is too long for a message, e.g. a whole file given as a name."""
    return text if len(text) <= LONGEST else f"{text[:LONGEST]}..."


def readable(text: str) -> str:
    """A message as terminals take it: in one line, without what steers them, and short enough to be read.

    It may quote what a file holds, whatever that is. What is too long is cut in the middle: the place comes first, and
    what would have worked last.
    """
    if len(text) > MOST:
        text = f"{text[: MOST // 2]} ... {text[-MOST // 4 :]}"
    if text.isprintable():
        return text
    return "".join(one if one.isprintable() else _escaped(one) for one in " ".join(text.split("\n")))


def _escaped(character: str) -> str:
    return character.encode("unicode_escape").decode("ascii")


def meant(name: str, known: Collection[str]) -> str:
    """The end of a message about a name that is not known: the one that was perhaps meant, or those there are."""
    near = get_close_matches(name, known, n=1)
    return f"did you mean {near[0]!r}?" if near else f"known: {', '.join(known) or 'none'}"


class MetaIKError(ValueError):
    """Base class of this package's errors: the call makes no sense. An unreachable target is a status, not an error."""

    def __init__(self, message: str = "") -> None:
        super().__init__(readable(str(message)))

    def __reduce__(self) -> tuple[object, ...]:
        """Pickle by message and values, whatever ``__init__`` takes: an error has to come back from a worker."""
        return copyreg.__newobj__, (type(self), *self.args), self.__dict__  # type: ignore[attr-defined]


class UnknownName(MetaIKError):
    """A name that is not in a registry.

    Attributes:
        kind: What was looked for, e.g. ``"robot"``.
        name: The name given.
        known: The names that would have worked, sorted.
    """

    def __init__(self, kind: str, name: str, known: Iterable[str]) -> None:
        self.kind, self.name, self.known = kind, name, sorted(known)
        small = {known.lower(): known for known in self.known}  # UR5 is meant for ur5
        near = [small[match] for match in get_close_matches(name.lower(), small, n=NEAR, cutoff=0.5)]
        hint = f"; did you mean {near[0]!r}?" if near else ";"
        shown = ", ".join(self.known)
        if len(self.known) > LISTED:
            shown = f"{', '.join(near or self.known[:NEAR])} ... ({len(self.known)} in all)"
        super().__init__(f"no {kind} named {shortened(name)!r}{hint} known: {shown}")


class InvalidBounds(MetaIKError):
    """Limits that are crossed, not finite where they must be, or of the wrong length."""


class InvalidBudget(MetaIKError):
    """A budget that would never end, or that allows nothing."""


class InvalidSetting(MetaIKError):
    """A setting of an algorithm or a solver outside its range."""


class InvalidTarget(MetaIKError):
    """A target that is not valid: wrong shape, not finite, not orthonormal, or a tolerance that is not above zero."""


class InvalidConfiguration(MetaIKError):
    """A configuration or coordinate vector of the wrong length or with values that are not finite."""


class InvalidTable(MetaIKError):
    """A DH table (or its TOML file) that cannot be a robot; the message names the key or row."""


class InvalidModel(MetaIKError):
    """A robot description that cannot be read: missing, malformed, or referring to files that are missing."""


class UnsupportedJoint(MetaIKError):
    """A joint of a kind that a chain, or a check of a move, cannot handle."""


class FrameNotFound(UnknownName):
    """A frame that the model does not have."""

    def __init__(self, name: str, known: Iterable[str]) -> None:
        super().__init__("frame", name, known)


class FixedFrame(MetaIKError):
    """A frame that no joint of the chain moves."""


class InvalidGeometry(MetaIKError):
    """A shape that is not one: negative sizes, polygons that cross themselves, empty meshes."""


class Cancelled(MetaIKError):
    """A watch ended work that has no partial result to return."""


class CannotExport(MetaIKError):
    """An arm that cannot be exported as standalone code, or a language for which there is no export."""


class CannotWrite(MetaIKError):
    """A file or folder that cannot be written."""


class MissingExtra(MetaIKError):
    """A feature whose optional dependency is not installed."""

    def __init__(self, feature: str, extra: str) -> None:
        self.feature, self.extra = feature, extra
        super().__init__(f"{feature} needs an optional dependency: {installing(extra)}")


def installing(extra: str) -> str:
    """The command that installs an extra, for a package that was installed as this one was."""
    try:
        record = json.loads(distribution("pin-metaik").read_text("direct_url.json") or "{}")
    except PackageNotFoundError:  # run from its sources
        record = {"url": Path(__file__).parents[1].as_uri(), "dir_info": {}}
    url = record.get("url")
    if url is None:  # from an index
        return f"pip install 'pin-metaik[{extra}]'"
    if "dir_info" not in record:  # a wheel, or a repository
        version_control = record.get("vcs_info", {}).get("vcs")
        return f"pip install 'pin-metaik[{extra}] @ {f'{version_control}+' if version_control else ''}{url}'"
    editable = "--editable " if record["dir_info"].get("editable") else ""
    return f"pip install {editable}'.[{extra}]' in {unquote(urlsplit(url).path)}"
