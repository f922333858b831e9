"""A thread pool whose caller works, too."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterable
from threading import Thread
from typing import TypeVar

T = TypeVar("T")
LEAST, MOST = 128, 256  # targets that a worker takes at a time; the compiled loop takes 0.1 to 1 ms for them


class Helper(Thread):
    """A thread that works until it is done, or told to stop.

    Attributes:
        error: What its work raised.
    """

    def __init__(self, work: Callable[[], None]) -> None:
        super().__init__(daemon=True)
        self.error: BaseException | None = None
        self._work = work

    def run(self) -> None:
        """Work."""
        try:
            self._work()
        except BaseException as error:
            self.error = error

    def stop(self) -> None:
        """End the work as Ctrl-C ends that of the main thread: at the next step of its Python.

        The compiled loop it may be in ends first. ``SystemExit`` is what a thread ends with without a word.
        """
        if self.ident is not None:
            ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(self.ident), ctypes.py_object(SystemExit))


def run_parallel(work: Callable[[T], None], parts: Iterable[T], workers: int) -> None:
    """Do the work for all parts: each thread, the calling one included, takes the next part when it has finished one.

    The calling thread works, too, instead of waiting: waking it for every result would contend for the interpreter.
    Ctrl-C reaches the main thread only, which stops the others; an exception in any thread ends the work, too.
    """
    waiting = iter(list(parts))  # of a list, threads may take from it without a lock

    def take() -> None:
        try:
            for part in waiting:
                work(part)
        except BaseException:
            for _ in waiting:  # nobody goes on
                pass
            raise

    helpers = [Helper(take) for _ in range(workers - 1)]
    try:
        for helper in helpers:
            helper.start()
        take()
        for helper in helpers:
            helper.join()
    except BaseException:
        for _ in waiting:
            pass
        for helper in helpers:
            helper.stop()
        for helper in helpers:
            if helper.ident is not None:
                helper.join()
        raise
    for helper in helpers:
        if helper.error is not None:
            raise helper.error


def slices(k: int, workers: int) -> list[slice]:
    """Parts of k targets: large, because threads that meet wait; in the end small, so that all end together."""
    parts, at = [], 0
    while at < k:
        size = min(max((k - at) // (2 * workers), LEAST), MOST)
        parts.append(slice(at, min(at + size, k)))
        at += size
    return parts
