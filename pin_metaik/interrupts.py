"""Ctrl-C reaches the caller even if the running code swallows it, and brings along the best result so far."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any, TypeVar

T = TypeVar("T")
U = TypeVar("U")


class Interrupted(KeyboardInterrupt):
    """A ``KeyboardInterrupt`` that carries the result found until then.

    Attributes:
        result: The result of the call as if its search had ended at that moment, marked as interrupted.
    """

    def __init__(self, result: object) -> None:
        self.result: Any = result
        super().__init__("interrupted: the best so far is the `result` of this exception")


def kept(call: Callable[[], T]) -> T:
    """The result of a call, or at Ctrl-C its best so far.

    Raises:
        KeyboardInterrupt: If it had nothing yet.
    """
    try:
        return call()
    except Interrupted as stop:
        found: T = stop.result
        return found


def wrapped(search: Callable[[], T], wrap: Callable[[T], U]) -> U:
    """The result of a search, wrapped; at Ctrl-C the best so far is wrapped, too.

    Raises:
        Interrupted: Ctrl-C, when the search had something in hand.
    """
    try:
        found = search()
    except Interrupted as stop:
        raise Interrupted(wrap(stop.result)) from None
    return wrap(found)


@contextmanager
def deaf_children() -> Iterator[None]:
    """Processes and threads that are begun meanwhile never hear Ctrl-C, which a terminal sends to all: their parent's.

    Where signals cannot be blocked, as on Windows, they do hear it.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


class Pressed:
    """A context manager that notes Ctrl-C, and raises ``KeyboardInterrupt`` if the code inside has swallowed it.

    It is raised at the end at the latest, instead of whatever else the code inside raises. Some code catches every
    exception: a user's method, which would then return another answer than in an uninterrupted run, or a callback
    called from C, whose exceptions Python drops. Signals come to the main thread; in another thread this does nothing.

    Attributes:
        held: Whether the first Ctrl-C is only noted, for ``check`` to raise, because the work inside must not be
            interrupted. A second one is raised at once.
    """

    def __init__(self, held: bool = False) -> None:
        self.held = held
        self._heard = False
        self._before: Any = None

    def __enter__(self) -> Pressed:
        """Listen, and hand on to whoever listened before."""
        if threading.current_thread() is threading.main_thread():
            self._before = signal.getsignal(signal.SIGINT)
            if callable(self._before):
                signal.signal(signal.SIGINT, self._note)
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        if callable(self._before):
            signal.signal(signal.SIGINT, self._before)
        if kind is None or not issubclass(kind, KeyboardInterrupt):
            self.check()

    def check(self) -> None:
        """Raise if there was a Ctrl-C that has not been raised by this before.

        Raises:
            KeyboardInterrupt: There was one.
        """
        if self._heard:
            self._heard = False
            raise KeyboardInterrupt

    def _note(self, number: int, frame: FrameType | None) -> None:
        first, self._heard = not self._heard, True
        if not (self.held and first):
            self._before(number, frame)
