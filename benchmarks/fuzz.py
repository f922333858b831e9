"""Odd files, and odd command lines, for everything that reads: a result or an error of ours, and nothing else.

    python benchmarks/fuzz.py [--inputs 100000] [--slow 10000] [--seed 0] [--minutes M] [--only NAME ...] [--kept FILE]

Good files are changed as trees and as bytes (see fuzz_inputs.py), and read in processes that can die, thousands in one
of them. A fault is an exception outside the family of ``MetaIKError``, the end of the process, a call that takes longer
than 5 s, and memory above 1 GiB beyond what the process has when it begins.

All readers go on together, part by part, in as many processes as ``--workers``. With ``--kept`` each part is written to
a file when it is done, and not done again while the sources are the same; with ``--earlier`` readers that these sources
have not read count as earlier ones read them, and the page says which. With ``--after`` the numbers after those that a
page counts are read, and the counts are added. With ``--minutes`` no part begins later.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import math
import os
import re
import tempfile
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import asdict, dataclass, field
from multiprocessing import get_context
from pathlib import Path

import numpy as np
from apart import Hangs, alarm, apart, seconds_of
from fuzz_readers import Reader, readers
from proof_soundness import sources
from rich.progress import track
from sections import conditions

import pin_metaik as mik
from pin_metaik.compiled import ahead

DIGESTS = "Digests of the sources:"
LATE = 5.0  # s of processor time; a call that takes longer hangs
SILENT = 120.0  # s after which a call that nothing is heard of is ended
ROOM = 1 << 30  # bytes that reading may take
SHARE = 2_000  # inputs that are read in one folder, in one child if none ends it
IN_MEMORY = Path("/dev/shm")  # where folders are made, if it is there: writing takes longer than reading
LONGEST = 2_000  # characters of a message


@dataclass
class Counts:
    """What came of a reader's inputs.

    Attributes:
        inputs: How many.
        read: Of them, read.
        refused: Refused with an error of ours.
        faults: How often each kind of fault, by its words; what is in parentheses is the number of an input.
        longest: Longest time, s.
    """

    inputs: int = 0
    read: int = 0
    refused: int = 0
    faults: dict[str, int] = field(default_factory=dict)
    longest: float = 0.0

    def __add__(self, other: Counts) -> Counts:
        faults = self.faults | {what: self.faults.get(what, 0) + count for what, count in other.faults.items()}
        read, refused = self.read + other.read, self.refused + other.refused
        return Counts(self.inputs + other.inputs, read, refused, faults, max(self.longest, other.longest))


Outcome = tuple[str, float]
"""What came of an input, "read", "refused" or a fault in words, and the time it took, s."""


def fuzz(reader: Reader, numbers: range) -> Counts:
    """Let a reader read its odd inputs of these numbers."""
    counts, faults, first = Counts(), Counter[str](), dict[str, int]()
    with tempfile.TemporaryDirectory(dir=IN_MEMORY if IN_MEMORY.is_dir() else None) as folder:
        reader.beside(Path(folder))
        path = Path(folder, reader.file)
        outcomes = apart(
            len(numbers),
            lambda i: _outcome(reader, path, numbers[i]),
            lambda _, how: (how, 0.0),
            SILENT,
            ROOM,
        )
    for number, (what, seconds) in zip(numbers, outcomes, strict=True):
        counts.inputs += 1
        counts.longest = max(counts.longest, seconds)
        if what == "read":
            counts.read += 1
        elif what == "refused":
            counts.refused += 1
        else:
            faults[what] += 1
            first.setdefault(what, number)
    counts.faults = {f"{what} (input {first[what]})": count for what, count in faults.most_common()}
    return counts


def _outcome(reader: Reader, path: Path, number: int) -> Outcome:
    """What comes of one input, in this process."""
    path.write_bytes(reader.odd(number))
    os.chdir(path.parent)
    return seconds_of(lambda: _what(reader, path))


def _what(reader: Reader, path: Path) -> str:
    try:
        with alarm(LATE), warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            reader.read(path)
    except mik.MetaIKError as error:
        return "refused" if _printable(error) else f"{type(error).__name__} of {len(str(error)):,} characters"
    except Hangs as error:
        return f"takes longer than {LATE:g} s at {_place(error)}"
    except Exception as error:
        return f"{type(error).__name__} at {_place(error)}: {' '.join(str(error).split())[:80]}"
    return "read"


def _printable(error: mik.MetaIKError) -> bool:
    """Whether a message is one that a terminal takes, and somebody reads."""
    return len(str(error)) < LONGEST and str(error).isprintable()


def _place(error: BaseException) -> str:
    """The last line of the package's own in a traceback."""
    lines = traceback.extract_tb(error.__traceback__)
    ours = [line for line in lines if "/pin_metaik/" in line.filename]
    last = (ours or list(lines))[-1]
    return f"{Path(last.filename).name}:{last.lineno}"


Part = tuple[str, int, int]
"""A reader's name, the number of its first input, and how many."""


@dataclass
class Kept:
    """Parts that are done, in a file or in memory only: a line a part, with a digest of the sources that read it.

    Attributes:
        file: The file.
        earlier: Whether parts that other sources read count, if these have not read any of the same reader.
        parts: What came of each part.
        by: Digest of the sources, of each reader.
    """

    file: Path | None
    earlier: bool = False
    parts: dict[Part, Counts] = field(default_factory=dict)
    by: dict[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.sources = sources(*sorted(Path(__file__).parent.glob("fuzz_*.py")))
        text = self.file.read_text(encoding="utf-8") if self.file is not None and self.file.exists() else ""
        lines = [(by, tuple(part), Counts(**counts)) for by, part, counts in map(json.loads, text.splitlines())]
        now = {name for by, (name, *_), _ in lines if by == self.sources}
        self.by = {name: by for by, (name, *_), _ in lines if by == self.sources or (self.earlier and name not in now)}
        self.parts = {part: counts for by, part, counts in lines if self.by.get(part[0]) == by}

    def add(self, part: Part, counts: Counts) -> None:
        """Keep what came of a part that was read now."""
        self.parts[part], self.by[part[0]] = counts, self.sources
        if self.file is not None:
            with self.file.open("a", encoding="utf-8") as file:
                file.write(json.dumps([self.sources, part, asdict(counts)]) + "\n")


def all_counted(asked: dict[str, range], minutes: float, workers: int, kept: Kept) -> dict[str, Counts]:
    """Counts of each reader for inputs of these numbers; parts that are kept are not read again."""
    ends = time.monotonic() + 60.0 * minutes
    readers()  # makes good files once, for all workers
    parts = [
        (name, first, min(SHARE, numbers.stop - first))
        for name, numbers in asked.items()
        for first in range(numbers.start, numbers.stop, SHARE)
    ]
    share = {part: (part[1] - asked[part[0]].start) / len(asked[part[0]]) for part in parts}
    waiting = sorted((part for part in parts if part not in kept.parts), key=share.__getitem__)
    with ProcessPoolExecutor(workers, get_context("fork")) as pool:
        futures = [pool.submit(_part, part, ends) for part in waiting]
        for future in track(as_completed(futures), "parts", len(futures), transient=True):
            part, counts = future.result()
            if counts is not None:
                print(f"{part}: {counts}", flush=True)
                kept.add(part, counts)
    total = {name: Counts() for name in asked}
    for part in parts:
        total[part[0]] += kept.parts.get(part, Counts())
    return total


def counted_on(page: Path) -> tuple[dict[str, Counts], str]:
    """The counts of each reader on a page that was written before, and its line about the sources."""
    text, counts = page.read_text(encoding="utf-8"), {}
    for row in re.findall(r"^\| ([^|]+) \|((?: [0-9,]+ \|)+) ([0-9.]+) \|$", text, re.MULTILINE):
        numbers = [int(cell.replace(",", "")) for cell in row[1].strip(" |").split("|")]
        faults = {"on the page before": numbers[-1]} if numbers[-1] else {}
        counts[row[0]] = Counts(numbers[0], numbers[-3], numbers[-2], faults, float(row[2]))
    return counts, next(line for line in text.splitlines() if line.startswith(DIGESTS))


def _part(part: Part, ends: float) -> tuple[Part, Counts | None]:
    """What comes of a part, in a worker; None: it would begin too late, after ``ends`` by the monotonic clock."""
    name, first, count = part
    return part, None if time.monotonic() > ends else fuzz(readers()[name], range(first, first + count))


def page(counts: dict[str, Counts], before: dict[str, Counts], by: dict[str, str], earlier: str) -> Iterator[str]:
    """The page, paragraph by paragraph: counts of this run, and of those before it."""
    yield "# Odd files and command lines"
    yield conditions()
    yield (
        "*Refused*: an error of the family of `MetaIKError`, in words that can be printed. *Faults*: all other "
        f"exceptions, processes that end, calls of more than {LATE:g} s, more than 1 GiB of memory."
    )
    table = [
        "| what is read | inputs | of them now | read | refused | faults | longest, s |",
        "|---" + "|---:" * 6 + "|",
    ]
    both = {name: before.get(name, Counts()) + counts.get(name, Counts()) for name in {**before, **counts}}
    for name, c in both.items():
        now = counts.get(name, Counts()).inputs
        table.append(f"| {name} | {cells(c, now)} | {c.longest:.2f} |")
    table.append(f"| all | {cells(sum(both.values(), Counts()), sum(c.inputs for c in counts.values()))} | |")
    yield "\n".join(table)
    said = [f"- {name}: {count} x `{what}`" for name, c in counts.items() for what, count in c.faults.items()]
    if said:
        yield "\n".join(said)
    read_by: dict[str, list[str]] = {}
    for name in counts:
        read_by.setdefault(by[name], []).append(name)
    if not read_by:  # nothing new was asked for
        yield earlier
        return
    usual = max(read_by, key=lambda digest: len(read_by[digest]))
    other = "".join(f"; {digest}: *{'*, *'.join(names)}*" for digest, names in read_by.items() if digest != usual)
    yield f"{DIGESTS} {usual}{other}." + (f" Before: {earlier}" if earlier else "")


def cells(counts: Counts, now: int) -> str:
    """The counts of a row of the table."""
    return f"{counts.inputs:,} | {now:,} | {counts.read:,} | {counts.refused:,} | {sum(counts.faults.values()):,}"


def main() -> None:
    """Read, count, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--inputs", type=int, default=100_000, help="of each reader that takes a millisecond or so")
    parser.add_argument("--slow", type=int, default=10_000, help="of each other one")
    parser.add_argument("--seed", type=int, default=0, help="number of the first input")
    parser.add_argument("--minutes", type=float, default=math.inf, help="by the clock, after which no part begins")
    parser.add_argument("--only", nargs="+", default=[""], help="readers whose name holds one of these")
    parser.add_argument("--workers", type=int, default=2, help="processes that read at once")
    parser.add_argument("--kept", type=Path, help="file that finished parts are kept in")
    parser.add_argument("--after", type=Path, help="page of an earlier run that this one goes on from")
    parser.add_argument("--earlier", action="store_true", help="count readers as other sources read them, if need be")
    parser.add_argument("--out", type=Path, default=Path(__file__).with_suffix(".md"))
    given = parser.parse_args()
    out, kept = given.out.absolute(), Kept(given.kept and given.kept.absolute(), given.earlier)
    before, earlier = counted_on(given.after) if given.after else ({}, "")
    loops, _ = ahead.versions()
    for _ in ahead.each(ahead.Version.compile, [loop for loop in loops if not loop.ready]):
        pass  # what is compiled when it is first called counts as late
    with elsewhere():
        asked = {
            name: range(given.seed + before.get(name, Counts()).inputs, given.seed + wanted)
            for name, one in readers().items()
            if any(some in name for some in given.only)
            for wanted in [given.inputs if one.fast else given.slow]
        }
        asked = {name: numbers for name, numbers in asked.items() if numbers}
        counts = all_counted(asked, given.minutes, given.workers, kept)
    counts = {name: some for name, some in counts.items() if some.inputs}
    out.write_text("\n\n".join(page(counts, before, kept.by, earlier)) + "\n", encoding="utf-8")


@contextlib.contextmanager
def elsewhere() -> Iterator[None]:
    """In a folder of its own."""
    before = Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            yield
        finally:
            os.chdir(before)


if __name__ == "__main__":
    main()
