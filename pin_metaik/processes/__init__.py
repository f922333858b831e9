"""Long work in processes that can be paused, stepped and ended."""

from pin_metaik.processes.crew import Crew, Run, Stage
from pin_metaik.processes.wire import Order, Told, Work

__all__ = ["Crew", "Order", "Run", "Stage", "Told", "Work"]
