"""A progress bar for surveys and designs: what their ``watch`` can be."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from pin_metaik.arguments import checked
from pin_metaik.stewart.workspace.surveying import Watch


@checked
@contextmanager
def progress_bar(label: str, console: Console | None = None) -> Iterator[Watch]:
    """A bar on stderr that goes away when it is done; nothing where that is no terminal.

    ``with progress_bar("designing") as watch: design(mechanism, watch=watch)``

    Args:
        label: What is being done.
        console: Where to draw; default: stderr.
    """
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    console = console or Console(stderr=True)
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task(label, total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)
