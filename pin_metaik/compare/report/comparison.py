"""The report on a comparison: its sections, as one HTML page and as Markdown with tables and figures beside it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pin_metaik.arguments import checked
from pin_metaik.compare.folder.environment import read_environment
from pin_metaik.compare.report.by_case import by_case, convergence, duels, rates
from pin_metaik.compare.report.overview import overview, reading, winners
from pin_metaik.compare.report.page import write_page
from pin_metaik.compare.report.parts import Column, Section, Table, Value
from pin_metaik.compare.report.seeds import seeds_against_restarts
from pin_metaik.compare.report.worst import trouble, worst
from pin_metaik.compare.report.write import need_figures
from pin_metaik.compare.results.results import Results, read_results
from pin_metaik.compare.results.standing import headline
from pin_metaik.errors import InvalidSetting
from pin_metaik.output import writable

TITLE = "Inverse kinematics where it is hard"
STEM = "report"


@checked
def write_report(folder: Path) -> list[Path]:
    """Write the report on the comparison in a folder, into its folder ``report``.

    Returns:
        The files written, the page first.

    Raises:
        InvalidSetting: The folder holds no comparison, or no row yet.
        MissingExtra: matplotlib is not installed.
        CannotWrite: The report cannot be written there.
    """
    need_figures()
    results = read_results(folder)
    writable(folder / STEM, folder=True)
    if not results.trials:
        raise InvalidSetting(f"{folder} has no rows yet: run pin-metaik compare --out {folder}")
    sessions = read_environment(folder)
    lead = [headline(results), *lead_of(sessions)]
    return write_page(folder / STEM, STEM, TITLE, lead, sections(results, str(folder), sessions))


def sections(results: Results, folder: str, sessions: Sequence[dict[str, Any]]) -> list[Section]:
    """The sections of the report, in their order."""
    versus = Section("Every method against every other", (), (), (*rates(results), *duels(results)))
    found: list[Section | None] = [
        overview(results),
        seeds_against_restarts(results),
        winners(results),
        versus,
        *(by_case(results, case) for case in results.cases.values()),
        convergence(results),
        worst(results, folder),
        trouble(results),
        reading(results),
        conditions(sessions),
    ]
    return [section for section in found if section is not None]


def lead_of(sessions: Sequence[dict[str, Any]]) -> list[str]:
    """The command, the date and the machine."""
    if not sessions:
        return []
    last = sessions[-1]
    times = f", in {len(sessions)} sessions" if len(sessions) > 1 else ""
    machine = f"{last['cores']}-core {last['system']}, Python {last['python']}"
    return [f"`{last['command']}`", f"{last['date'][:10]}{times}, {machine}."]


def conditions(sessions: Sequence[dict[str, Any]]) -> Section | None:
    """Versions and machine; None if nothing was recorded."""
    if not sessions:
        return None
    last = sessions[-1]
    rows: list[tuple[Value, ...]] = [("processor", last["processor"]), ("cores", str(last["cores"]))]
    rows += [("system", last["system"]), ("Python", last["python"]), *last["packages"].items()]
    rows += [(f"session {i}", f"{s['date']}: `{s['command']}`") for i, s in enumerate(sessions, start=1)]
    table = Table("environment", "As recorded by the last session", (Column("what"), Column("which")), rows)
    text = ("Processor times are of a machine that does other things, too: compare ratios, not digits.",)
    return Section("Machine and versions", text, (table,))
