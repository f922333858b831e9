"""Figures drawn and laid out once, for every file that they go into: that takes longer than to save them."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import IO, Any

from pin_metaik.compare.report.parts import Figure

KEPT = 16  # figures of a report


def save(figure: Figure, file: Path | IO[str], **options: Any) -> None:
    """Save a figure; ``options`` are those of matplotlib's ``savefig``."""
    canvas = _drawn(figure)
    canvas.savefig(file, **options)
    canvas.set_layout_engine("none")  # saved once, it is laid out


@lru_cache(maxsize=KEPT)
def _drawn(figure: Figure) -> Any:
    from matplotlib.figure import Figure as Canvas

    canvas = Canvas(figsize=figure.size, layout="constrained")
    figure.draw(canvas)
    return canvas
