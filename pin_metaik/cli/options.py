"""Options that take several values in a row: ``--robot panda ur5`` as well as ``--robot panda --robot ur5``."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import Annotated, Any

import typer
from typer.core import TyperCommand

Json = Annotated[bool, typer.Option("--json", help="Print one JSON object.")]


class ManyValues(TyperCommand):
    """A command whose options that may be repeated also take all the words up to the next option."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Repeat such an option before each of its words, then go on as ever."""
        repeated = {name for option in self.params if getattr(option, "multiple", False) for name in option.opts}
        return super().parse_args(ctx, spread(args, repeated))


def spread(words: Iterable[str], repeated: Collection[str]) -> list[str]:
    """The words of a command line with every option in ``repeated`` before each of its values."""
    out: list[str] = []
    option, fresh = "", False
    for word in words:
        if word.startswith("-"):
            option, fresh = word if word in repeated else "", True
            out.append(word)
        elif option and not fresh:
            out += [option, word]
        else:
            out.append(word)
            fresh = False
    return out


def split(values: Iterable[str]) -> tuple[str, ...]:
    """The values between commas, blanks aside."""
    return tuple(part.strip() for value in values for part in value.split(",") if part.strip())
