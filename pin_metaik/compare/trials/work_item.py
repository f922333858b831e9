"""Work items, which processes are given: one task of a comparison, and the methods that are run on it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

from pin_metaik.collision import CollisionWorld
from pin_metaik.compare.cases.case import Case, Task
from pin_metaik.compare.methods.method import Method
from pin_metaik.compare.trials.trial import Trial, attempt, failed, generator
from pin_metaik.interrupts import Pressed
from pin_metaik.kinematics import Chain
from pin_metaik.robots import Robot, load_robot


@dataclass(frozen=True)
class WorkItem:
    """One task, and the methods that are run on it.

    Attributes:
        robot: Name of the robot.
        spec: Its name or path, as ``load_robot`` takes it.
        case: The case.
        number: Number of the task.
        runs: Methods and numbers of the repetitions.
        budget: Kernel evaluations for each target.
        rng: Seed of everything random.
    """

    robot: str
    spec: str
    case: Case
    number: int
    runs: tuple[tuple[Method, int], ...]
    budget: int
    rng: int

    def draw(self) -> Task:
        """Draw the task, the same for every method."""
        chain = _arm(self.spec, self.robot, self.case, self.rng)
        world = _world(self.spec, self.case)
        return self.case.task(chain, world, generator(self.rng, self.robot, self.case.name, self.number))

    def run(self) -> list[Trial]:
        """Run the trials; a case that cannot draw its task is an error in each of their rows.

        Raises:
            KeyboardInterrupt: Ctrl-C, also where a method has swallowed it: its answer is then no row.
        """
        with Pressed() as pressed:
            return self._rows(pressed)

    def _rows(self, pressed: Pressed) -> list[Trial]:
        try:
            task = self.draw()
        except Exception as error:
            pressed.check()
            return [
                failed(Trial(self.robot, self.case.name, method.name, self.number, seed, self.budget), error)
                for method, seed in self.runs
            ]
        trials = []
        for method, seed in self.runs:
            given = (self.robot, self.case, task, method, self.number, seed, self.budget, self.rng)
            if (id(task.chain), method.name) not in _warm:  # tables and compiled code are made before anything is timed
                _warm.add((id(task.chain), method.name))
                attempt(*given)
                pressed.check()
            trials.append(attempt(*given))
            pressed.check()
        return trials


_warm: set[tuple[int, str]] = set()


@lru_cache(maxsize=32)
def _arm(spec: str, robot: str, case: Case, rng: int) -> Chain:
    """The chain of a case, made once in a process."""
    return case.chain(_robot(spec), generator(rng, robot, case.name))


@lru_cache(maxsize=32)
def _world(spec: str, case: Case) -> CollisionWorld | None:
    """The world of a case, made once in a process."""
    return None if case.world is None else case.world(_robot(spec))


@lru_cache(maxsize=32)
def _robot(spec: str) -> Robot:
    return load_robot(spec)
