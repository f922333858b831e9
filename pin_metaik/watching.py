"""Watches: callbacks that are told the progress of long work, and can end it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from threading import Lock
from typing import NamedTuple, TypeAlias, TypeVar

from pin_metaik.arrays import Array
from pin_metaik.interrupts import Interrupted

T = TypeVar("T")


class Population(NamedTuple):
    """The points that a search looked at in one generation; the arrays are the watch's own.

    Attributes:
        X: Points (k, n).
        costs: Their costs (k,); inf where there is none.
    """

    X: Array
    costs: Array


@dataclass(frozen=True, slots=True)
class Progress:
    """How far some work is.

    Attributes:
        done: Steps done: evaluations, iterations, cells, targets or rows, as the function documents.
        total: Steps in all; 0 if unknown, as for a search with a budget in seconds.
        best: Cost of the best found so far, where the work has one.
        label: What is being worked on now.
        population: Of a metaheuristic, what its last generation looked at.
    """

    done: float
    total: float = 0
    best: float | None = None
    label: str = ""
    population: Population | None = None


Watch: TypeAlias = Callable[[Progress], bool | None]
"""Called with the progress as work goes on; returning True ends it, and what was found so far is returned."""


class Stopped(Interrupted):
    """A watch said stop. It never leaves a public function: that returns the result."""


def tell(watch: Watch | None, progress: Progress) -> None:
    """Tell a watch, if there is one.

    Raises:
        Stopped: It returned True.
    """
    if watch is not None and watch(progress) is True:
        raise Stopped(None)


def with_result(stop: KeyboardInterrupt, result: object) -> Interrupted:
    """What to raise when work with something in hand was ended."""
    return Stopped(result) if isinstance(stop, Stopped) else Interrupted(result)


def ended(stop: KeyboardInterrupt, result: T) -> T:
    """The result of work that a watch has ended; after Ctrl-C it is raised.

    Raises:
        Interrupted: Ctrl-C; the result goes with it.
    """
    if isinstance(stop, Stopped):
        return result
    raise Interrupted(result) from None


class Count:
    """Steps counted by several threads, of which one at a time tells the watch."""

    def __init__(self, watch: Watch | None, total: int) -> None:
        self._watch, self._total, self._done, self._lock = watch, total, 0, Lock()

    def add(self, steps: int) -> None:
        """So many more steps are done.

        Raises:
            Stopped: The watch says so.
        """
        if self._watch is not None and steps:
            with self._lock:
                self._done += steps
                tell(self._watch, Progress(self._done, self._total))
