"""Work items in several processes, here or on a cluster: the rows of each, as soon as it is done."""

from __future__ import annotations

import contextlib
import threading
import warnings
from collections.abc import Iterator
from multiprocessing import resource_tracker
from multiprocessing.util import Finalize
from typing import Any, Literal, TypeAlias

from pin_metaik.compare.trials.trial import Trial
from pin_metaik.compare.trials.work_item import WorkItem
from pin_metaik.errors import InvalidSetting
from pin_metaik.interrupts import Pressed, deaf_children
from pin_metaik.lookup import need

Backend: TypeAlias = Literal["loky", "dask"]

CONNECTING = 10.0  # s
ENDING = 5.0  # s
LOKYS_THREAD = "ExecutorManagerThread"
LOKYS_FEEDER = "QueueFeederThread"


def need_joblib() -> None:
    """Make sure that tasks can be handed to workers.

    Raises:
        MissingExtra: joblib is not installed.
    """
    need("comparing methods", "compare", "joblib")


def worked(items: list[WorkItem], jobs: int, backend: Backend, scheduler: str | None) -> Iterator[list[Trial]]:
    """The rows of work items, in the order in which they are finished."""
    with contextlib.ExitStack() as stack:
        chosen: dict[str, Any] = {"backend": backend, "n_jobs": jobs}
        if backend == "dask":
            chosen |= {"client": stack.enter_context(_cluster(scheduler)), "n_jobs": -1}
        stack.enter_context(_no_last_words())
        others = set(threading.enumerate())
        with Pressed(held=True) as pressed:  # or it might come in a callback of weak references, which swallows it
            rows = _begun(items, chosen)
        try:
            pressed.check()
            for trials in rows:  # noqa: UP028  # `yield from` would close them before the lines below
                yield trials
        except BaseException:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # joblib's, of tasks that an interrupt leaves undone
                rows.close()
            _await_feeders(others)
            raise


def _begun(items: list[WorkItem], chosen: dict[str, Any]) -> Any:
    """The generator of rows, its processes begun; they do not hear Ctrl-C."""
    from joblib import Parallel, delayed, parallel_config
    from joblib.externals.loky.backend import resource_tracker as lokys_tracker

    for tracker in (resource_tracker, lokys_tracker):  # when that of Python begins, it unblocks signals
        tracker.ensure_running()
    with parallel_config(**chosen), deaf_children():
        parallel = Parallel(return_as="generator_unordered", pre_dispatch="3*n_jobs")
        return parallel(delayed(WorkItem.run)(item) for item in items)


@contextlib.contextmanager
def _no_last_words() -> Iterator[None]:
    """What loky's own thread stumbles over when its work is taken away (a KeyError of its queue) is not printed."""
    before = threading.excepthook

    def hook(stumble: threading.ExceptHookArgs) -> None:
        if stumble.thread is None or stumble.thread.name != LOKYS_THREAD:
            before(stumble)

    threading.excepthook = hook
    try:
        yield
    finally:
        threading.excepthook = before


def _await_feeders(others: set[threading.Thread]) -> None:
    """Let the process not end before loky's threads that feed its queues have, those in ``others`` apart.

    They end when their queue is closed, at exit (priority 10). One that is cut off while it gives its semaphores back
    (priority 0) leaves one to loky's tracker of resources, which then warns of it.
    """
    for thread in set(threading.enumerate()) - others:
        if thread.name == LOKYS_FEEDER:
            Finalize(None, thread.join, (ENDING,), exitpriority=5)


def _cluster(scheduler: str | None) -> Any:
    """A client of a Dask cluster, to be closed."""
    need("a Dask cluster", "cluster", "distributed")
    from distributed import Client

    if scheduler is None:
        raise InvalidSetting("name the Dask cluster: --scheduler ADDRESS, e.g. tcp://localhost:8786")
    try:
        return Client(scheduler, timeout=CONNECTING)  # type: ignore[no-untyped-call]  # it carries no types
    except (OSError, ValueError) as error:
        raise InvalidSetting(f"no Dask scheduler answers at {scheduler}: {error}") from None
