"""Many calls in processes of their own: what kills one, or never comes back, is told, and the next goes on."""

from __future__ import annotations

import contextlib
import os
import pickle
import resource
import select
import signal
import time
import traceback
from collections.abc import Callable, Iterator
from typing import TypeVar

T = TypeVar("T")


class Hangs(BaseException):
    """A call that did not come back in time."""


@contextlib.contextmanager
def alarm(seconds: float) -> Iterator[None]:
    """Raise ``Hangs`` in what takes longer, by the time that the processor worked on it."""

    def ring(*_: object) -> None:
        raise Hangs

    before = signal.signal(signal.SIGPROF, ring)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)


@contextlib.contextmanager
def room(size: int) -> Iterator[None]:
    """With at most so many bytes of address space: what asks for more gets a MemoryError instead of the machine."""
    limits = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (size, limits[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, limits)


def address_space() -> int:
    """Bytes of address space that this process has taken."""
    with open("/proc/self/statm", encoding="ascii") as file:  # noqa: PTH123  # read in every child, in microseconds
        return int(file.read().split()[0]) * resource.getpagesize()


def apart(count: int, call: Callable[[int], T], ended: Callable[[int, str], T], late: float, more: int = 0) -> list[T]:
    """What ``call(i)`` gives for i below ``count``.

    Args:
        count: How many calls.
        call: Made in a child of this process, as it is now; what it gives can be pickled.
        ended: What a call counts as that ended its process, with how, or was ended because it did not come back.
        late: Time after which a call that nothing is heard of is ended, s.
        more: Bytes of address space that a child may take beyond what this process has; 0: as many as it likes.
    """
    done: list[T] = []
    while len(done) < count:
        reader, writer = os.pipe()
        child = os.fork()
        if child == 0:
            os.close(reader)
            _work(writer, range(len(done), count), call, more)
        os.close(writer)
        with os.fdopen(reader, "rb") as back:
            while _comes(back.fileno(), late):
                try:
                    done.append(pickle.load(back))
                except EOFError:
                    break
            else:
                os.kill(child, signal.SIGKILL)
        _, status = os.waitpid(child, 0)
        if len(done) < count:
            done.append(ended(len(done), _how(status, late)))
    return done


def _work(writer: int, numbers: range, call: Callable[[int], object], more: int) -> None:
    """The life of a child: one call after the other. It never returns."""
    limited = room(address_space() + more) if more else contextlib.nullcontext()
    try:
        with os.fdopen(writer, "wb", buffering=0) as out, limited:
            for i in numbers:
                out.write(pickle.dumps(call(i)))
        os._exit(0)
    except BaseException:
        traceback.print_exc()
    finally:
        os._exit(1)


def _comes(file: int, late: float) -> bool:
    """Whether something, or the end, comes in time."""
    ready, _, _ = select.select([file], [], [], late)
    return bool(ready)


def _how(status: int, late: float) -> str:
    """How a process ended, in words."""
    if os.WIFSIGNALED(status):
        number = signal.Signals(os.WTERMSIG(status))
        return f"never comes back, in {late:g} s" if number is signal.SIGKILL else f"the process dies of {number.name}"
    return "the process exits"


def seconds_of(call: Callable[[], T]) -> tuple[T, float]:
    """What a call gives, and for how long the processor worked on it, s."""
    began = time.process_time()
    return call(), time.process_time() - began
