"""Processes that work for a program: as many as the machine has cores; more work waits for its turn."""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
import threading
from collections import deque
from collections.abc import Callable
from enum import StrEnum
from typing import Any, BinaryIO, cast

from pin_metaik.errors import MetaIKError
from pin_metaik.processes.wire import Done, Failed, Order, Told, Work, receive, send

ENDING = 2.0  # s that work may take to end by itself once it is told to

Tell = Callable[[Told], None]
End = Callable[[Any], None]


class Stage(StrEnum):
    """Where a run is."""

    WAITING = "waits for a process"
    WORKING = "works"
    DONE = "is done"
    ENDED = "was ended"
    FAILED = "failed"


class Run:
    """Some work that was handed to a crew.

    Attributes:
        stage: Where it is.
        result: What came of it, once it is done; also of a search that was stopped.
        error: Why nothing came of it.
    """

    def __init__(self, crew: Crew, work: Work, held: bool, pause: float, tell: Tell, end: End) -> None:
        self._crew, self.work, self.held, self.pause = crew, work, held, pause
        self.tell, self.end = tell, end
        self.stage = Stage.WAITING
        self.result: Any = None
        self.error: BaseException | None = None
        self.process: Process | None = None
        self._ending = threading.Lock()

    @property
    def over(self) -> bool:
        """Whether nothing more comes of it."""
        return self.stage not in (Stage.WAITING, Stage.WORKING)

    def order(self, order: Order) -> None:
        """Hold it, let it make a step, go on or stop. Work that waits for its turn can be held and stopped."""
        self._crew.order(self, order)

    def stop(self) -> None:
        """End it: its search returns the best so far; if it does not, its process is ended."""
        self.order(Order.STOP)

    def finish(self, stage: Stage) -> None:
        """Nothing more comes of it; its owner hears of it once."""
        with self._ending:
            if self.over:
                return
            self.stage = stage
        self.end(self)


class Process:
    """One process, and the thread that hears it."""

    def __init__(self, crew: Crew) -> None:
        self._popen = subprocess.Popen(
            [sys.executable, "-m", "pin_metaik.processes.child"], stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )
        self._crew = crew
        self._in, self._out = cast(BinaryIO, self._popen.stdin), cast(BinaryIO, self._popen.stdout)
        self._sending = threading.Lock()
        self.run: Run | None = None
        threading.Thread(target=self._hear, name="hears a process", daemon=True).start()

    @property
    def pid(self) -> int:
        """Its number."""
        return self._popen.pid

    def send(self, message: object) -> None:
        """Send work or an order; one that is gone hears nothing."""
        with self._sending, contextlib.suppress(OSError, ValueError):
            send(self._in, message)

    def end(self) -> None:
        """End it now, and wait until it is gone."""
        self._popen.kill()
        self._popen.wait()
        with contextlib.suppress(OSError):
            self._in.close()

    def _hear(self) -> None:
        """Hand on what it tells, until it is gone."""
        with contextlib.suppress(EOFError, OSError):
            while True:
                message, run = receive(self._out), self.run
                if isinstance(message, Told):
                    if run is not None and not run.over:
                        run.tell(message)
                else:
                    self._crew.finished(self, message)
        self._out.close()
        self._crew.lost(self)


class Crew:
    """Processes, and the work that waits for one.

    Args:
        most: Processes at a time; None: one a core.
    """

    def __init__(self, most: int | None = None) -> None:
        self._most = most or os.cpu_count() or 1
        self._lock = threading.RLock()
        self._waiting: deque[Run] = deque()
        self._processes: list[Process] = []
        self._closed = False

    @property
    def pids(self) -> list[int]:
        """The processes that there are."""
        with self._lock:
            return [process.pid for process in self._processes]

    @property
    def busy(self) -> int:
        """How many runs work, or wait for a process."""
        with self._lock:
            return len(self._waiting) + sum(process.run is not None for process in self._processes)

    def prepare(self) -> None:
        """Have a process ready, which takes a second."""
        with self._lock:
            if not self._processes and not self._closed:
                self._processes.append(Process(self))

    def begin(self, work: Work, tell: Tell, end: End, *, held: bool = False, pause: float = 0.0) -> Run:
        """Hand over some work.

        Args:
            work: Called with a watch, in another process: it, and what it returns, have to pickle.
            tell: Called with its progress, in a thread of the crew.
            end: Called once with the run when it is over, in a thread of the crew or of whoever ends it.
            held: Whether to hold it after its first step.
            pause: s between two steps.
        """
        run = Run(self, work, held, pause, tell, end)
        with self._lock:
            self._waiting.append(run)
            self._hand_out()
        return run

    def order(self, run: Run, order: Order) -> None:
        """See ``Run.order``."""
        with self._lock:
            process = run.process
            if run.stage is Stage.WAITING:
                run.held = order in (Order.HOLD, Order.STEP) or (run.held and order is not Order.GO)
                if order is not Order.STOP:
                    return
                self._waiting.remove(run)
        if run.stage is Stage.WAITING:
            run.finish(Stage.ENDED)
        elif process is not None and not run.over:
            process.send(order)
            if order is Order.STOP:
                deadline = threading.Timer(ENDING, self._end_late, [run, process])
                deadline.daemon = True
                deadline.start()

    def finished(self, process: Process, outcome: Done | Failed) -> None:
        """A process is free again."""
        with self._lock:
            run, process.run = process.run, None
            self._hand_out()
        if run is not None:
            match outcome:
                case Done(result):
                    run.result = result
                    run.finish(Stage.DONE)
                case Failed(error):
                    run.error = error
                    run.finish(Stage.FAILED)

    def lost(self, process: Process) -> None:
        """A process is gone: ended by us, or by the machine when memory ran out."""
        process.end()
        with self._lock:
            if process in self._processes:
                self._processes.remove(process)
            run, process.run = process.run, None
            self._hand_out()
        if run is not None:
            run.error = MetaIKError(
                "the process that worked on this was ended from outside, for want of memory perhaps"
            )
            run.finish(Stage.FAILED)

    def close(self) -> None:
        """End everything; nothing of it is left running."""
        with self._lock:
            self._closed = True
            processes, self._processes = self._processes, []
            runs = [*self._waiting, *(process.run for process in processes if process.run is not None)]
            self._waiting.clear()
            for process in processes:
                process.run = None
        for process in processes:
            process.end()
        for run in runs:
            run.finish(Stage.ENDED)

    def _end_late(self, run: Run, process: Process) -> None:
        """End a process whose work did not end when it was told to."""
        with self._lock:
            if run.over or process.run is not run:
                return
            process.run = None
            self._processes.remove(process)  # before it is gone: nobody shall be given to it meanwhile
        process.end()
        run.finish(Stage.ENDED)

    def _hand_out(self) -> None:
        """Give work that waits to processes that do nothing. The lock is held."""
        while self._waiting and not self._closed:
            idle = next((process for process in self._processes if process.run is None), None)
            if idle is None:
                if len(self._processes) >= self._most:
                    return
                idle = Process(self)
                self._processes.append(idle)
            run = self._waiting.popleft()
            run.process, run.stage, idle.run = idle, Stage.WORKING, run
            idle.send((run.work, run.held, run.pause))
