"""The gallery: the examples run in a folder of their own, and every picture that one writes is shown.

Each example takes the name of a picture as an argument; that is how a reader draws it, too.
"""

from __future__ import annotations

import re
import shutil
from pathlib import Path
from textwrap import indent
from typing import Any

from sphinx_gallery.scrapers import figure_rst

ROOT = Path(__file__).parents[2]
STAGE = ROOT / "build" / "examples"
SMALLER = {"12_screen_grasps": ["120"]}
"""Arguments before the picture with which an example is quick."""
STILLS = {"11_look_at_the_world": ROOT / "docs" / "images" / "shelf.png"}
"""What examples show in a browser, as ``docs/pictures.py`` has taken it."""


def stage() -> str:
    """Copy the examples to where they may write files; that folder, as Sphinx-Gallery wants it."""
    STAGE.mkdir(parents=True, exist_ok=True)
    for file in (ROOT / "examples").iterdir():
        if file.suffix == ".py":
            (STAGE / file.name).write_text(titled(file.read_text(encoding="utf-8")), encoding="utf-8")
        elif file.suffix == ".rst":
            shutil.copy2(file, STAGE)
    return str(STAGE)


def titled(example: str) -> str:
    """An example whose docstring has a title, as Sphinx-Gallery wants it: its words up to the first colon or stop."""
    _, words, code = example.split('"""', 2)
    title, stop, rest = re.split(r"([:.]|(?<=[?]))(?=\s|$)", words, maxsplit=1)
    rest = rest.strip() if stop == "." else rest.strip()[:1].upper() + rest.strip()[1:]
    rest = re.sub(r"^(python .*(?:\npython .*)*)$", lambda call: "::\n\n" + indent(call[1], "    "), rest, flags=re.M)
    return f'"""\n{title}\n{"=" * len(title)}\n\n{rest}\n"""{code}'


def arguments(_conf: Any, script: dict[str, Any]) -> list[str]:
    """What an example is called with: the name of its picture."""
    name = Path(script["src_file"]).stem
    if name in STILLS:
        shutil.copy(STILLS[name], STAGE / f"{name}.png")
        return []
    (STAGE / f"{name}.png").unlink(missing_ok=True)
    return [*SMALLER.get(name, []), f"{name}.png"]


def pictures(_block: Any, variables: dict[str, Any], conf: dict[str, Any]) -> str:
    """The pictures that an example has written so far, for its page."""
    written = STAGE / f"{Path(variables['src_file']).stem}.png"
    if not written.exists():
        return ""
    shown = next(variables["image_path_iterator"])
    shutil.move(written, shown)
    return str(figure_rst([shown], conf["src_dir"]))


LINK = re.compile(r"\]\((?:\.\./)+examples/(\d\d_\w+)\.py\)")


def _to_the_gallery(_app: Any, _page: str, source: list[str]) -> None:
    """Let links to examples lead to their pages in the gallery: in the repository they lead to the files."""
    source[0] = LINK.sub(r"](/docs/gallery/\1.rst)", source[0])


def setup(app: Any) -> dict[str, bool]:
    """Change links as pages are read."""
    app.connect("source-read", _to_the_gallery)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
