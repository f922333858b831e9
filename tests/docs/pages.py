"""The Markdown that people read: the README, and the pages of the site that are written by hand."""

from __future__ import annotations

from pathlib import Path

ROOT = Path(__file__).parents[2]
MADE = ROOT / "docs" / "gallery", ROOT / "docs" / "api"
"""What building the site makes."""

PAGES = [
    ROOT / "README.md",
    *(page for page in sorted((ROOT / "docs").rglob("*.md")) if not any(page.is_relative_to(made) for made in MADE)),
]
