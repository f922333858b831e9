"""The manifest of a comparison: what was compared, as plain values, enough to report on it and to run it again."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from typing import Any

from pin_metaik.arguments import checked
from pin_metaik.compare.cases.case import Case
from pin_metaik.compare.folder.reading import entries
from pin_metaik.compare.methods.method import Method
from pin_metaik.compare.trials.suite import Suite
from pin_metaik.compare.trials.trial import Trial
from pin_metaik.errors import InvalidSetting

MANIFEST = "suite.json"
LATER = ("files", "absent")
"""Keys that earlier manifests did not have."""


@checked
@dataclass(frozen=True)
class CaseEntry:
    """A case.

    Attributes:
        name: Its name in rows.
        spec: The name or ``module:object`` by which it was asked for.
        about: How its targets are made.
        success: What counts as one.
    """

    name: str
    spec: str
    about: str
    success: str


@checked
@dataclass(frozen=True)
class Manifest:
    """A comparison.

    Attributes:
        robots: The name or path by which each was asked for, by its name in rows.
        cases: The cases by name.
        methods: The name or ``module:object`` by which each was asked for, by name; its name, if it was an object.
        tasks: Tasks of each case for each robot.
        seeds: Repetitions of each method on each task.
        budget: Kernel evaluations for each target.
        rng: Seed of everything random.
        files: Where in the folder of the comparison the robots that do not come by name are kept, by name.
        absent: Why a robot has no task of a case, by ``robot/case``.
    """

    robots: dict[str, str]
    cases: dict[str, CaseEntry]
    methods: dict[str, str]
    tasks: int
    seeds: int
    budget: int
    rng: int
    files: dict[str, str] = field(default_factory=dict)
    absent: dict[str, str] = field(default_factory=dict)

    @staticmethod
    def from_suite(suite: Suite) -> Manifest:
        """The manifest of a comparison that has no folder yet."""
        cases = zip(_specs(suite.cases), suite.cases_by_name.values(), strict=True)
        return Manifest(
            suite.robots_by_name,
            {case.name: CaseEntry(case.name, spec, case.about, case.success) for spec, case in cases},
            dict(zip(suite.methods_by_name, _specs(suite.methods), strict=True)),
            suite.tasks,
            suite.seeds,
            suite.budget,
            suite.rng,
        )

    @staticmethod
    def from_json(values: object, place: object = MANIFEST) -> Manifest:
        """What ``to_json`` made.

        Raises:
            InvalidSetting: It did not make that; the message names the place and the key.
        """
        known = [one.name for one in fields(Manifest)]
        content = entries(values, place, [name for name in known if name not in LATER], LATER)
        inner = [one.name for one in fields(CaseEntry)]
        try:
            _inside(entries(content.get("files", {}), "files", (), content.get("files", {})))
            cases = {
                name: CaseEntry(**entries(case, f"case {name!r}", inner))
                for name, case in entries(content["cases"], "cases", (), content["cases"]).items()
            }
            return Manifest(**{**content, "cases": cases})
        except InvalidSetting as error:
            raise InvalidSetting(f"{place}: {error}") from None

    def to_json(self) -> dict[str, Any]:
        """As plain values."""
        return asdict(self)

    def suite(self, folder: Path) -> Suite:
        """The comparison in a folder, to be run; raises what ``Suite`` does where names mean nothing any more."""
        robots = [str(folder / self.files[name]) if name in self.files else spec for name, spec in self.robots.items()]
        specs = [case.spec for case in self.cases.values()]
        numbers = (self.tasks, self.seeds, self.budget, self.rng)
        return Suite(tuple(robots), tuple(specs), tuple(self.methods.values()), *numbers)

    @property
    def trials(self) -> int:
        """How many rows it has."""
        pairs = len(self.robots) * len(self.cases) - len(self.absent)
        return pairs * len(self.methods) * self.tasks * self.seeds

    def contains(self, trial: Trial) -> bool:
        """Whether a row is one of this comparison's."""
        named = trial.robot in self.robots and trial.case in self.cases and trial.method in self.methods
        return named and trial.task < self.tasks and trial.seed < self.seeds

    def check_grown_from(self, before: Manifest, where: object) -> None:
        """Make sure that all rows of an earlier comparison are rows of this one.

        Raises:
            InvalidSetting: The budget or the seed has changed, or something is left out.
        """
        for name in ("budget", "rng"):
            if getattr(before, name) != getattr(self, name):
                raise InvalidSetting(
                    f"{where} holds a comparison with --{name} {getattr(before, name)}, not {getattr(self, name)}: "
                    "repeat that, or choose another folder"
                )
        for name in ("robots", "cases", "methods"):
            left_out = [word for word in getattr(before, name) if word not in getattr(self, name)]
            if left_out:
                raise InvalidSetting(f"{where} has rows of {name} {', '.join(left_out)}: name them, too, to go on")
        for name in ("tasks", "seeds"):
            if getattr(self, name) < getattr(before, name):
                raise InvalidSetting(
                    f"{where} holds a comparison with {getattr(before, name)} {name}: ask for as many, or more"
                )


def _inside(files: dict[str, Any]) -> None:
    """Make sure that paths lead nowhere but into the folder."""
    for name, path in files.items():
        if not isinstance(path, str) or Path(path).is_absolute() or ".." in Path(path).parts:
            raise InvalidSetting(f"files: {name!r} is kept in the folder, not at {path!r}")


def _specs(asked: Iterable[str | Case | Method]) -> list[str]:
    return [one if isinstance(one, str) else one.name for one in asked]
