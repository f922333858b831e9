"""The command as its entry point calls it, in this process."""

from __future__ import annotations

import sys
from collections.abc import Callable

import pytest

from pin_metaik import cli

Call = Callable[..., tuple[int, str, str]]


def caller(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Call:
    """What calls the command with words, and hands back its exit code, what it printed, and what it said."""

    def called(*words: object) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["pin-metaik", *map(str, words)])
        capsys.readouterr()
        with pytest.raises(SystemExit) as stop:
            cli.run()
        printed = capsys.readouterr()
        return int(stop.value.code or 0), printed.out, printed.err

    return called
