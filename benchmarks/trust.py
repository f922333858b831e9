"""What is promised, which tests hold it, and how far each was looked at: writes ``docs/trust.md`` from other pages.

python benchmarks/trust.py [--out PAGE]
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[1]
OUT = ROOT / "docs" / "trust.md"
TITLE = "What we promise, and how it is tested"
BEFORE = """Every promise has tests, which `make test` runs in minutes on every machine, and most have a program
that asks the same until nothing is left to find (`make soak`). What came of its longest run is a page that the
program wrote; this page takes its figures from those."""
AFTER = """What is not promised: real time (calls take microseconds to milliseconds, by distributions that the pages on
speed have), the same bits on processors of another kind, and that a search with a budget finds what exists."""


@dataclass(frozen=True)
class Promise:
    """A promise.

    Attributes:
        text: What is promised.
        tests: Files that hold it.
        page: Page of its longest run; empty without one.
        row: How the row of the page's table begins that says what came of it, or how a sentence of it begins.
    """

    text: str
    tests: tuple[str, ...]
    page: str = ""
    row: str = ""


PROMISES = (
    Promise(
        "`SOLVED` is verified by Pinocchio: within the tolerances, and every answer is inside the limits.",
        ("tests/properties/test_success.py",),
        "benchmarks/claims.md",
        "| all |",
    ),
    Promise(
        "`UNREACHABLE` is proved: no target that some configuration meets is ever called so.",
        ("tests/properties/test_success.py", "tests/kinematics/proofs/test_soundness.py"),
        "benchmarks/claims.md",
        "| all |",
    ),
    Promise("A success in a world is free of collisions, at its margin.", ("tests/properties/test_worlds.py",)),
    Promise(
        "The same seed gives the same bits: alone, in a batch, from a pickle, in threads, in other processes.",
        ("tests/properties/test_sameness.py", "tests/ik/test_batch.py", "tests/ik/test_processes.py"),
    ),
    Promise(
        "If the base and the targets are moved together, the answer stays the same.",
        ("tests/properties/test_sameness.py",),
    ),
    Promise("Budgets hold: evaluations to the last, seconds to a fifth.", ("tests/properties/test_budgets.py",)),
    Promise(
        "Odd arguments lead to a result or an error that says what would have worked.",
        ("tests/test_door.py",),
        "benchmarks/door.md",
        "calls of",
    ),
    Promise(
        "Odd files and command lines lead to the same: no traceback, no crash, no hang, no gigabyte.",
        ("tests/test_odd_inputs.py",),
        "benchmarks/fuzz.md",
        "| all |",
    ),
    Promise(
        "Long work that is killed, runs out of disk space or has two writers loses no row and doubles none.",
        ("tests/test_faults.py", "tests/compare/test_run.py"),
        "benchmarks/faults.md",
        "| `kill -9` of a comparison |",
    ),
    Promise(
        "Long runs: memory stays flat, and the last call is as quick as the first.",
        ("tests/test_load.py",),
        "benchmarks/load.md",
        "| solves |",
    ),
    Promise("Ctrl-C is heard at once, and brings what was found.", ("tests/ik/test_interrupts.py",)),
    Promise("Nothing asks the network.", ("tests/test_supply.py",)),
)


def found(page: Path, begins: str) -> str:
    """What a page says: the row that begins so, by the titles of its columns, or the paragraph with these words."""
    lines = page.read_text(encoding="utf-8").splitlines()
    at = next((i for i, line in enumerate(lines) if begins in line), None)
    if at is None:
        raise SystemExit(f"{page} has no line with {begins!r}")
    if not lines[at].startswith("|"):
        return lines[at].partition(". ")[0].replace("**", "").rstrip(".")
    head = max(i for i in range(at) if re.match(r"^\|\s*-", lines[i])) - 1
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in (lines[head], lines[at])]
    return "; ".join(f"{title}: {cell}" for title, cell in list(zip(*cells, strict=True))[1:] if cell)


def page() -> Iterator[str]:
    """The page, paragraph by paragraph."""
    yield f"# {TITLE}"
    yield BEFORE
    table = ["| promise | tests | longest run |", "|---|---|---|"]
    for one in PROMISES:
        tests = ", ".join(f"[{Path(test).name}](../{test})" for test in one.tests)
        said = f"{found(ROOT / one.page, one.row)} ([page](../{one.page}))" if one.page else "the tests"
        table.append(f"| {one.text} | {tests} | {said} |")
    yield "\n".join(table)
    yield AFTER


def text() -> str:
    """The whole page."""
    return "\n\n".join(page()) + "\n"


def main() -> None:
    """Write it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=OUT)
    parser.parse_args().out.write_text(text(), encoding="utf-8")


if __name__ == "__main__":
    main()
