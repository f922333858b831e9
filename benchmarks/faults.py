"""Work that is killed, has no room, meets itself, or loses its workers: nothing is lost, nothing is there twice.

    python benchmarks/faults.py [--kills 50] [--full 10] [--twice 10] [--workers 5] [--only FAULT] [--work NAME]

* kills: ``kill -9`` at a random moment of a comparison, a map of reach, a design, and a paper's experiment; then the
  same again, killed again every other time, until it is done. What there is then equals what an uninterrupted run has,
  to the last bit. Designs and papers begin again; of the others what was done is not done again.
* full: a disk that is full after a random number of bytes (``RLIMIT_FSIZE``): an error of ours, and later the rest.
* twice: two processes begin the same comparison in one folder at once: one works, the other is refused by name.
* workers: a worker of a Dask cluster is killed in the middle of a comparison.
* clock: the files of a comparison are a year newer than the clock says when it goes on.
"""

from __future__ import annotations

import argparse
import contextlib
import csv
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from io import StringIO
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import typer
from rich.progress import track
from sections import conditions

import pin_metaik as mik
from pin_metaik import stewart
from pin_metaik.cli.reproduce import reproduce
from pin_metaik.compare import Suite, compare
from pin_metaik.compare.folder.store import ROWS, read_rows

SUITE = Suite(("ur5",), ("random", "singular"), ("lm", "mtde@60+dls"), tasks=4, seeds=2, budget=200)
KILLED, REFUSED = 9, 7  # how children end
TIMES = {"CPU ms", "CPU s ours", "seconds"}  # headings of what is not the same when it is done again
YEAR = 365 * 86_400.0  # s


@dataclass
class Count:
    """How often something was done, and what came of it.

    Attributes:
        title: What was done.
        times: How often it took effect.
        wrong: Times after which something was lost, there twice, or different.
        said: Times that an error of ours said what was wrong.
    """

    title: str
    times: int = 0
    wrong: int = 0
    said: int = 0


@dataclass(frozen=True)
class Work:
    """Something that takes long and leaves files.

    Attributes:
        name: What it is.
        run: Does it, into a folder, from where it stopped.
        result: What it has left in a folder, to be compared.
    """

    name: str
    run: Callable[[Path], object]
    result: Callable[[Path], Any]


def compared(folder: Path) -> None:
    """A small comparison."""
    compare(SUITE, folder)


def rows(folder: Path) -> list[str]:
    """Its rows without times, as they are in the file: none may be there twice."""
    there = [str(trial.reproducible) for trial in read_rows(folder)]
    lines = (folder / ROWS).read_bytes().count(b"\n")
    return [*sorted(there), f"{lines} lines"]


def mapped(folder: Path) -> None:
    """A map of reach, in parts."""
    robot = mik.load_robot("ur5")
    positions = np.random.default_rng(0).uniform(-1.0, 1.0, (3_000, 3))
    mik.reachability(mik.Chain(robot, robot.frame), positions, 8, folder=folder)


def map_of(folder: Path) -> tuple[bytes, bytes]:
    """Its answers."""
    found = mik.Reachability.load(folder / "reachability.npz")
    return found.status.tobytes(), found.manipulability.tobytes()


def designed(folder: Path) -> None:
    """A platform's design, in a file."""
    mechanism = stewart.load_mechanism("stroke_50")
    assert mechanism.task is not None
    grid = replace(mechanism.task.grid, counts=(5, 5, 5))
    task = replace(mechanism.task, evaluations=60, grid=grid)
    found = stewart.design(replace(mechanism, task=task))
    folder.mkdir(exist_ok=True)
    stewart.save_mechanism(found.mechanism, folder / "found.toml")


def design_of(folder: Path) -> bytes:
    """The file, which is whole."""
    stewart.load_mechanism(folder / "found.toml")
    return (folder / "found.toml").read_bytes()


def reproduced(folder: Path) -> None:
    """A paper's experiment, into a page and tables."""
    with contextlib.suppress(typer.Exit), contextlib.redirect_stdout(StringIO()):
        reproduce("puma_offset", runs=1, quick=True, out=folder, figures=False)


def tables_of(folder: Path) -> tuple[bool, list[str], list[list[dict[str, str]]]]:
    """Whether its page is of all jobs, the files that are there, and its tables without the times that runs took."""
    files = sorted(folder.iterdir())
    page = (folder / "puma_offset.md").read_text(encoding="utf-8")
    texts = [path.read_text(encoding="utf-8") for path in files if path.suffix == ".csv"]
    tables = [list(csv.DictReader(text.splitlines())) for text in texts]
    untimed = [[{key: row[key] for key in row.keys() - TIMES} for row in rows] for rows in tables]
    return "All 8 jobs done" in page, [path.name for path in files], untimed


WORKS = (
    Work("comparison", compared, rows),
    Work("map of reach", mapped, map_of),
    Work("design", designed, design_of),
    Work("paper's experiment", reproduced, tables_of),
)


def begun(run: Callable[[Path], object], folder: Path, limit: int | None = None) -> int:
    """The number of a child that does some work; it may write files of ``limit`` bytes at most."""
    child = os.fork()
    if child:
        return child
    code = 1
    try:
        os.setsid()
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
        if limit is not None:
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
        run(folder)
        code = 0
    except mik.MetaIKError:
        code = REFUSED
    finally:
        os._exit(code)


def ended(child: int) -> int:
    """How a child ended: its exit code, or minus the signal."""
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


@contextlib.contextmanager
def folders() -> Iterator[Callable[[], Path]]:
    """What gives folders that are not there yet."""
    with tempfile.TemporaryDirectory() as inside:
        numbers = iter(range(10**9))
        yield lambda: Path(inside, str(next(numbers)))


def whole(work: Work, folder: Path) -> tuple[Any, float]:
    """What an uninterrupted run leaves, and how long it takes, s."""
    work.run(folder)  # here: children have what is compiled
    again = folder.with_name(f"{folder.name}_again")
    began = time.perf_counter()
    ended(begun(work.run, again))
    return work.result(again), time.perf_counter() - began


def kills(count: int, rnd: Random, works: Iterable[Work] = WORKS) -> Iterator[Count]:
    """Kill works at random moments."""
    for work in works:
        done = Count(f"`kill -9` of a {work.name}")
        with folders() as new:
            expected, seconds = whole(work, new())
            while done.times < count:
                folder = new()
                for _ in range(rnd.choice((1, 2, 3))):
                    child = begun(work.run, folder)
                    time.sleep(rnd.uniform(0.0, seconds))
                    os.killpg(os.getpgid(child), signal.SIGKILL) if _leads(child) else os.kill(child, signal.SIGKILL)
                    done.times += ended(child) == -signal.SIGKILL
                code = ended(begun(work.run, folder))
                done.wrong += code != 0 or work.result(folder) != expected
        yield done


def _leads(child: int) -> bool:
    """Whether a child has a group of its own by now."""
    with contextlib.suppress(ProcessLookupError):
        return os.getpgid(child) == child
    return False


def full(count: int, rnd: Random) -> Iterator[Count]:
    """Let works have no room."""
    for work in WORKS[:2]:
        done = Count(f"disk full in a {work.name}")
        with folders() as new:
            expected, _ = whole(work, new())
            for _ in range(count):
                folder = new()
                code = ended(begun(work.run, folder, limit=rnd.randint(0, 12_000)))
                done.times += code != 0
                done.said += code == REFUSED
                done.wrong += code not in (0, REFUSED)
                code = ended(begun(work.run, folder))
                done.wrong += code != 0 or work.result(folder) != expected
        yield done


def twice(count: int, rnd: Random) -> Iterator[Count]:
    """Let two processes work in one folder."""
    for work in WORKS[:2]:
        done = Count(f"two writers of a {work.name}")
        with folders() as new:
            expected, seconds = whole(work, new())
            for _ in range(count):
                folder = new()
                first = begun(work.run, folder)
                time.sleep(rnd.uniform(0.0, 0.3 * seconds))
                codes = [ended(begun(work.run, folder)), ended(first)]
                done.times += 1
                done.said += REFUSED in codes
                done.wrong += 0 not in codes or not set(codes) <= {0, REFUSED} or work.result(folder) != expected
        yield done


def clock(count: int, rnd: Random) -> Iterator[Count]:
    """Let works go on a year before they began."""
    work, done = WORKS[0], Count("clock set back by a year in a comparison")
    with folders() as new:
        expected, seconds = whole(work, new())
        for _ in range(count):
            folder = new()
            child = begun(work.run, folder)
            time.sleep(rnd.uniform(0.3, 1.0) * seconds)
            os.kill(child, signal.SIGKILL)
            ended(child)
            for path in folder.rglob("*"):
                os.utime(path, (time.time() + YEAR,) * 2)
            done.times += 1
            done.wrong += ended(begun(work.run, folder)) != 0 or work.result(folder) != expected
    yield done


@contextlib.contextmanager
def cluster() -> Iterator[tuple[str, list[subprocess.Popen[bytes]]]]:
    """The address of a Dask cluster of two workers on this machine, and its processes: the scheduler, the workers."""
    from distributed import Client

    with tempfile.TemporaryDirectory() as folder, contextlib.ExitStack() as stack:
        file = Path(folder, "scheduler.json")
        here = ["--host", "127.0.0.1", "--no-dashboard"]
        processes: list[subprocess.Popen[bytes]] = []

        def start(*words: str) -> None:
            one = subprocess.Popen(
                [sys.executable, "-m", "dask", *words], cwd=folder, start_new_session=True,
                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            )  # fmt: skip
            processes.append(one)
            stack.callback(one.wait)
            stack.callback(one.terminate)

        start("scheduler", "--port", "0", "--scheduler-file", str(file), *here)
        while not file.exists() or not file.stat().st_size:
            time.sleep(0.05)
        for _ in range(2):
            start("worker", "--scheduler-file", str(file), "--nworkers", "1", "--nthreads", "1", "--no-nanny", *here)
        with Client(scheduler_file=str(file), timeout=60) as client:  # type: ignore[no-untyped-call]
            client.wait_for_workers(2, timeout=120)
            address = str(client.scheduler.address)
        yield address, processes


def workers(count: int, rnd: Random) -> Iterator[Count]:
    """Kill a worker of a cluster, and in the end its scheduler."""
    gone, lost = Count("dead workers of a comparison"), Count("a scheduler that is gone, and another one")
    with folders() as new:
        expected, _ = whole(WORKS[0], new())
        for _ in range(count):
            folder = new()
            with cluster() as (address, processes):
                child = begun(partial(compare, SUITE, backend="dask", scheduler=address), folder)
                _await_rows(folder, rnd.randint(1, 6))
                processes[rnd.choice((1, 2))].kill()
                gone.times += 1
                gone.wrong += ended(child) != 0 or rows(folder) != expected
        folder = new()
        with cluster() as (address, processes):
            child = begun(partial(compare, SUITE, backend="dask", scheduler=address), folder)
            _await_rows(folder, 2)
            processes[0].kill()
            lost.said += ended(child) == REFUSED
        with cluster() as (address, processes):
            child = begun(partial(compare, SUITE, backend="dask", scheduler=address), folder)
            lost.times += 1
            lost.wrong += ended(child) != 0 or rows(folder) != expected or lost.said != 1
    yield gone
    yield lost


def _await_rows(folder: Path, count: int) -> None:
    """Wait until so many rows are there."""
    until = time.monotonic() + 120.0
    while time.monotonic() < until:
        with contextlib.suppress(FileNotFoundError):
            if (folder / ROWS).read_bytes().count(b"\n") >= count:
                return
        time.sleep(0.01)


FAULTS = {"kills": kills, "full": full, "twice": twice, "clock": clock, "workers": workers}


def page(counts: list[Count]) -> Iterator[str]:
    """The page, paragraph by paragraph."""
    yield "# Faults"
    yield conditions()
    yield (
        "*Lost or doubled*: what there is in the end differs from what an uninterrupted run has. *Named*: the "
        "fault was told by an error of the family of `MetaIKError`."
    )
    table = ["| fault | times | named | lost or doubled |", "|---|---:|---:|---:|"]
    table += [f"| {one.title} | {one.times} | {one.said} | {one.wrong} |" for one in counts]
    yield "\n".join(table)


def main() -> None:
    """Do it all, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, count in {"kills": 50, "full": 10, "twice": 10, "clock": 3, "workers": 5}.items():
        parser.add_argument(f"--{name}", type=int, default=count)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", default="", help="faults whose name holds this")
    parser.add_argument("--work", default="", help="kill only works whose name holds this")
    parser.add_argument("--out", type=Path, default=Path(__file__).with_suffix(".md"))
    given = parser.parse_args()
    counts: list[Count] = []
    killed = partial(kills, works=[work for work in WORKS if given.work in work.name])
    for name, fault in track((FAULTS | {"kills": killed}).items(), "faults", transient=True):
        if given.only in name and getattr(given, name):
            for one in fault(getattr(given, name), Random(given.seed)):
                counts.append(one)
                print(one, flush=True)
    given.out.write_text("\n\n".join(page(counts)) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
