"""Every code block of the README and of the site: Python is run, commands are read by the command line's parser.

A page is one program: its blocks run one after the other, in an empty folder. What a page leaves out stands in it as a
comment, ``<!-- invisible-code-block: python ... -->``; what needs a package that is not everybody's is skipped with
``<!-- skip: next if(not_installed("ikpy"), reason="...") -->``.
"""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterable
from importlib.util import find_spec
from pathlib import Path
from typing import Any
from unittest import SkipTest

import pytest
import typer
from sybil import Document, Example, Region, Sybil
from sybil.parsers.myst import PythonCodeBlockParser, SkipParser

from pin_metaik.cli import app
from tests.docs.pages import PAGES, ROOT

FENCE = re.compile(r"^```(?P<language>[^\n`]*)\n(?P<lines>.*?)^```$", re.MULTILINE | re.DOTALL)
SHELL = "", "console", "bash"
COMMAND = re.compile(r"^(?:\$ )?pin-metaik (?P<words>[^#>|\n]*)", re.MULTILINE)


def commands(document: Document) -> Iterable[Region]:
    """The blocks of the command line: without a language, or ``console``."""
    for block in FENCE.finditer(document.text):
        if block["language"] in SHELL:
            yield Region(*block.span(), parsed=block["lines"], evaluator=accepted)


def accepted(example: Example) -> None:
    """Have the command line read every command of a block."""
    for line in COMMAND.finditer(example.parsed.replace("\\\n", " ")):
        read_by_the_command_line(line["words"])


def read_by_the_command_line(line: str) -> None:
    """Have the command line read a command, as far as running it."""
    command: Any = typer.main.get_command(app)
    words = shlex.split(line)
    context = command.make_context("pin-metaik", words)
    while hasattr(command, "resolve_command"):
        name, command, words = command.resolve_command(context, [*context._protected_args, *context.args])
        context = command.make_context(name, words, parent=context)


def not_installed(package: str) -> bool:
    return find_spec(package) is None


SYBIL = Sybil([PythonCodeBlockParser(), SkipParser(), commands], path=str(ROOT), patterns=["*.md"])


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_code_block_of_a_page_runs(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    document = SYBIL.parse(page)
    document.namespace["not_installed"] = not_installed
    for example in document.examples():
        try:
            example.evaluate()
        except SkipTest:
            continue
