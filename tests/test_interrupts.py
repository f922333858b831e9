"""Ctrl-C while code runs that must not be interrupted, or that swallows it."""

from __future__ import annotations

import contextlib
import signal
import sys
from types import FrameType
from typing import Any

import pytest

from pin_metaik.errors import InvalidSetting
from pin_metaik.interrupts import Pressed


def test_a_noted_interrupt_is_raised_at_the_end() -> None:
    reached = False
    with pytest.raises(KeyboardInterrupt), Pressed(held=True):
        signal.raise_signal(signal.SIGINT)
        reached = True
    assert reached
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_a_noted_interrupt_is_raised_instead_of_another_error() -> None:
    with pytest.raises(KeyboardInterrupt), Pressed(held=True):
        signal.raise_signal(signal.SIGINT)
        raise InvalidSetting("the work ends with an error of its own")


def test_a_swallowed_interrupt_is_raised_at_the_end() -> None:
    with pytest.raises(KeyboardInterrupt), Pressed(), contextlib.suppress(KeyboardInterrupt):
        signal.raise_signal(signal.SIGINT)


def test_an_interrupt_is_raised_once() -> None:
    with Pressed(held=True) as pressed:
        signal.raise_signal(signal.SIGINT)
        with pytest.raises(KeyboardInterrupt):
            pressed.check()


def test_no_line_of_the_listening_swallows_it() -> None:
    """Ctrl-C as each line of ``Pressed`` is run, in turn: after its last check it used to be noted and forgotten."""
    lines = 0

    def listened(moment: int) -> None:
        nonlocal lines
        seen = 0

        def trace(frame: FrameType, event: str, _: Any) -> Any:
            nonlocal seen
            if frame.f_code.co_filename != Pressed.__enter__.__code__.co_filename:
                return None
            seen += event == "line"
            if event == "line" and seen == moment:
                sys.settrace(None)
                signal.raise_signal(signal.SIGINT)
            return trace

        sys.settrace(trace)
        try:
            with Pressed(held=True):
                pass
        finally:
            sys.settrace(None)
            lines = seen

    listened(0)
    assert lines > 5
    for moment in range(1, lines + 1):
        with pytest.raises(KeyboardInterrupt):
            listened(moment)
        signal.signal(signal.SIGINT, signal.default_int_handler)
