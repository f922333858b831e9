"""Latest request wins: a thread that works on the newest request, and never on one that was overtaken."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Generic, TypeVar

T = TypeVar("T")


class Latest(Generic[T]):
    """A slot for one request, and the thread that takes it, from the first one on.

    A request that waits is replaced by a newer one, so that what is answered is never older than one piece of work.

    Args:
        work: What to do with a request; its errors are its own to tell.
    """

    def __init__(self, work: Callable[[T], None]) -> None:
        self._work = work
        self._waiting: list[T] = []
        self._closed = False
        self._changed = threading.Condition()
        self._thread: threading.Thread | None = None

    def ask(self, request: T) -> None:
        """Work on this next, in place of what waits."""
        with self._changed:
            self._waiting[:] = [request]
            if self._thread is None and not self._closed:
                self._thread = threading.Thread(target=self._run, name="newest request", daemon=True)
                self._thread.start()
            self._changed.notify()

    def close(self) -> None:
        """End the thread, once it has done what it is doing; nobody waits for it, who may hold what it needs."""
        with self._changed:
            self._closed = True
            self._changed.notify()

    def _run(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._waiting or self._closed)
                if self._closed:
                    return
                request = self._waiting.pop()
            self._work(request)
