"""An ``index.html`` where a browser looks for one: pages keep the places that they have in the checkout."""

from __future__ import annotations

from pathlib import Path
from typing import Any

PAGE = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>{title}</title>
<meta http-equiv="refresh" content="0; url={first}.html"></head>
<body><p><a href="{first}.html">{title}</a></p></body></html>
"""


def _write(app: Any, failed: Exception | None) -> None:
    if failed is None and app.builder.name == "html":
        page = PAGE.format(title=app.config.html_title, first=app.config.root_doc)
        Path(app.outdir, "index.html").write_text(page, encoding="utf-8")


def setup(app: Any) -> dict[str, bool]:
    """Write the page when the site is whole."""
    app.connect("build-finished", _write)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
