"""Claims of the paper on paths among polygons, and whether our runs confirm them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from statistics import median

from pin_metaik.compare.papers.claims import Claim, verdict
from pin_metaik.compare.papers.path_planning_setup import SETTINGS, PathTrial


def trials_of(trials: Sequence[PathTrial], scene: str, method: str, fitness: str) -> list[PathTrial]:
    """The runs of a method on a scene with a fitness."""
    return [trial for trial in trials if (trial.scene, trial.method, trial.fitness) == (scene, method, fitness)]


def claims(trials: Sequence[PathTrial]) -> Iterator[Claim]:
    """Whether PSO finds the better path, whether it is faster, and two things that cannot be seen."""
    pairs = [(trials_of(trials, scene, "GA", "paper"), trials_of(trials, scene, "PSO", "paper")) for scene in SETTINGS]
    pairs = [(ga, pso) for ga, pso in pairs if ga and pso]
    shorter = [_gap(pso) < _gap(ga) for ga, pso in pairs]
    fitter = [median(t.f for t in pso) < median(t.f for t in ga) for ga, pso in pairs]
    stuck = sum(_free(pso) < _free(ga) for ga, pso in pairs)
    yield Claim(
        "PSO finds better paths than GA",
        verdict([*shorter, *fitter]),
        f"with the paper's fitness its median gap is smaller on {sum(shorter)} of {len(pairs)} scenes, its median "
        f"fitness better on {sum(fitter)}; but it ends in an obstacle more often than GA on {stuck}",
    )
    slower = [median(t.seconds for t in ga) / median(t.seconds for t in pso) for ga, pso in pairs]
    taken = f"{min(slower):.2f} to {max(slower):.2f}" if slower else "-"
    yield Claim(
        "PSO is faster than GA",
        verdict(ratio > 1 for ratio in slower),
        f"GA takes {taken} times as long for as many evaluations: one costs both the same, the rest is how their "
        "bookkeeping is written",
    )
    yield Claim(
        "GA gets to 12.0545 in 33.6 s (example 1)",
        "cannot be checked",
        "its obstacles are not given; the time is that of 10,000 evaluations on a Pentium 4",
    )
    yield Claim(
        "p_p = 2.2 punishes detours",
        "does not reproduce",
        "it never acts: it takes a segment longer than three times the distance from start to goal, which is more "
        "than the workspace's diagonal",
    )


def _gap(runs: Sequence[PathTrial]) -> float:
    """Median gap of the free runs; inf without any."""
    gaps = [trial.gap for trial in runs if trial.gap is not None]
    return median(gaps) if gaps else float("inf")


def _free(runs: Sequence[PathTrial]) -> float:
    return sum(trial.free for trial in runs) / len(runs)
