"""Work items in several processes, here or on a cluster: the rows of each, as soon as it is done."""

from __future__ import annotations

import contextlib
import threading
import warnings
from collections.abc import Iterator, Sequence
from concurrent.futures import CancelledError
from multiprocessing import resource_tracker
from multiprocessing.util import Finalize
from typing import Any, Literal, Protocol, TypeAlias, TypeVar

from pin_metaik.errors import InvalidSetting
from pin_metaik.interrupts import Pressed, deaf_children
from pin_metaik.lookup import need

T = TypeVar("T")
T_co = TypeVar("T_co", covariant=True)
Backend: TypeAlias = Literal["loky", "dask"]

CONNECTING = 10.0  # s
ENDING = 5.0  # s
MOST_JOBS = 10_000
LOKYS_THREAD = "ExecutorManagerThread"
LOKYS_FEEDER = "QueueFeederThread"


class WorkItem(Protocol[T_co]):
    """A part of the work, which can be sent to another process."""

    def run(self) -> T_co:
        """Do it."""
        ...


def need_joblib(feature: str) -> None:
    """Make sure that work can be handed to workers.

    Raises:
        MissingExtra: joblib is not installed.
    """
    need(feature, "compare", "joblib")


def check_jobs(jobs: int) -> None:
    """Make sure that a number of processes is one.

    Raises:
        InvalidSetting: It is not.
    """
    if jobs == 0 or abs(jobs) > MOST_JOBS:
        raise InvalidSetting(
            f"jobs is a number of processes, 1 to {MOST_JOBS:,}, or -1 for one on each core; got {jobs}"
        )


def worked(items: Sequence[WorkItem[T]], jobs: int, backend: Backend, scheduler: str | None) -> Iterator[T]:
    """The results of work items, in the order in which they are finished.

    Raises:
        MissingExtra: joblib or distributed is not installed.
        InvalidSetting: The scheduler cannot be reached, or has gone.
    """
    with contextlib.ExitStack() as stack:
        chosen: dict[str, Any] = {"backend": backend, "n_jobs": jobs}
        if backend == "dask":
            chosen |= {"client": stack.enter_context(_cluster(scheduler)), "n_jobs": -1}
        stack.enter_context(_no_last_words())
        others = set(threading.enumerate())
        results: Any = None
        try:
            with Pressed(held=True):  # or it might come in a callback of weak references, which swallows it
                results = _begun(items, chosen)
            for result in results:  # noqa: UP028  # `yield from` would close them before the lines below
                yield result
        except (OSError, TimeoutError, CancelledError) as error:
            if backend != "dask":
                raise
            raise InvalidSetting(
                f"the Dask scheduler at {scheduler} has gone ({type(error).__name__}): what is done is kept, and the "
                "same call goes on with another one"
            ) from None
        except BaseException:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # joblib's, of tasks that an interrupt leaves undone
                if results is not None:
                    results.close()
            _await_feeders(others)
            raise


def _begun(items: Sequence[WorkItem[Any]], chosen: dict[str, Any]) -> Any:
    """The generator of results, its processes begun; they do not hear Ctrl-C."""
    from joblib import Parallel, delayed, parallel_config
    from joblib.externals.loky.backend import resource_tracker as lokys_tracker

    for tracker in (resource_tracker, lokys_tracker):  # when that of Python begins, it unblocks signals
        tracker.ensure_running()
    with parallel_config(**chosen), deaf_children():
        parallel = Parallel(return_as="generator_unordered", pre_dispatch="3*n_jobs")
        return parallel(delayed(_run)(item) for item in items)


def _run(item: WorkItem[T]) -> T:
    return item.run()


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
