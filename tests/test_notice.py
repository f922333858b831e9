import io
import sys
import time
from collections.abc import Iterator

import pytest

from pin_metaik import notice as module
from pin_metaik.notice import notice


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.fixture(autouse=True)
def soon(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr(module, "WAIT", 0.05)
    monkeypatch.setattr(module, "PAUSE", 0.0)
    yield


def test_quick_work_is_done_without_a_word(capsys: pytest.CaptureFixture[str]) -> None:
    with notice("counting", 3) as line:
        line.step()
    time.sleep(0.1)
    assert capsys.readouterr().err == ""


def test_long_work_says_so_once_where_nobody_looks(capsys: pytest.CaptureFixture[str]) -> None:
    with notice("counting", 20) as line:
        for _ in range(20):
            time.sleep(0.01)
            line.step()
    assert capsys.readouterr().err == "pin_metaik: counting ...\n"


def test_long_work_counts_on_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", Terminal())
    with notice("counting", 20) as line:
        for _ in range(20):
            time.sleep(0.01)
            line.step()
    written = sys.stderr.getvalue()  # type: ignore[attr-defined]
    assert written.endswith("\rpin_metaik: counting ... 20 of 20\n")
    assert written.count("\n") == 1
    assert written.count("\r") > 3


def test_work_that_fails_ends_its_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", Terminal())
    with pytest.raises(KeyboardInterrupt), notice("counting", 20):
        time.sleep(0.1)
        raise KeyboardInterrupt
    assert sys.stderr.getvalue() == "\rpin_metaik: counting ... 0 of 20\n"  # type: ignore[attr-defined]


def test_work_without_a_standard_error_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", None)
    with notice("counting", 2) as line:
        time.sleep(0.1)
        line.step()
    assert line.done == 1
