"""A paper: jobs to run, and the sections of a report made from their results."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

import numpy as np

from pin_metaik.compare.report import Section

Done = TypeVar("Done")


@dataclass(frozen=True)
class Options:
    """How much of an experiment to run.

    Attributes:
        runs: Runs of every method on every case.
        quick: Leave out, or shorten, what takes long.
        long: Run what takes hours, too.
        rng: Seed of everything random.
    """

    runs: int
    quick: bool = False
    long: bool = False
    rng: int = 0

    def generator(self, *key: int) -> np.random.Generator:
        """The generator of one job; the same key gives the same numbers."""
        return np.random.default_rng((self.rng, *key))


@dataclass(frozen=True)
class Job(Generic[Done]):
    """A piece of the experiment, seconds rather than minutes long: an interrupted job is lost.

    Attributes:
        label: Text for the progress bar.
        work: Does it. A ``KeyboardInterrupt`` must come through.
        size: How long it takes compared with the others, for the progress bar: say, its evaluations.
    """

    label: str
    work: Callable[[], Done]
    size: float = 1.0


@dataclass(frozen=True)
class Paper(Generic[Done]):
    """A published experiment that can be run again. Write one file with these and add its line to ``PAPERS``.

    Attributes:
        name: Name on the command line.
        title: The experiment in one line.
        source: Where it was published.
        runs: Its runs of every method on every case; ours where it does not say.
        jobs: The work, in order, the short jobs first.
        sections: The report on the jobs that were done: all of them, or fewer after Ctrl-C, possibly none.
    """

    name: str
    title: str
    source: str
    runs: int
    jobs: Callable[[Options], Iterable[Job[Done]]]
    sections: Callable[[Sequence[Done], Options], list[Section]]


AnyPaper = Paper[Any]
