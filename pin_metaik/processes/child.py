"""A process that works for a program: ``python -m pin_metaik.processes.child``; it ends when that does."""

from __future__ import annotations

import os
import pickle
import queue
import signal
import sys
import threading
import time
from typing import BinaryIO

from pin_metaik.errors import MetaIKError
from pin_metaik.processes.wire import Done, Failed, Order, Told, Work, receive, send
from pin_metaik.watching import Progress


class Control:
    """The watch of some work: it tells the program, waits while it is held, and says stop.

    Args:
        out: The pipe to the program.
        held: Whether to wait before the first step is over.
        pause: s between two steps, so that one can see them.
    """

    def __init__(self, out: BinaryIO, held: bool, pause: float) -> None:
        self._out, self._pause = out, pause
        self._changed = threading.Condition()
        self._held, self._steps, self._stopped = held, 0, False
        self._began, self._waited = time.perf_counter(), 0.0

    def order(self, order: Order) -> None:
        """Do as the program says."""
        with self._changed:
            match order:
                case Order.HOLD:
                    self._held = True
                case Order.STEP:
                    self._held, self._steps = True, self._steps + 1
                case Order.GO:
                    self._held = False
                case Order.STOP:
                    self._stopped = True
            self._changed.notify()

    def watch(self, progress: Progress) -> bool:
        """Tell how far the work is; whether it shall end."""
        now = time.perf_counter()
        send(self._out, Told(progress, now - self._began - self._waited))
        with self._changed:
            if self._pause:
                self._changed.wait_for(lambda: self._stopped, self._pause)
            self._changed.wait_for(lambda: self._stopped or not self._held or self._steps)
            self._steps -= bool(self._held and self._steps)
            self._waited += time.perf_counter() - now
            return self._stopped


def main() -> None:
    """Work until the program closes its pipe."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # a terminal sends it to all; the program says when to stop
    out = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # whoever prints does not print into the pipe
    orders: queue.Queue[tuple[Work, Control]] = queue.Queue()
    threading.Thread(target=_listen, args=(sys.stdin.buffer, out, orders), daemon=True).start()
    while True:
        work, control = orders.get()
        send(out, _outcome(work, control))


def _outcome(work: Work, control: Control) -> Done | Failed:
    """What comes of some work, as an object that can be sent."""
    try:
        done = Done(work(control.watch))
        pickle.dumps(done)
    except MetaIKError as error:
        return Failed(error)
    except Exception as error:  # the program has to hear of it, whatever it is
        return Failed(RuntimeError(f"{type(error).__name__}: {error}"))
    return done


def _listen(pipe: BinaryIO, out: BinaryIO, orders: queue.Queue[tuple[Work, Control]]) -> None:
    """Take work and orders until the pipe ends, and then end the process, whatever it is doing."""
    control: Control | None = None
    try:
        while True:
            message = receive(pipe)
            if isinstance(message, Order):
                if control is not None:
                    control.order(message)
            else:
                work, held, pause = message
                control = Control(out, held, pause)
                orders.put((work, control))
    except (EOFError, OSError):
        os._exit(0)


if __name__ == "__main__":
    main()
