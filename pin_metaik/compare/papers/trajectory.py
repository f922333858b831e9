"""Trajectories with learned turns: the networks' errors, the planner's times, and what the closed form makes of it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from pin_metaik.compare.papers.claims import claims_table
from pin_metaik.compare.papers.paper import Job, Options, Paper
from pin_metaik.compare.papers.trajectory_claims import claims, middle, of, plan_remarks, remarks
from pin_metaik.compare.papers.trajectory_setup import (
    CONTROLS,
    COUNTS,
    NETS,
    PIECES,
    POINTS,
    PRINTED,
    PRINTED_ITERATIONS,
    TRAINERS,
    Lab,
    NetTrial,
    PlanTrial,
    SpeedTrial,
    routes,
)
from pin_metaik.compare.report import Column, Figure, Section, Table, Value, plots

COST = {"lm": 4.0, "bfgs": 1.5, "rprop": 1.0, "scg": 3.0}  # of a training, roughly


def jobs(options: Options) -> Iterator[Job[Any]]:
    """The networks on the grid, the clustering, the networks on its centres; then plans and speeds; then more runs."""
    lab = Lab(options)

    def trained(net: str, trainer: str, points: str, design: str, run: int) -> Job[NetTrial]:
        label = f"{net}, {trainer}, {points}, {design} design, run {run + 1}"
        return Job(label, lab.net(net, trainer, points, design, run), COST[trainer] * (1 + len(NETS[net])))

    for run in range(options.runs):
        yield from (trained(net, trainer, "grid", "paper", run) for net in NETS for trainer in TRAINERS)
        yield from (trained(net, "lm", "grid", "log", run) for net in NETS)
        if run == 0:
            yield from (Job(f"fuzzy c-means {i + 1}/{PIECES}", lab.cluster, 5.0) for i in range(PIECES))
        yield from (trained(net, trainer, "fcm", "paper", run) for net in NETS for trainer in TRAINERS)
        yield from (trained(net, "lm", points, "paper", run) for net in NETS for points in CONTROLS)
        if run == 0:
            yield Job("speed", lab.speed)
            for name, (path, obstacles) in routes(options).items():
                yield Job(f"plans, {name}", lab.plan(name, path, obstacles), 2.0)


def sections(done: Sequence[Any], options: Options) -> list[Section]:
    """Table 1, its claims, a better design, the speed of everything, and the plans."""
    nets = [trial for trial in done if isinstance(trial, NetTrial)]
    speeds = [trial for trials in done if isinstance(trials, list) for trial in trials if isinstance(trial, SpeedTrial)]
    plans = [trial for trials in done if isinstance(trials, list) for trial in trials if isinstance(trial, PlanTrial)]
    return [
        Section(
            "Table 1: the networks",
            (
                "E0 is the mean, Em the largest relative error in percent, E5 how many of the n test vectors exceed 5 "
                "percent; F0 and Fm are the same as shares of the longest tangent. At angle 0 the relative error is "
                "undefined: vectors from 1 degree on count. Ours are medians over the starts of the weights, with "
                f"{Lab(options).iterations:,} iterations (the paper: {PRINTED_ITERATIONS:,}); activation, scaling, "
                "initial weights and three of the robot's four limits are not printed and were assumed.",
                *remarks(nets),
            ),
            (claims_table("trajectory_claims", claims(nets, speeds)), table_1(nets), every_net(nets)),
            figures(nets),
        ),
        Section(
            "A better design of the same idea",
            (
                "The tangent length is the speed times a function of the angle alone, spans three decades and rises "
                "like a square root. With its logarithm as the output and the logarithm of the speed and the root of "
                "the angle as inputs the same networks do much better:",
            ),
            (designs(nets),),
        ),
        Section("Speed", (), (speed_table(speeds),)),
        Section(
            "Plans",
            (
                "dp is dynamic programming over the speeds in the corners, de the paper's search with the closed form, "
                "ANN the same with a network. Networks are executed with the true turns: an error of the tangent "
                "length shifts all that follows, and the robot misses the goal by the last column.",
                *plan_remarks(plans),
            ),
            (plan_table(plans),),
        ),
    ]


def table_1(nets: Sequence[NetTrial]) -> Table:
    """The paper's Table 1 and ours, and two controls."""
    rows: list[tuple[Value, ...]] = []
    for net in NETS:
        for trainer, trainer_name in TRAINERS.items():
            for points, name in POINTS.items():
                runs, paper = of(nets, net, trainer, points), PRINTED.get((net, trainer, points))
                if runs:
                    ours = tuple(middle(runs, error) for error in ("E0", "Em", "E5", "F0", "Fm", "mse"))
                    rows.append((net, trainer_name, name, *(paper or (None,) * 3), *ours, len(runs), runs[0].n))
    columns = (
        *(Column("net"), Column("trainer"), Column("points")),
        *(Column("paper E0", ".4g"), Column("paper Em", ".4g"), Column("paper E5", ",")),
        *(Column("E0", ".4g"), Column("Em", ",.4g"), Column("E5", ",.0f"), Column("F0", ".3g"), Column("Fm", ".3g")),
        *(Column("mse", ".1e"), Column("runs"), Column("n", ",")),
    )
    return Table("trajectory_networks", "Errors of tangent lengths, percent", columns, rows)


def designs(nets: Sequence[NetTrial]) -> Table:
    """Plain and logarithmic design side by side."""
    rows: list[tuple[Value, ...]] = []
    for net in NETS:
        for design in ("paper", "log"):
            runs = of(nets, net, "lm", "grid", design)
            if runs:
                rows.append((net, design, *(middle(runs, error) for error in ("E0", "Em", "E5", "F0", "Fm"))))
    columns = (
        *(Column("net"), Column("design"), Column("E0", ".3g"), Column("Em", ",.4g"), Column("E5", ",.0f")),
        *(Column("F0", ".3g"), Column("Fm", ".3g")),
    )
    return Table("trajectory_designs", "Levenberg-Marquardt on the grid", columns, rows)


def speed_table(speeds: Sequence[SpeedTrial]) -> Table:
    """Time for so many tangent lengths."""
    by = {(trial.method, trial.count): trial.microseconds for trial in speeds}
    rows: list[tuple[Value, ...]] = [
        (method, *(by.get((method, count)) for count in COUNTS)) for method in dict.fromkeys(t.method for t in speeds)
    ]
    columns = (Column("method"), *(Column(f"{count:,}", ",.1f") for count in COUNTS))
    return Table("trajectory_speed", "Microseconds for so many tangent lengths", columns, rows)


def plan_table(plans: Sequence[PlanTrial]) -> Table:
    """Every plan."""
    columns = (
        *(Column("path"), Column("corners"), Column("method"), Column("time s", ".3f"), Column("with stops s", ".3f")),
        *(Column("planning ms", ".1f"), Column("tangent error mm", ".3f"), Column("misses goal by mm", ".3f")),
        Column("keeps clear"),
    )
    shown = ("scene", "corners", "method", "time", "stop_and_turn", "milliseconds", "tangent_error", "end_error")
    rows: list[tuple[Value, ...]] = [
        (*(getattr(trial, name) for name in shown), "yes" if trial.clear else "no") for trial in plans
    ]
    return Table("trajectory_plans", "Time-optimal trajectories", columns, rows)


def every_net(nets: Sequence[NetTrial]) -> Table:
    """Every training, for the CSV file."""
    names = tuple(NetTrial.__dataclass_fields__)
    rows: list[tuple[Value, ...]] = [tuple(getattr(trial, name) for name in names) for trial in nets]
    return Table("trajectory_runs", "Every training", tuple(map(Column, names)), rows, shown=False)


def figures(nets: Sequence[NetTrial]) -> tuple[Figure, ...]:
    """Mean error by trainer: every run, the median and the paper's, grid and clustered points side by side."""
    if not nets:
        return ()
    short = {"grid": "grid", "fcm": "FCM"}
    panels = {
        net: {
            f"{trainer}\n{name}": plots.Runs(
                name,
                [trial.E0 for trial in of(nets, net, trainer, points)],
                PRINTED[net, trainer, points].E0,
            )
            for trainer in TRAINERS
            for points, name in short.items()
        }
        for net in NETS
    }

    def draw(canvas: Any) -> None:
        plots.strip(canvas, panels, "E0, percent", float(np.finfo(float).tiny))

    caption = "Mean relative error of every training, the median, and the paper's."
    return (Figure("trajectory_networks", caption, draw, plots.size(*(2 * len(TRAINERS) * 2 for _ in NETS))),)


TRAJECTORY = Paper(
    "trajectory",
    "Time-optimal trajectories with turns learned by fuzzy-clustered neural networks (Nomad 200)",
    "Fuzzy-clustered neural networks for trajectory planning of mobile robots (in Turkish)",
    5,
    jobs,
    sections,
)
