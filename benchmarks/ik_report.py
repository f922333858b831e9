"""What was measured of inverse-kinematics solvers, and the Markdown page it makes."""

from __future__ import annotations

import datetime
import os
import platform
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from ik_targets import FAMILIES
from numpy.typing import NDArray

OURS = "pin_metaik"
UNREACHABLE = "UNREACHABLE"

Floats = NDArray[np.float64]


@dataclass
class Row:
    """One solver on one robot's targets of one family; times in us.

    Attributes:
        solved: Judgement of each answer.
        cpu: Processor time of each solve, the mean of its block.
        wall: Time of each solve on the wall.
        evaluations: What the solver counts, where it does.
        said: How many answers were UNREACHABLE.
        blocks: Mean (cpu, wall) of the solves of each block; all passes of a block together.
    """

    robot: str
    family: str
    solver: str
    solved: list[bool] = field(default_factory=list)
    cpu: list[float] = field(default_factory=list)
    wall: list[float] = field(default_factory=list)
    evaluations: list[int] = field(default_factory=list)
    said: int = 0
    _passes: dict[int, list[tuple[float, float]]] = field(default_factory=dict)

    def add(self, block: int, answer: dict[str, Any], solved: list[bool]) -> None:
        """Take a worker's answer to a block, the first or another pass."""
        cpu, wall = 1e-3 * np.array(answer["cpu"]), 1e-3 * np.array(answer["wall"])
        self.cpu += cpu.tolist()
        self.wall += wall.tolist()
        if block not in self._passes:
            self.solved += solved
            self.evaluations += [e for e in answer["evaluations"] if e is not None]
            self.said += answer["status"].count(UNREACHABLE)
        self._passes.setdefault(block, []).append((float(cpu.mean()), float(wall.mean())))

    @property
    def blocks(self) -> Floats:
        """(b, 2) mean (cpu, wall) of each block."""
        return np.array([np.mean(passes, axis=0) for passes in self._passes.values()])


@dataclass(frozen=True)
class BatchRate:
    """One run of a batch.

    Attributes:
        wall: us a solve on the wall.
        cpu: us a solve of processor time, all workers together.
    """

    robot: str
    workers: int
    wall: float
    cpu: float
    solved: int
    count: int


@dataclass
class Report:
    """Everything measured, and what could not be.

    Attributes:
        versions: Of the solvers that ran.
        missing: Why a solver could not be had.
        unsuitable: By solver and robot, why it could not take it.
    """

    command: str = ""
    targets: int = 0
    peer_targets: int = 0
    rows: list[Row] = field(default_factory=list)
    batch: list[BatchRate] = field(default_factory=list)
    versions: dict[str, str] = field(default_factory=dict)
    missing: dict[str, str] = field(default_factory=dict)
    unsuitable: dict[str, dict[str, str]] = field(default_factory=dict)
    interrupted: bool = False

    def line(self, robot: str, family: str) -> str:
        """One line on what is just finished."""
        rows = self._rows(family, robot=robot)
        ours = rows[0]
        peers = [f"{row.solver} {_percent(row.solved)} x{_number(ratio(row, ours)[0])}" for row in rows[1:]]
        head = f"{robot} {family}: {_percent(ours.solved)} {np.mean(ours.cpu):.1f} us p99 {_p99(ours.wall):.0f} us"
        return "; ".join([head, *peers])

    def markdown(self) -> str:
        """The page."""
        versions = ", ".join(f"{name} {number}" for name, number in self.versions.items())
        lines = [
            "# Inverse kinematics side by side",
            "",
            f"`{self.command}`, {datetime.date.today()}, {os.cpu_count()}-core {_machine()}, "
            f"Python {platform.python_version()}: {versions}.",
            "",
        ]
        if self.interrupted:
            lines += ["**Interrupted: only what was finished is here.**", ""]
        lines += [
            f"Random starts; {self.targets:,} targets a robot and family for {OURS}, the first {self.peer_targets:,} "
            "for the peers, which have 50 ms a target, with random restarts. Solved: within 1e-5 m and 1e-5 rad "
            "and inside the limits, by Pinocchio, whatever the solver says. Times are us a call, unsolved "
            "targets included: means of processor time (of all threads: TRAC-IK runs two); median, p99 and *wall* by "
            f"the clock. *x ours* is how many times longer than {OURS} a solver takes: the median over blocks of "
            "targets that both were given within "
            "the same moments. A tail of slow targets hides from that median, so *of means* is the ratio of the mean "
            "times on the same targets.",
            "",
        ]
        for family in dict.fromkeys(row.family for row in self.rows):
            lines += [f"## {family}", "", FAMILIES[family], "", *self._summary(family), "", *self._robots(family), ""]
        if self.batch:
            lines += ["## Batches", "", *self._batches(), ""]
        if self.missing or self.unsuitable:
            lines += ["## Not measured", ""]
            lines += [f"- {name}: {reason}" for name, reason in self.missing.items()]
            for name, robots in self.unsuitable.items():
                reasons: dict[str, list[str]] = {}
                for robot, reason in robots.items():
                    reasons.setdefault(reason, []).append(robot)
                lines += [f"- {name} on {', '.join(robots)}: {reason}" for reason, robots in reasons.items()]
            lines += [""]
        return "\n".join(lines).rstrip() + "\n"

    def _rows(self, family: str, *, robot: str = "", solver: str = "") -> list[Row]:
        return [
            row for row in self.rows if row.family == family and robot in ("", row.robot) and solver in ("", row.solver)
        ]

    def _summary(self, family: str) -> list[str]:
        said = family == "unreachable"
        lines = [
            f"| over all robots | robots | {'said so | ' if said else ''}solved | mean us | median | p99 | wall mean "
            "| evaluations | x ours | x ours, wall | x ours, of means |",
            "|---|" + "---|" * (10 + said),
        ]
        ours = {row.robot: row for row in self._rows(family, solver=OURS)}
        for solver in dict.fromkeys(row.solver for row in self._rows(family)):
            rows = self._rows(family, solver=solver)
            solved = [s for row in rows for s in row.solved]
            wall = np.concatenate([row.wall for row in rows])
            counted = [np.mean(row.evaluations) for row in rows if row.evaluations]
            same = [ours[row.robot] for row in rows]
            ratios = ["1", "1", "1"] if solver == OURS else [_number(r) for r in ratio(rows, same)]
            cells = [
                f"**{solver}**" if solver == OURS else solver,
                str(len(rows)),
                *([f"{100.0 * sum(row.said for row in rows) / len(solved):.2f} %"] if said and solver == OURS else []),
                *(["never"] if said and solver != OURS else []),
                f"{_percent(solved)}{_missed(solved, said)}",
                f"{np.mean([np.mean(row.cpu) for row in rows]):.1f}",
                f"{np.median(wall):.1f}",
                f"{_p99(wall):.0f}",
                f"{np.mean([np.mean(row.wall) for row in rows]):.1f}",
                f"{np.mean(counted):.1f}" if counted else "",
                *ratios,
            ]
            lines.append(f"| {' | '.join(cells)} |")
        return lines

    def _robots(self, family: str) -> list[str]:
        said = family == "unreachable"
        peers = [s for s in dict.fromkeys(row.solver for row in self._rows(family)) if s != OURS]
        lines = [
            *(["Of the peers: solved, mean us, x ours.", ""] if peers else []),
            f"| {OURS} | {'said so | ' if said else ''}solved | mean us | median | p99 | evaluations "
            + "".join(f"| {peer} " for peer in peers)
            + "|",
            "|---|" + "---|" * (5 + said + len(peers)),
        ]
        for robot in dict.fromkeys(row.robot for row in self._rows(family)):
            ours, *_ = self._rows(family, robot=robot, solver=OURS)
            cells = [
                robot,
                *([f"{100.0 * ours.said / len(ours.solved):.2f} %"] if said else []),
                f"{_percent(ours.solved)}{_missed(ours.solved, said)}",
                f"{np.mean(ours.cpu):.1f}",
                f"{np.median(ours.wall):.1f}",
                f"{_p99(ours.wall):.0f}",
                f"{np.mean(ours.evaluations):.1f}",
            ]
            for peer in peers:
                found = self._rows(family, robot=robot, solver=peer)
                cells += [
                    f"{_percent(row.solved)}, {np.mean(row.cpu):.0f}, {_number(ratio(row, ours)[0])}" for row in found
                ] or [""]
            lines.append(f"| {' | '.join(cells)} |")
        return lines

    def _batches(self) -> list[str]:
        lines = [
            f"`solve_ik_batch` on {self.batch[0].count:,} random targets, the best of the runs, which took turns: us a "
            "solve on the wall and of processor time.",
            "",
            "| workers | robots | solved | mean us | processor | rate |",
            "|---|---|---|---|---|---|",
        ]
        runs: dict[int, dict[str, list[BatchRate]]] = {}
        for run in self.batch:
            runs.setdefault(run.workers, {}).setdefault(run.robot, []).append(run)
        whole = [robot for robot in runs[1] if all(robot in of for of in runs.values())]
        alone = 0.0
        for workers, of in runs.items():
            wall = np.mean([min(run.wall for run in of[robot]) for robot in whole])
            cpu = np.mean([min(run.cpu for run in of[robot]) for robot in whole])
            alone = alone or float(wall)
            solved = 100.0 * np.mean([run.solved / run.count for robot in whole for run in of[robot]])
            cells = f"{workers} | {len(whole)} | {solved:.2f} % | {wall:.1f} | {cpu:.1f} | {alone / wall:.2f}"
            lines.append(f"| {cells} |")
        return lines


def ratio(theirs: Row | list[Row], ours: Row | list[Row]) -> tuple[float, float, float]:
    """How many times longer they take: medians over blocks of processor time and of the wall, and of the means.

    Of several robots the blocks of the same number are added up first, so that this is a ratio of means over robots.
    """
    pairs = list(zip(_list(theirs), _list(ours), strict=True))
    blocks = min(len(row.blocks) for row, _ in pairs)
    above, below = (sum(side.blocks[:blocks] for side in sides) for sides in zip(*pairs, strict=True))
    of_blocks = np.median(np.asarray(above) / np.asarray(below), axis=0)
    of_means = np.asarray(above).mean(axis=0)[0] / np.asarray(below).mean(axis=0)[0]
    return float(of_blocks[0]), float(of_blocks[1]), float(of_means)


def _list(rows: Row | list[Row]) -> list[Row]:
    return rows if isinstance(rows, list) else [rows]


def _percent(solved: Iterable[bool]) -> str:
    share = 100.0 * float(np.mean(list(solved)))
    return f"{share:.2f} %" if share in (0.0, 100.0) else f"{min(max(share, 0.01), 99.99):.2f} %"


def _missed(solved: list[bool], nothing_expected: bool) -> str:
    wrong = sum(solved) if nothing_expected else len(solved) - sum(solved)
    return f" ({wrong:,} of {len(solved):,})" if wrong else ""


def _p99(us: list[float] | Floats) -> float:
    return float(np.quantile(us, 0.99))


def _number(value: float) -> str:
    return f"{value:.0f}" if value >= 100.0 else f"{value:.3g}"


def _machine() -> str:
    return {"AMD64": "x86-64", "x86_64": "x86-64"}.get(platform.machine(), platform.machine())
