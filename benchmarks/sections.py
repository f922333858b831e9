"""A page of sections, each measured by itself and under its own conditions."""

from __future__ import annotations

import os
import platform
import re
import sys
from collections.abc import Iterable
from datetime import date
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path


def page_with(page: str, heading: str, titles: Iterable[str], title: str, lines: list[str]) -> str:
    """The page with one section new, all in the order of the titles."""
    _, *old = page.split("\n## ")
    known = {name: text.strip() for name, _, text in (section.partition("\n") for section in old)}
    known[title] = "\n".join(lines).strip()
    written = [f"## {name}\n\n{known[name]}" for name in titles if name in known]
    return "\n\n".join([heading, *written]) + "\n"


def conditions(peers: Iterable[str] = ()) -> str:
    """The command, the date, the machine, and the versions of packages, of peers where they are installed."""
    packages = [f"{name} {version(name)}" for name in ("pin", "coal", "numpy", "numba")]
    for name in peers:
        try:
            packages.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            packages.append(f"no {name}")
    load = ", ".join(f"{value:.1f}" for value in os.getloadavg())
    files = re.compile(r" --(out|kept|kept-parts|kept-scan)[ =]\S+")  # they do not change what is measured
    command = files.sub("", " ".join(["python", f"benchmarks/{Path(sys.argv[0]).name}", *sys.argv[1:]]))
    return (
        f"`{command}`, {date.today()}, {os.cpu_count()}-core {platform.machine()}, load {load}, "
        f"Python {platform.python_version()}, {', '.join(packages)}."
    )
