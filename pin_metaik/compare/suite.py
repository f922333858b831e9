"""What is compared: robots, cases and methods, how many targets and seeds, and the budget of each trial."""

from __future__ import annotations

import importlib
import itertools
from collections.abc import Iterable, Iterator, Sequence, Set
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

from pin_metaik.compare.case import Case, Task
from pin_metaik.compare.cases import CASES
from pin_metaik.compare.method import Method
from pin_metaik.compare.methods import named
from pin_metaik.compare.methods.peers import Peer
from pin_metaik.compare.trial import Trial, attempt, failed, generator
from pin_metaik.errors import InvalidSetting, UnknownName
from pin_metaik.kinematics import Chain
from pin_metaik.robots import Robot, load_robot


@dataclass(frozen=True)
class Suite:
    """A comparison.

    Attributes:
        robots: What ``load_robot`` takes.
        cases: Names, ``"module:object"``, or cases themselves.
        methods: Names, ``"module:object"``, or methods themselves.
        targets: Tasks of each case for each robot.
        seeds: Repetitions of each method on each task.
        budget: Kernel evaluations for each target.
        rng: Seed of everything random.

    Raises:
        UnknownName: A robot, case or method that there is not.
        InvalidSetting: Nothing to compare, a number below one, or two of the same name.
        MissingExtra: A peer that is not installed.
    """

    robots: tuple[str, ...]
    cases: tuple[str | Case, ...]
    methods: tuple[str | Method, ...]
    targets: int = 100
    seeds: int = 1
    budget: int = 5000
    rng: int = 0
    arms: dict[str, str] = field(init=False, repr=False)  # robots by name
    tasks: dict[str, Case] = field(init=False, repr=False)
    entrants: dict[str, Method] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        for what in ("targets", "seeds", "budget"):
            if getattr(self, what) < 1:
                raise InvalidSetting(f"{what} is at least 1, got {getattr(self, what)}")
        labels = [load_robot(robot).name for robot in self.robots]
        object.__setattr__(self, "arms", _named("robot", labels, self.robots))
        cases = [case_of(case) for case in self.cases]
        object.__setattr__(self, "tasks", _named("case", [case.name for case in cases], cases))
        methods = [method_of(method) for method in self.methods]
        object.__setattr__(self, "entrants", _named("method", [method.name for method in methods], methods))
        for method in methods:
            if isinstance(method, Peer):
                method.need()

    @property
    def trials(self) -> int:
        """How many rows it has."""
        return len(self.arms) * len(self.tasks) * len(self.entrants) * self.targets * self.seeds

    def units(self, done: Set[tuple[str, str, str, int, int]] = frozenset()) -> Iterator[Unit]:
        """The work that is left, a task at a time."""
        for (robot, spec), case, target in itertools.product(
            self.arms.items(), self.tasks.values(), range(self.targets)
        ):
            left = [
                (method, seed)
                for method in self.entrants.values()
                for seed in range(self.seeds)
                if (robot, case.name, method.name, target, seed) not in done
            ]
            if left:
                yield Unit(robot, spec, case, target, tuple(left), self.budget, self.rng)


@dataclass(frozen=True)
class Unit:
    """What is handed to a worker: one task, and who shall try it.

    Attributes:
        robot: Name of the robot.
        spec: What ``load_robot`` takes.
        case: The case.
        target: Number of the task.
        left: Methods and numbers of the repetitions.
        budget: Kernel evaluations for each target.
        rng: Seed of everything random.
    """

    robot: str
    spec: str
    case: Case
    target: int
    left: tuple[tuple[Method, int], ...]
    budget: int
    rng: int

    def task(self) -> Task:
        """The task, the same whoever tries it."""
        chain = _arm(self.spec, self.robot, self.case, self.rng)
        return self.case.draw(chain, generator(self.rng, self.robot, self.case.name, self.target))

    def work(self) -> list[Trial]:
        """Run the trials; a case that cannot draw its task is an error in each of their rows."""
        try:
            task = self.task()
        except Exception as error:
            return [
                failed(Trial(self.robot, self.case.name, method.name, self.target, seed, self.budget), error)
                for method, seed in self.left
            ]
        trials = []
        for method, seed in self.left:
            given = (self.robot, self.case, task, method, self.target, seed, self.budget, self.rng)
            if (id(task.chain), method.name) not in _warm:  # tables and compiled code are made before anything is timed
                _warm.add((id(task.chain), method.name))
                attempt(*given)
            trials.append(attempt(*given))
        return trials


_warm: set[tuple[int, str]] = set()


@lru_cache(maxsize=32)
def _arm(spec: str, robot: str, case: Case, rng: int) -> Chain:
    """The chain of a case, made once in a process."""
    return case.chain(_robot(spec), generator(rng, robot, case.name))


@lru_cache(maxsize=32)
def _robot(spec: str) -> Robot:
    return load_robot(spec)


def case_of(case: str | Case) -> Case:
    """A case by its name, by ``module:object``, or itself.

    Raises:
        UnknownName: No case of that name, module, or object.
        InvalidSetting: The object is none.
    """
    found = imported("case", case) if isinstance(case, str) and ":" in case else case
    if isinstance(found, str):
        if found not in CASES:
            raise UnknownName("case", found, CASES)
        return CASES[found]
    if not isinstance(found, Case):
        raise InvalidSetting(f"not a case: {found!r}; give a name or a pin_metaik.compare.Case")
    return found


def method_of(method: str | Method) -> Method:
    """A method by its name, by ``module:object``, or itself.

    Raises:
        UnknownName: No method of that name, module, or object.
        InvalidSetting: The object is none.
    """
    found = imported("method", method) if isinstance(method, str) and ":" in method else method
    if isinstance(found, str):
        return named(found)
    if isinstance(found, type) or not isinstance(found, Method):
        raise InvalidSetting(
            f"not a method: {found!r}; give a name or an object with a name and solve(problem, x0, budget, rng)"
        )
    return found


def imported(kind: str, spec: str) -> object:
    """The object that ``module:object`` names.

    Raises:
        UnknownName: No such module, or nothing of that name in it.
    """
    module, _, name = spec.partition(":")
    try:
        found = importlib.import_module(module)
    except ImportError as error:
        raise InvalidSetting(f"cannot import the module of {kind} {spec!r}: {error}") from None
    if not hasattr(found, name):
        raise UnknownName(f"{kind} in {module}", name, [name for name in vars(found) if not name.startswith("_")])
    return getattr(found, name)


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
