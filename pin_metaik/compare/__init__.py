"""Comparisons of methods on hard cases at equal budgets, and reproductions of papers beside their printed tables."""

from pin_metaik.compare.cases import CASES
from pin_metaik.compare.cases.case import Attempt, Case, Task
from pin_metaik.compare.methods import METHODS, Search
from pin_metaik.compare.methods.method import Answer, Method
from pin_metaik.compare.planners.run import PlannerComparison, PlannerRun, compare_planners
from pin_metaik.compare.report.comparison import write_report
from pin_metaik.compare.results.results import Results, Summary, read_results, summarise
from pin_metaik.compare.running.replay import Replay, replay
from pin_metaik.compare.running.run import Outcome, compare
from pin_metaik.compare.trials.suite import Suite
from pin_metaik.compare.trials.trial import Trial

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
