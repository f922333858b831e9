"""Papers with experiments that can be run again: one line each."""

from __future__ import annotations

from pin_metaik.compare.papers.aerial_arm import AERIAL_ARM
from pin_metaik.compare.papers.paper import AnyPaper, Job, Options, Paper
from pin_metaik.compare.papers.path_planning import PATH_PLANNING
from pin_metaik.compare.papers.puma_offset import PUMA_OFFSET
from pin_metaik.compare.papers.run import Reproduction, reproduce
from pin_metaik.compare.papers.rv7fl import RV7FL
from pin_metaik.compare.papers.stewart import STEWART
from pin_metaik.compare.papers.trajectory import TRAJECTORY

PAPERS: dict[str, AnyPaper] = {
    "rv7fl": RV7FL,
    "aerial_arm": AERIAL_ARM,
    "puma_offset": PUMA_OFFSET,
    "stewart": STEWART,
    "path_planning": PATH_PLANNING,
    "trajectory": TRAJECTORY,
}

__all__ = ["PAPERS", "AnyPaper", "Job", "Options", "Paper", "Reproduction", "reproduce"]
