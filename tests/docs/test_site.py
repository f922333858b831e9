"""The site's pages and the README: every page is found, every link leads somewhere, nothing shown is stale."""

from __future__ import annotations

import json
import re
import tomllib
from itertools import pairwise
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

import numpy as np
import pinocchio as pin
import pytest
import typer
from PIL import Image

import pin_metaik as mik
from benchmarks import readme
from docs.pictures import along_the_shelf
from docs.site.layers import drawings
from pin_metaik.cli import app
from pin_metaik.cli.examples import EXAMPLES
from pin_metaik.collision import load_scene
from tests.docs.pages import MADE, PAGES, ROOT
from tests.docs.test_code_blocks import read_by_the_command_line

README = ROOT / "README.md"
SITE = [*(page for page in PAGES if page != README), *sorted((ROOT / "benchmarks").rglob("*.md"))]
OTHERS = [ROOT / "CHANGELOG.md", ROOT / ".github" / "CONTRIBUTING.md"]
FENCED = re.compile(r"^```.*?^```|`[^`\n]*`", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\(([^()\s]+)\)")
TREE = re.compile(r"^```\{toctree\}\n(.*?)^```", re.MULTILINE | re.DOTALL)
PICTURE = re.compile(r"sphx_glr_(\d\d_\w+)_001\.png")


def made(target: Path) -> bool:
    """Whether building the site makes a file: a page of the gallery or the reference, or an example's picture."""
    picture = PICTURE.fullmatch(target.name)
    if picture is not None or target.parent == MADE[0]:
        name = picture[1] if picture is not None else target.stem
        return name == "index" or (ROOT / "examples" / f"{name}.py").is_file()
    return target.is_relative_to(MADE[1])


def anchors(page: Path) -> set[str]:
    """Names of the headings of a page, as GitHub and MyST make them."""
    headings = re.findall(r"^#+ (.*)$", FENCED.sub("", page.read_text(encoding="utf-8")), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", [README, *SITE, *OTHERS], ids=lambda page: str(page.relative_to(ROOT)))
def test_every_link_of_a_page_leads_somewhere(page: Path) -> None:
    for link in LINK.findall(FENCED.sub("", page.read_text(encoding="utf-8"))):
        parts = urlsplit(link)
        if parts.scheme:
            continue
        target = (page.parent / unquote(parts.path)).resolve() if parts.path else page
        assert target.exists() or made(target), link
        if parts.fragment and target.suffix == ".md":
            assert parts.fragment in anchors(target), link


def test_every_page_is_in_a_table_of_contents_and_every_entry_is_a_page() -> None:
    listed: set[Path] = set()
    for page in SITE:
        for tree in TREE.findall(page.read_text(encoding="utf-8")):
            entries = [line for line in tree.splitlines() if line and not line.startswith(":")]
            listed |= {(page.parent / entry).resolve() for entry in entries}
    pages = {page.with_suffix("").resolve() for page in [*SITE, *OTHERS]} - {ROOT / "docs" / "index"}
    assert {entry for entry in listed - pages if not made(entry.with_suffix(".rst"))} == set()
    assert pages - listed == set()


def test_the_readme_is_of_one_screen_and_its_table_is_what_the_benchmark_measured() -> None:
    text = README.read_text(encoding="utf-8")
    assert len(text.splitlines()) < 120
    assert readme.written(text, readme.PAGE.read_text(encoding="utf-8")) == text


def test_the_picture_of_the_readme_shows_what_is_solved_now() -> None:
    robot = mik.load_robot("panda")
    chain, world = mik.Chain(robot, robot.frame), mik.CollisionWorld(robot, load_scene("shelf"))
    target = pin.SE3(pin.utils.rotate("y", np.pi / 2), np.array([0.68, -0.25, 0.6]))
    solved = [mik.solve_ik(chain, target).q, mik.solve_ik(chain, target, world=world).q]
    names = [contact[:2] for contact in world.pairs_in_collision(solved[0])]
    assert names == [("panda_link5", "high_board")]  # "its forearm collides"
    assert not world.in_collision(solved[1])
    with Image.open(ROOT / "docs" / "images" / "shelf.png") as picture:  # docs/pictures.py draws it
        shown = json.loads(picture.info["configurations"])
    np.testing.assert_allclose(shown, solved, atol=1e-4)  # rad, what no eye sees


def test_the_animation_of_the_readme_shows_the_paths_that_are_found_now() -> None:
    robot = mik.load_robot("panda")
    chain, world = mik.Chain(robot, robot.frame), mik.CollisionWorld(robot, load_scene("shelf"))
    alone = mik.solve_ik_path(chain, along_the_shelf())
    clear = mik.solve_ik_path(chain, along_the_shelf(), world=world)
    assert alone.success.all() and any(world.in_collision(q) for q in alone.q)
    assert clear.continuous and all(world.clear_between(*step) for step in pairwise(clear.q))
    with Image.open(ROOT / "docs" / "images" / "shelf_path.gif") as animation:  # docs/pictures.py draws it
        shown = json.loads(animation.info["comment"])
    np.testing.assert_allclose(shown, [alone.q[::2], clear.q[::2]], atol=1e-4)  # rad, what no eye sees


def test_the_coverage_page_has_every_robot_that_loads_by_name() -> None:
    page = (ROOT / "benchmarks" / "robot_coverage.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (\S+) \| (?:catalogue|example-robot-data) ", page, re.MULTILINE)
    assert rows == [robot.name for robot in mik.robot_names()]


def test_the_drawing_of_the_layers_has_every_room_of_the_contracts() -> None:
    whole, *others = drawings(ROOT / "pyproject.toml")
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    assert len(others) + 1 == sum(each["type"] == "layers" for each in project["tool"]["importlinter"]["contracts"])
    inside = (ROOT / "pin_metaik").iterdir()
    rooms = {path.stem for path in inside if path.suffix == ".py" or (path / "__init__.py").exists()}
    assert {room for row in whole.rows for room in row} == rooms - {"__init__", "__main__"}
    for room in ("ik", "kinematics", "compiled"):
        assert f">{room}</text>" in whole.svg()


def commands_of(group: Any, words: tuple[str, ...] = ()) -> dict[str, Any]:
    """Every command of a group and of the groups in it, by its words."""
    found: dict[str, Any] = {}
    for name, command in group.commands.items():
        if hasattr(command, "commands"):
            found |= commands_of(command, (*words, name))
        else:
            found[" ".join((*words, name))] = command
    return found


def test_the_help_of_every_command_ends_with_examples_that_the_command_line_takes() -> None:
    commands = commands_of(typer.main.get_command(app))
    assert set(commands) == set(EXAMPLES)
    for name, command in commands.items():
        assert all(line in command.epilog for line in EXAMPLES[name])
        for line in EXAMPLES[name]:
            assert line.startswith(f"pin-metaik {name}")
            if not line.endswith("--help"):
                read_by_the_command_line(line.removeprefix("pin-metaik "))
