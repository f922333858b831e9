"""What goes between a program and a process that works for it: objects, one after the other, through two pipes."""

from __future__ import annotations

import pickle
import struct
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, BinaryIO, TypeAlias

from pin_metaik.watching import Progress, Watch

Work: TypeAlias = Callable[[Watch], Any]
"""Some work: called with a watch, it returns what came of it; both it and that have to pickle."""

LENGTH = struct.Struct("<Q")


class Order(StrEnum):
    """What a process is told besides its work."""

    HOLD = "hold"
    STEP = "step"
    GO = "go"
    STOP = "stop"


@dataclass(frozen=True)
class Told:
    """How far the work is, and for how long it has run without having been held.

    Attributes:
        progress: As the library tells it.
        seconds: Time since it began, s.
    """

    progress: Progress
    seconds: float


@dataclass(frozen=True)
class Done:
    """What came of the work."""

    result: Any


@dataclass(frozen=True)
class Failed:
    """Why nothing came of it."""

    error: BaseException


def send(pipe: BinaryIO, message: object) -> None:
    """Send one object. OSError: nobody is at the other end."""
    data = pickle.dumps(message)
    pipe.write(LENGTH.pack(len(data)) + data)
    pipe.flush()


def receive(pipe: BinaryIO) -> Any:
    """The next object. EOFError: there is none, the other end is closed."""
    head = pipe.read(LENGTH.size)
    if len(head) < LENGTH.size:
        raise EOFError
    (length,) = LENGTH.unpack(head)
    data = pipe.read(length)
    if len(data) < length:
        raise EOFError
    return pickle.loads(data)  # of our own process, never of a browser
