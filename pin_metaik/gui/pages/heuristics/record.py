"""A run as it is seen, saved and replayed: its curve, and its population from generation to generation."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pin_metaik.errors import InvalidSetting
from pin_metaik.files import json_values, known_keys
from pin_metaik.gui.pages.heuristics.tasks import Outcome
from pin_metaik.processes import Told

MOST_KEPT = 2_000  # generations whose population is kept; of longer runs, those are that came first
KEYS = ("label", "task", "trace", "populations", "outcome")


@dataclass(eq=False)
class Record:
    """A run.

    Attributes:
        label: What searched, and its number.
        task: Which problem, in plain values: two runs of one problem can be drawn over each other.
        evaluations: After each generation.
        best: Best cost after each generation.
        populations: Points (k, n) of each generation.
        seconds: Time taken so far, s.
        outcome: What it ended with.
    """

    label: str
    task: Mapping[str, Any]
    evaluations: list[float] = field(default_factory=list)
    best: list[float] = field(default_factory=list)
    populations: list[NDArray[np.float64]] = field(default_factory=list)
    seconds: float = 0.0
    outcome: Outcome | None = None

    def add(self, told: Told) -> None:
        """Keep what was told of one generation."""
        progress = told.progress
        self.evaluations.append(progress.done)
        self.best.append(float(progress.best if progress.best is not None else np.inf))
        self.seconds = told.seconds
        if progress.population is not None and len(self.populations) < MOST_KEPT:
            self.populations.append(progress.population.X)

    @property
    def curve(self) -> tuple[list[float], list[float]]:
        """Evaluations, and the best cost after them."""
        return self.evaluations, self.best

    def to_text(self) -> str:
        """The run as JSON."""
        ended = None
        if self.outcome is not None:
            ended = {**vars(self.outcome), "x": self.outcome.x.tolist()}
        trace = np.column_stack([self.evaluations, self.best]).tolist()
        populations = [X.tolist() for X in self.populations]
        values = (self.label, self.task, trace, populations, ended)
        return json.dumps(dict(zip(KEYS, values, strict=True)))

    @staticmethod
    def from_text(text: str | bytes, place: str) -> Record:
        """A run out of JSON.

        Raises:
            InvalidSetting: It is none.
        """
        content = json_values(text, place, InvalidSetting)
        try:
            if not isinstance(content, dict):
                raise TypeError("it is no table")
            known_keys(content, place, InvalidSetting, KEYS)
            trace = np.asarray(content["trace"], dtype=float).reshape(-1, 2)
            populations = [np.asarray(X, dtype=float) for X in content["populations"]]
            if any(X.ndim != 2 or not np.isfinite(X).all() for X in populations):
                raise ValueError("a population is not made of points")
            ended = content["outcome"]
            outcome = None if ended is None else Outcome(**{**ended, "x": np.asarray(ended["x"], dtype=float)})
            evaluations, best = trace.T.tolist()
            record = Record(str(content["label"]), dict(content["task"]), evaluations, best, populations)
        except (ValueError, TypeError, KeyError) as reason:
            raise InvalidSetting(f"{place} is no run of the toolbox: {reason}") from None
        record.outcome = outcome
        return record
