"""A progress bar on the terminal."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.table import Column

from pin_metaik import watching
from pin_metaik.watching import Watch

TIME = 7  # characters that a time takes


@contextmanager
def progress_bar(label: str, console: Console | None = None) -> Iterator[Watch]:
    """A bar that goes away when the work is done; nothing where there is no terminal.

    ``with progress_bar("designing") as watch: design(mechanism, watch=watch)``

    Args:
        label: Name of the work, shown until its first progress.
        console: Where to draw; default: stderr.
    """
    console = console or Console(stderr=True)
    one_line = Column(no_wrap=True, overflow="ellipsis", ratio=1)
    elapsed, left = (Column(no_wrap=True, min_width=TIME) for _ in range(2))
    columns = (
        TextColumn("{task.description}", table_column=one_line, markup=False),
        BarColumn(bar_width=20),
        MofNCompleteColumn(),
        TimeElapsedColumn(table_column=elapsed),
        TextColumn("left"),
        TimeRemainingColumn(table_column=left),
    )
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal, expand=True) as bar:
        task = bar.add_task(label, total=None)

        def watch(at: watching.Progress) -> None:
            bar.update(task, completed=at.done, total=at.total or None, description=at.label or label)

        yield watch
