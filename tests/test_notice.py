import io
import sys
import threading
import time

import pytest

from pin_metaik import notice as module
from pin_metaik.notice import notice

PATIENCE = 60.0  # s; a busy machine may let a thread wait


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True

    def written(self) -> str:
        """What stands on it, from the moment on when there is something."""
        until = time.monotonic() + PATIENCE
        while not self.getvalue() and time.monotonic() < until:
            time.sleep(1e-3)
        return self.getvalue()


def terminal(monkeypatch: pytest.MonkeyPatch) -> Terminal:
    """A terminal in the place of the standard error of a test."""
    shown = Terminal()
    monkeypatch.setattr(sys, "stderr", shown)
    return shown


def after_timers() -> None:
    """Wait until every timer has written, or been cancelled."""
    for thread in threading.enumerate():
        if isinstance(thread, threading.Timer):
            thread.join(PATIENCE)
            assert not thread.is_alive()


@pytest.fixture(autouse=True)
def soon(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "WAIT", 0.0)
    monkeypatch.setattr(module, "PAUSE", -1.0)


def test_quick_work_is_done_without_a_word(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(module, "WAIT", 3600.0)
    with notice("counting", 3) as line:
        line.step()
    after_timers()
    assert capsys.readouterr().err == ""


def test_long_work_says_so_once_where_nobody_looks(capsys: pytest.CaptureFixture[str]) -> None:
    with notice("counting", 20) as line:
        after_timers()
        for _ in range(20):
            line.step()
    assert capsys.readouterr().err == "pin_metaik: counting ...\n"


def test_long_work_counts_on_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    shown = terminal(monkeypatch)
    with notice("counting", 20) as line:
        assert shown.written() == "\rpin_metaik: counting ... 0 of 20"
        after_timers()
        for _ in range(20):
            line.step()
    assert shown.written() == "".join(f"\rpin_metaik: counting ... {i} of 20" for i in range(21)) + "\n"


def test_work_that_fails_ends_its_line(monkeypatch: pytest.MonkeyPatch) -> None:
    shown = terminal(monkeypatch)
    with pytest.raises(KeyboardInterrupt), notice("counting", 20):
        assert shown.written()
        raise KeyboardInterrupt
    assert shown.written() == "\rpin_metaik: counting ... 0 of 20\n"


def test_work_without_a_standard_error_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", None)
    with notice("counting", 2) as line:
        after_timers()
        line.step()
    assert line.done == 1
