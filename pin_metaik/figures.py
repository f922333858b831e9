"""Figures of matplotlib: whether it is installed, empty figures, and writing them to files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from pin_metaik.arguments import checked, instance
from pin_metaik.errors import InvalidSetting
from pin_metaik.lookup import need
from pin_metaik.output import writable

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FORMATS = (".png", ".svg", ".pdf")


def need_plots() -> None:
    """Make sure that pictures can be drawn, before anything is worked out for one.

    Raises:
        MissingExtra: matplotlib is not installed.
    """
    need("a picture", "plots", "matplotlib")


@checked
def picture_file(path: str | Path, *others: str) -> Path:
    """The path of a picture that can be written, before anything is worked out for it.

    Args:
        path: Where to.
        others: Endings that are welcome, too.

    Raises:
        MissingExtra: matplotlib is not installed.
        InvalidSetting: Its ending is not one of a picture.
        CannotWrite: It cannot be written.
    """
    need_plots()
    endings = (*FORMATS, *others)
    if Path(path).suffix.lower() not in endings:
        raise InvalidSetting(f"a picture ends in {', '.join(endings)}, got {str(path)!r}")
    return writable(path)


@checked
def save_picture(figure: Figure, path: str | Path) -> Path:
    """Write a figure to a file; the ending says the format (.png, .svg, .pdf).

    Raises:
        InvalidSetting: Its ending is not one of a picture.
        CannotWrite: It cannot be written.
    """
    need_figure(figure)
    path = picture_file(path)
    figure.savefig(path, dpi=130)
    return path


def need_figure(figure: object) -> None:
    """Raise InvalidSetting for what is no figure of matplotlib's; without matplotlib there is none."""
    need_plots()
    from matplotlib.figure import Figure

    instance(Figure, figure=figure)


def new_figure(size: tuple[float, float]) -> Figure:
    """An empty figure of a size in inches."""
    need_plots()
    from matplotlib.figure import Figure

    return Figure(figsize=size, layout="constrained")
