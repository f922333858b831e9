"""Shell completion of names: robots, scenes, papers, cases and methods."""

from __future__ import annotations


def robots(incomplete: str) -> list[str]:
    """Robots that load by name and begin so."""
    from pin_metaik.robots.library import catalogue, example_robots

    return [name for name in (*catalogue(), *example_robots()) if name.startswith(incomplete)]


def papers(incomplete: str) -> list[str]:
    """Papers whose names begin so."""
    from pin_metaik.compare.papers import PAPERS

    return [name for name in PAPERS if name.startswith(incomplete)]
