"""A comparison: robots, cases and methods, how many tasks and seeds, and the budget of each target."""

from __future__ import annotations

import itertools
from collections.abc import Container, Iterable, Iterator, Sequence, Set
from dataclasses import dataclass, field
from typing import Any

from pin_metaik.arguments import checked
from pin_metaik.compare.cases.case import Case
from pin_metaik.compare.methods.method import Method
from pin_metaik.compare.methods.peers import Peer
from pin_metaik.compare.trials.lookup import case_of, method_of
from pin_metaik.compare.trials.trial import generator
from pin_metaik.compare.trials.work_item import WorkItem
from pin_metaik.errors import InvalidSetting
from pin_metaik.robots import load_robot


@checked
@dataclass(frozen=True)
class Suite:
    """A comparison: robots, cases, methods and budget.

    Attributes:
        robots: Names or paths, as ``load_robot`` takes them.
        cases: Names, ``"module:object"``, or cases themselves.
        methods: Names, ``"module:object"``, or methods themselves.
        tasks: Tasks of each case for each robot.
        seeds: Repetitions of each method on each task.
        budget: Kernel evaluations for each target.
        rng: Seed of every random choice.
        robots_by_name: The robots by name.
        cases_by_name: The cases by name.
        methods_by_name: The methods by name.

    Raises:
        UnknownName: There is no such robot, case or method.
        InvalidSetting: Nothing to compare, a number below one, or two of the same name.
        MissingExtra: The package of a method is not installed.
    """

    robots: tuple[str, ...]
    cases: tuple[str | Case, ...]
    methods: tuple[str | Method, ...]
    tasks: int = 100
    seeds: int = 1
    budget: int = 5000
    rng: int = 0
    robots_by_name: dict[str, str] = field(init=False, repr=False)
    cases_by_name: dict[str, Case] = field(init=False, repr=False)
    methods_by_name: dict[str, Method] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        for what in ("tasks", "seeds", "budget"):
            if getattr(self, what) < 1:
                raise InvalidSetting(f"{what} is at least 1, got {getattr(self, what)}")
        labels = [load_robot(robot).name for robot in self.robots]
        object.__setattr__(self, "robots_by_name", _named("robot", labels, self.robots))
        cases = [case_of(case) for case in self.cases]
        object.__setattr__(self, "cases_by_name", _named("case", [case.name for case in cases], cases))
        methods = [method_of(method) for method in self.methods]
        object.__setattr__(self, "methods_by_name", _named("method", [method.name for method in methods], methods))
        for method in methods:
            if isinstance(method, Peer):
                method.need()

    @property
    def trials(self) -> int:
        """Number of its rows."""
        pairs = len(self.robots_by_name) * len(self.cases_by_name)
        return pairs * len(self.methods_by_name) * self.tasks * self.seeds

    def absent(self) -> dict[str, str]:
        """Pairs ``robot/case`` without tasks, and why."""
        found = {}
        for (robot, spec), case in itertools.product(self.robots_by_name.items(), self.cases_by_name.values()):
            reason = case.lacks(load_robot(spec), generator(self.rng, robot, case.name))
            if reason:
                found[pair_name(robot, case.name)] = reason
        return found

    @checked
    def work_items(
        self, done: Set[tuple[str, str, str, int, int]] = frozenset(), absent: Container[str] = ()
    ) -> Iterator[WorkItem]:
        """The trials that are not ``done``, one work item for each task, without the ``absent`` pairs."""
        for (robot, spec), case, number in itertools.product(
            self.robots_by_name.items(), self.cases_by_name.values(), range(self.tasks)
        ):
            runs = [
                (method, seed)
                for method in self.methods_by_name.values()
                for seed in range(self.seeds)
                if (robot, case.name, method.name, number, seed) not in done
            ]
            if runs and pair_name(robot, case.name) not in absent:
                yield WorkItem(robot, spec, case, number, tuple(runs), self.budget, self.rng)


def pair_name(robot: str, case: str) -> str:
    """Name of a pair of robot and case."""
    return f"{robot}/{case}"


def _named(kind: str, names: Sequence[str], things: Iterable[Any]) -> dict[str, Any]:
    """Things by name.

    Raises:
        InvalidSetting: None at all, or two of the same name.
    """
    if not names:
        raise InvalidSetting(f"name at least one {kind} to compare")
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise InvalidSetting(f"two {kind}s are called {twice[0]!r}: rows could not tell them apart")
    return dict(zip(names, things, strict=True))
