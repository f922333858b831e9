"""Experiments side by side: methods on hard cases at equal budgets, and papers next to their printed tables."""

from pin_metaik.compare.case import Attempt, Case, Task
from pin_metaik.compare.cases import CASES
from pin_metaik.compare.method import Answer, Method
from pin_metaik.compare.methods import METHODS, Search
from pin_metaik.compare.planners.run import PlannerComparison, PlannerRun, compare_planners
from pin_metaik.compare.replay import Replay, replay
from pin_metaik.compare.report.comparison import write_report
from pin_metaik.compare.results import Results, Summary, summarise
from pin_metaik.compare.run import Outcome, compare
from pin_metaik.compare.store import read_results
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
    "PlannerComparison",
    "PlannerRun",
    "Replay",
    "Results",
    "Search",
    "Suite",
    "Summary",
    "Task",
    "Trial",
    "compare",
    "compare_planners",
    "read_results",
    "replay",
    "summarise",
    "write_report",
]
