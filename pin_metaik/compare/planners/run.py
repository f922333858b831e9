"""Path planners on the same scenes: every run with its plan and its processor time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from time import process_time
from typing import TYPE_CHECKING, Any, TypeAlias

from pin_metaik.arguments import checked
from pin_metaik.errors import InvalidSetting
from pin_metaik.optimize import Budget, Metaheuristic
from pin_metaik.optimize.settings import few
from pin_metaik.randomness import as_generator
from pin_metaik.watching import Progress, Watch, ended, tell

if TYPE_CHECKING:  # shapely is an extra
    from pin_metaik.mobile import Fitness, PathPlan, PathPlanner, PathProblem

Planner: TypeAlias = "str | Metaheuristic | PathPlanner"

EXACT = "exact"
WARM = Budget(evaluations=60)
DEFAULT_BUDGET = Budget(evaluations=5000)


@dataclass(frozen=True, eq=False)
class PlannerRun:
    """One run.

    Attributes:
        scene: Name of the scene.
        method: Name of the planner.
        run: Number of the run, from 0; its seed is that of the comparison plus this number.
        plan: Its result.
        seconds: Processor time, s, from the free space on; it does not depend on the load of the machine.
    """

    scene: str
    method: str
    run: int
    plan: PathPlan
    seconds: float


@dataclass(frozen=True, eq=False)
class PlannerComparison:
    """Runs of path planners on the same scenes.

    Attributes:
        problems: The problems, by name of the scene.
        methods: Names of the planners.
        runs: The runs that were done.
        planned: Number of runs of the whole comparison.
    """

    problems: Mapping[str, PathProblem]
    methods: tuple[str, ...]
    runs: tuple[PlannerRun, ...]
    planned: int

    @property
    def partial(self) -> bool:
        """Whether it was interrupted."""
        return len(self.runs) < self.planned

    @checked
    def of(self, scene: str, method: str) -> list[PlannerRun]:
        """The runs of a planner on a scene."""
        return [run for run in self.runs if (run.scene, run.method) == (scene, method)]

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON."""
        runs = [
            {"method": run.method, "run": run.run, **run.plan.as_dict(), "processor_seconds": run.seconds}
            for run in self.runs
        ]
        return {"methods": list(self.methods), "planned": self.planned, "runs": runs}


@checked
def compare_planners(
    problems: Any,
    methods: Mapping[str, Any] | Sequence[str] = (EXACT, "astar", "rrt", "rrtstar", "prm", "ga", "pso"),
    runs: int = 10,
    *,
    fitness: str | Fitness = "exact",
    via: int = 5,
    budget: Budget = DEFAULT_BUDGET,
    rng: int = 0,
    watch: Watch | None = None,
) -> PlannerComparison:
    """Run path planners on the same scenes, with the same budget and the same seeds.

    An evaluation is a path for metaheuristics and a straight line for other searches, so equal budgets are not equal
    work: compare times. Deterministic planners are run once.

    Args:
        problems: A scene or a problem, or several of them.
        methods: Names as for ``mobile.plan_path``, or a mapping from names to such names or planner objects.
        runs: Number of runs of every planner on every scene, with the seeds rng, rng + 1, ...
        fitness: What metaheuristics minimise.
        via: Number of via points of metaheuristics.
        budget: Of each run.
        rng: The first seed.
        watch: Called before every run with the runs done and in all; returning True ends the comparison.

    Raises:
        UnknownName: No planner of that name.
        InvalidSetting: No planners, or two scenes of one name.
        Blocked: The robot cannot be at the start or the goal of a scene.
        NoPath: A scene has no path, and therefore no shortest one to compare with.
        MissingExtra: A planner's package is not installed.
        Interrupted: Ctrl-C; its ``result`` has the runs that are done.
    """
    few("runs", runs)
    as_generator(rng)  # refuses what is no seed
    named = _named(problems)
    chosen = dict(methods) if isinstance(methods, Mapping) else {name: name for name in methods}
    if not chosen:
        raise InvalidSetting("give at least one planner to compare")
    once = {name for name, method in chosen.items() if _without_chance(method)}
    jobs = [(scene, name, run) for scene in named for name in chosen for run in range(1 if name in once else runs)]

    def one(problem: PathProblem, name: str, seed: int, limit: Budget) -> PathPlan:
        from pin_metaik import mobile

        asked = replace(problem) if _is_exact(chosen[name]) else problem  # without what was worked out before
        return mobile.plan_path(asked, chosen[name], fitness=fitness, via=via, budget=limit, rng=seed, trace=True)

    for problem in named.values():
        problem.optimum  # noqa: B018  # raises where there is no way; every run is measured by it
    done: list[PlannerRun] = []

    def comparison() -> PlannerComparison:
        return PlannerComparison(named, tuple(chosen), tuple(done), len(jobs))

    try:
        for name in chosen:
            one(next(iter(named.values())), name, rng, WARM)  # what is compiled and imported once is in no run's time
        for scene, name, run in jobs:
            tell(watch, Progress(len(done), len(jobs), label=f"{scene}, {name}"))
            began = process_time()
            plan = one(named[scene], name, rng + run, budget)
            done.append(PlannerRun(scene, name, run, plan, process_time() - began))
    except KeyboardInterrupt as stop:
        return ended(stop, comparison())
    return comparison()


def _named(problems: Any) -> dict[str, PathProblem]:
    """Problems by the names of their scenes."""
    from pin_metaik.mobile import PathProblem, Scene

    given = [problems] if isinstance(problems, (PathProblem, Scene)) else problems
    try:
        several = [PathProblem.of(each) if isinstance(each, Scene) else each for each in given]
    except TypeError:
        several = []
    if not several or not all(isinstance(each, PathProblem) for each in several):
        raise InvalidSetting("problems: expected a Scene or a PathProblem, or several of them")
    named = {each.scene.name: each for each in several}
    if len(named) < len(several):
        raise InvalidSetting("problems: each scene needs a name of its own, Scene(..., name=...)")
    return named


def _without_chance(method: Planner) -> bool:
    """Whether a planner gives the same path whatever the seed."""
    from pin_metaik import mobile

    return _is_exact(method) or isinstance(mobile.planner_of(method), mobile.GridAStar)


def _is_exact(method: Planner) -> bool:
    return isinstance(method, str) and method == EXACT
