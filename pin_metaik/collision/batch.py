"""Many configurations at once, on all cores: in processes, because coal holds Python's global lock.

Each process has the world as it is at the call. The first tenth of a second of checks is done in this process, to
estimate the time of the rest; few configurations are checked here alone.
"""

from __future__ import annotations

import multiprocessing
import os
import pickle
import signal
import tempfile
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from itertools import islice
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from pin_metaik.interrupts import Pressed

if TYPE_CHECKING:
    from pin_metaik.collision.world import CollisionWorld

TRIAL = 0.1  # s of checks in this process before any other is started
FORKING, STARTING = 0.3, 2.0  # s that processes must save: those that are forked, and those that begin from nothing
BLOCK = 32  # checks between two looks at the clock
PART = 0.1  # s of checks that a process is given at a time: it ends within that at Ctrl-C
AHEAD = 3  # parts handed out for each process

Ask: TypeAlias = Callable[["CollisionWorld", NDArray[np.float64]], float | tuple[float, ...]]


def answers(
    world: CollisionWorld, ask: Ask, Q: NDArray[np.float64], workers: int | None, width: int | None = None
) -> NDArray[np.float64]:
    """What a world answers (k,) at configurations Q (k, nq), whatever the number of workers.

    Args:
        world: The world.
        ask: A function of a module, so that it can be sent to another process.
        Q: Configurations, valid ones.
        workers: Processes; None: one a core, where it is safe to fork this one.
        width: How many numbers an answer has, which then is a row (k, width); None: one, and no row.
    """
    found = np.empty(len(Q) if width is None else (len(Q), width))
    began, done = perf_counter(), 0
    while done < len(Q) and (spent := perf_counter() - began) < TRIAL:
        found[done : done + BLOCK] = [ask(world, q) for q in Q[done : done + BLOCK]]
        done += BLOCK
    left = Q[done:]
    if not len(left):
        return found
    each = spent / done
    count = min(workers if workers is not None else _cores(), max(1, int(each * len(left) / PART)))
    if _can_start(workers) and each * len(left) * (1.0 - 1.0 / count) > (FORKING if _forks() else STARTING):
        done += _shared(world, ask, left, found[done:], count, max(BLOCK, int(PART / each)))
    found[done:] = [ask(world, q) for q in Q[done:]]
    return found


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _forks() -> bool:
    """Whether new processes are forked; asked so that nothing is decided for the caller, who may yet choose."""
    method = multiprocessing.get_start_method(allow_none=True) or multiprocessing.get_all_start_methods()[0]
    return method == "fork"


def _can_start(workers: int | None) -> bool:
    """Whether processes may be started: not by one that must not have any, nor unasked where it could go wrong."""
    if multiprocessing.current_process().daemon:
        return False
    return workers is not None or (_forks() and threading.active_count() == 1)


def _shared(
    world: CollisionWorld,
    ask: Ask,
    Q: NDArray[np.float64],
    found: NDArray[np.float64],
    workers: int,
    size: int,
) -> int:
    """Let processes answer at Q (k, nq) into ``found`` (k,); how many rows were: all, unless processes died."""
    parts = iter([slice(at, at + size) for at in range(0, len(Q), size)])
    done = 0
    with _handed_over(world) as handed:
        pool = ProcessPoolExecutor(workers, initializer=_begin, initargs=(handed, ask))
        try:
            waiting: list[tuple[slice, Future[NDArray[np.float64]]]] = []
            with Pressed(held=True):  # a process that is forked meanwhile hears no Ctrl-C either
                waiting += _submitted(pool, Q, parts, AHEAD * workers)
            while waiting:
                part, future = waiting.pop(0)
                found[part] = future.result()
                done = part.stop
                waiting += _submitted(pool, Q, parts, 1)
        except BrokenProcessPool:
            pass  # killed, or never begun, as where a script does not guard its start: the rest is done here
        finally:
            pool.shutdown(cancel_futures=True)
    return min(done, len(Q))


def _submitted(
    pool: ProcessPoolExecutor, Q: NDArray[np.float64], parts: Iterator[slice], count: int
) -> list[tuple[slice, Future[NDArray[np.float64]]]]:
    return [(part, pool.submit(_part, Q[part])) for part in islice(parts, count)]


@contextmanager
def _handed_over(world: CollisionWorld) -> Iterator[CollisionWorld | str]:
    """The world as processes get it: those that are forked have it, others read it from a file.

    A process that ends before it has read megabytes from a pipe would leave this one writing for ever.
    """
    if _forks():
        yield world
        return
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "world.pickle"
        path.write_bytes(pickle.dumps(world))
        yield str(path)


_asked: list[tuple[CollisionWorld, Ask]] = []  # of a process of the pool: its world, and what is asked


def _begin(handed: CollisionWorld | str, ask: Ask) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the process that started this one ends it
    world = pickle.loads(Path(handed).read_bytes()) if isinstance(handed, str) else handed
    _asked[:] = [(world, ask)]


def _part(Q: NDArray[np.float64]) -> NDArray[np.float64]:
    ((world, ask),) = _asked
    return np.array([ask(world, q) for q in Q], dtype=float)
