"""Claims of a paper, and whether they hold here: a verdict in two words, and the numbers it rests on."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from pin_metaik.compare.report import Column, Table

Verdict = Literal["reproduces", "in part", "does not reproduce", "cannot be checked", "not run"]


@dataclass(frozen=True)
class Claim:
    """A claim and its verdict.

    Attributes:
        said: The claim, as a sentence without its full stop.
        verdict: Whether it holds here.
        because: The numbers that say so.
    """

    said: str
    verdict: Verdict
    because: str


def verdict(holds: Iterable[bool]) -> Verdict:
    """The verdict on a claim that was tried on several cases."""
    cases = list(holds)
    if not cases:
        return "not run"
    return "reproduces" if all(cases) else "in part" if any(cases) else "does not reproduce"


def claims_table(name: str, claims: Iterable[Claim]) -> Table:
    """Claims as a table.

    Args:
        name: Stem of its CSV file.
        claims: One a row.
    """
    columns = (Column("the paper says"), Column("here"), Column("because"))
    return Table(name, "Claims", columns, [(claim.said, claim.verdict, claim.because) for claim in claims])
