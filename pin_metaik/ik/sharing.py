"""Work shared out among threads."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

T = TypeVar("T")
LEAST, MOST = 128, 256  # targets that a worker takes at a time; the compiled loop takes 0.1 to 1 ms for them


def share_out(work: Callable[[T], None], parts: Iterable[T], workers: int) -> None:
    """Do the work for all parts, this thread and others each taking the next part when they are free.

    Others only help: a thread that waited for their results would be woken for each, and each time take the interpreter
    from them.
    """
    waiting = iter(list(parts))  # of a list, threads may take from it without a lock

    def take() -> None:
        try:
            for part in waiting:
                work(part)
        finally:
            for _ in waiting:  # if it ended badly, nobody goes on
                pass

    with ThreadPoolExecutor(max(1, workers - 1)) as pool:
        helpers = [pool.submit(take) for _ in range(workers - 1)]
        take()
    for helper in helpers:
        helper.result()


def slices(k: int, workers: int) -> list[slice]:
    """Parts of k targets: large, because threads that meet wait; in the end small, so that all end together."""
    parts, at = [], 0
    while at < k:
        size = min(max((k - at) // (2 * workers), LEAST), MOST)
        parts.append(slice(at, min(at + size, k)))
        at += size
    return parts
