"""Claims of the paper on learned turns, and whether our networks confirm them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from statistics import median

from pin_metaik.compare.papers.claims import Claim, verdict
from pin_metaik.compare.papers.trajectory_setup import (
    CONTROLS,
    NETS,
    POINTS,
    PRINTED,
    TRAINERS,
    NetTrial,
    PlanTrial,
    SpeedTrial,
)

CONTROL_IS = {"random": " of the test set", "chebyshev": ", a grid denser at its borders,"}
NEAR = 2.0  # errors within this factor of the printed ones are the same


def nets_of(nets: Sequence[NetTrial], net: str, trainer: str, points: str, design: str = "paper") -> list[NetTrial]:
    """The runs of one kind of network."""
    return [t for t in nets if (t.net, t.trainer, t.points, t.design) == (net, trainer, points, design)]


def middle(trials: Sequence[NetTrial], error: str) -> float:
    """Median over the runs of one of the errors."""
    return float(median(getattr(trial, error) for trial in trials))


def claims(nets: Sequence[NetTrial], speeds: Sequence[SpeedTrial]) -> Iterator[Claim]:
    """Clustered points, the trainers, the errors themselves, and the speed."""
    yield _clustering(nets)
    yield _trainers(nets)
    yield _errors(nets)
    yield _speed(speeds)


def remarks(nets: Sequence[NetTrial]) -> Iterator[str]:
    """What other training points do, in sentences."""
    for net in NETS:
        errors = {points: nets_of(nets, net, "lm", points) for points in POINTS}
        if all(errors.values()):
            said = ", ".join(f"{points} {middle(runs, 'E0'):.3g}" for points, runs in errors.items())
            yield f"E0 of {net} with Levenberg-Marquardt by training points: {said} percent."
    for points in CONTROLS:
        runs = [(nets_of(nets, net, "lm", points), nets_of(nets, net, "lm", "grid")) for net in NETS]
        if all(control and grid for control, grid in runs):
            better = sum(middle(control, "E0") < middle(grid, "E0") for control, grid in runs)
            yield (
                f"Control: as many {POINTS[points]}{CONTROL_IS[points]} beat the grid, too, in {better} of {len(runs)} "
                "nets."
            )


def plan_remarks(plans: Sequence[PlanTrial]) -> Iterator[str]:
    """Time lost by the search, and errors of the end by networks, in sentences."""
    best = {trial.scene: trial.time for trial in plans if trial.method == "dp"}
    found = {trial.scene: trial.time for trial in plans if trial.method == "de"}
    if best and found.keys() == best.keys():
        worse = [100 * (found[scene] / best[scene] - 1) for scene in best]
        yield f"The search ends up to {max(worse):.2f} percent above dynamic programming."
    for net in dict.fromkeys(trial.method for trial in plans if trial.tangent_error is not None):
        misses = [trial.end_error for trial in plans if trial.method == net]
        yield f"With {net} the robot ends {min(misses):.3g} to {max(misses):.3g} mm from the goal."


def _clustering(nets: Sequence[NetTrial]) -> Claim:
    kinds = [(net, trainer) for net in NETS for trainer in TRAINERS]
    pairs = [(nets_of(nets, *kind, "grid"), nets_of(nets, *kind, "fcm")) for kind in kinds]
    pairs = [(grid, fcm) for grid, fcm in pairs if grid and fcm]
    lower = [middle(fcm, "E0") < middle(grid, "E0") for grid, fcm in pairs]
    larger, full = (sum(middle(f, error) > middle(g, error) for g, f in pairs) for error in ("Em", "Fm"))
    return Claim(
        "clustered points give the lower mean error in all models",
        verdict(lower),
        f"in {sum(lower)} of {len(pairs)}; in its own table in 7 of 8, with one tie. Their largest relative error is "
        f"larger in {larger} (in the table in 3), as a share of the full scale in {full}",
    )


def _trainers(nets: Sequence[NetTrial]) -> Claim:
    holds, said = [], []
    for net in NETS:
        trained = {trainer: nets_of(nets, net, trainer, "grid") for trainer in TRAINERS}
        if all(trained.values()):
            ranks = sorted((middle(trials, "mse"), trainer) for trainer, trials in trained.items())
            holds.append((ranks[0][1], ranks[-1][1]) == ("lm", "rprop"))
            said.append(f"{net}: " + ", ".join(f"{trainer} {mse:.1e}" for mse, trainer in ranks))
    return Claim(
        "Levenberg-Marquardt is the best trainer, resilient backpropagation the worst",
        verdict(holds),
        "mean squared errors of the training on the grid: " + "; ".join(said),
    )


def _errors(nets: Sequence[NetTrial]) -> Claim:
    pairs = [(nets_of(nets, *key), printed) for key, printed in PRINTED.items()]
    ratios = [middle(runs, "E0") / printed.E0 for runs, printed in pairs if runs]
    near = [1 / NEAR <= ratio <= NEAR for ratio in ratios]
    times = f"{min(ratios):.1f} to {max(ratios):.1f}" if ratios else "-"
    return Claim(
        "the errors of Table 1",
        verdict(near),
        f"our mean errors are {times} times the printed ones, {sum(near)} of {len(near)} within a factor of {NEAR:g}: "
        "the plain tangent length spans three decades, and the scaling the paper must have used is not named",
    )


def _speed(speeds: Sequence[SpeedTrial]) -> Claim:
    by = {(trial.method, trial.count): trial.microseconds for trial in speeds}
    said = "the network makes planning fast, 1/8 of the time"
    if not by:
        return Claim(said, "not run", "-")
    stepped, closed = ([by[way, n] / by["ANN 2:5:1", n] for n in (1, 1000)] for way in ("step by step", "closed form"))
    return Claim(
        said,
        verdict(ratio > 1 for ratio in (*stepped, *closed)),
        f"2:5:1 takes 1/{stepped[0]:.2g} of the time of integrating a turn in 1,000 steps (1/{stepped[1]:.0f} for "
        f"1,000 turns at once), and {1 / closed[0]:.2g} ({1 / closed[1]:.2g}) times that of the closed form, which is "
        "exact",
    )
