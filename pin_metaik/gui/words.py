"""Errors as the page says them: in words, in one place, never as a traceback."""

from __future__ import annotations

import logging
import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from pin_metaik.errors import MetaIKError

FOLDER = "pin_metaik_toolbox_"  # what the folders of tabs begin with; where they are is nobody's business
PLACE = re.compile(rf"\S*{FOLDER}\w+[/\\]")
LONGEST = 600  # characters of a message
RED, YELLOW = "red", "yellow"
LOG = logging.getLogger("pin_metaik.gui")


def in_words(error: BaseException) -> str:
    """What went wrong, for whoever looks at the page."""
    match error:
        case MetaIKError():
            text = str(error)
        case OSError():
            text = f"{error.filename or 'a file'}: {error.strerror or error}"
        case MemoryError():
            text = "that needs more memory than there is"
        case _:
            text = f"this is a fault of the toolbox, not yours ({type(error).__name__}); its log has the details"
    text = PLACE.sub("", text)
    return text if len(text) <= LONGEST else f"{text[:LONGEST]} ..."


def say(client: Any, title: str, text: str, colour: str = YELLOW) -> None:
    """Show a notification in one tab.

    Args:
        client: The ``viser.ClientHandle`` of the tab.
        title: In few words.
        text: In a sentence.
        colour: Red for what went wrong.
    """
    client.add_notification(title, text, color=colour, auto_close_seconds=20.0)


@contextmanager
def told(client: Any, title: str = "That does not work") -> Iterator[None]:
    """Have a tab say the errors of a block; what is no error of this package goes to the log as well."""
    try:
        yield
    except Exception as error:  # a callback of a page has nobody above it who could be told
        if not isinstance(error, (MetaIKError, OSError)):
            LOG.exception("a page stumbled")
        say(client, title, in_words(error), RED)
