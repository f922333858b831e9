"""Experiments side by side: methods on hard cases at equal budgets, and papers next to their printed tables."""

from pin_metaik.compare.case import Attempt, Case, Task
from pin_metaik.compare.cases import CASES
from pin_metaik.compare.method import Answer, Method
from pin_metaik.compare.methods import METHODS, Search
from pin_metaik.compare.replay import Replay, replay
from pin_metaik.compare.run import Outcome, compare
from pin_metaik.compare.suite import Suite
from pin_metaik.compare.trial import Trial

__all__ = [
    "CASES",
    "METHODS",
    "Answer",
    "Attempt",
    "Case",
    "Method",
    "Outcome",
    "Replay",
    "Search",
    "Suite",
    "Task",
    "Trial",
    "compare",
    "replay",
]
