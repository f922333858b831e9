"""The package as it is installed: quick to import, complete in its wheel, quick to answer."""

import os
import re
import shutil
import subprocess
import sys
import tomllib
import venv
from pathlib import Path

import pytest

import pin_metaik as mik

ROOT = Path(__file__).parent.parent

IMPATIENT = """
from pin_metaik.compiled import loop
loop.WAIT = 0.5  # s
"""
SOLVE = """
import pin_metaik as mik
robot = mik.load_robot("rv7fl_paper")
result = mik.solve_ik(mik.Chain(robot.model, robot.frame), [0.63925, -0.64594, 0.40079])
assert result.success and mik.load_robot("panda").model.nq == 8
print(mik.__file__)
"""


def bare() -> dict[str, str]:
    """The environment without paths to this checkout."""
    return {key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "MYPYPATH")}


def run(python: str | Path, program: str, cwd: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    given = {**bare(), **environment}
    return subprocess.run([python, "-c", program], capture_output=True, text=True, env=given, cwd=cwd, check=True)


def test_importing_loads_nothing_heavy() -> None:
    heavy = "numba", "scipy", "matplotlib", "rich", "typer", "shapely", "qpsolvers"
    listed = subprocess.run(
        [sys.executable, "-c", "import sys, pin_metaik; print(*sys.modules)"],
        capture_output=True,
        text=True,
        check=True,
    ).stdout.split()
    assert not set(heavy) & set(listed)


def test_the_first_solve_on_a_machine_compiles_and_says_so(tmp_path: Path) -> None:
    shutil.copytree(ROOT / "pin_metaik", tmp_path / "pin_metaik", ignore=shutil.ignore_patterns("__pycache__"))
    first = run(sys.executable, IMPATIENT + SOLVE, tmp_path)
    assert str(tmp_path) in first.stdout  # the copy, beside which no machine code lies
    assert first.stderr.count("compiling inner loops") == 1  # of several
    later = run(sys.executable, SOLVE, tmp_path)
    assert (later.stdout, later.stderr) == (first.stdout, "")


@pytest.mark.slow
def test_the_wheel_solves_in_an_empty_environment(tmp_path: Path) -> None:
    subprocess.run(
        [sys.executable, "-m", "build", "--wheel", "--outdir", tmp_path / "dist", ROOT],
        check=True,
        capture_output=True,
    )
    (wheel,) = (tmp_path / "dist").glob("*.whl")
    venv.create(tmp_path / "empty")
    python = tmp_path / "empty" / "bin" / "python"
    pip = [sys.executable, "-m", "pip", "--python", python]
    subprocess.run([*pip, "install", "--quiet", "--no-compile", wheel], check=True, capture_output=True)
    run(sys.executable, SOLVE, ROOT)  # so that there is machine code in this checkout
    (site,) = (tmp_path / "empty").rglob("site-packages/pin_metaik")
    for code in (ROOT / "pin_metaik").rglob("*.nb[ci]"):  # is used where numba is the same, and saves the test time
        beside = site / code.relative_to(ROOT / "pin_metaik")
        beside.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(code, beside)
    done = run(python, SOLVE, tmp_path)
    assert "site-packages" in done.stdout
    program = shutil.copy(ROOT / "tests" / "typed_program.py", tmp_path)  # where nothing else can be imported
    strict = ["-m", "mypy", "--strict", "--cache-dir", str(tmp_path / "mypy"), "--python-executable", str(python)]
    typed = subprocess.run([sys.executable, *strict, program], capture_output=True, text=True, cwd=tmp_path, env=bare())
    assert typed.returncode == 0, typed.stdout


def test_the_typed_program_uses_every_public_name_and_runs() -> None:
    text = (ROOT / "tests" / "typed_program.py").read_text()
    assert [name for name in mik.__all__ if not re.search(rf"\bmik\.{name}\b", text)] == []
    done = subprocess.run([sys.executable, ROOT / "tests" / "typed_program.py"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_the_extra_all_holds_every_other_that_installs_everywhere() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    extras = project["optional-dependencies"]
    (everything,) = extras["all"]
    named = set(everything.removeprefix("pin-metaik[").removesuffix("]").split(","))
    assert named == set(extras) - {"all", "dev", "docs", "tracik", "roboticstoolbox", "branches", "ompl"}


def test_the_citation_and_the_recipe_are_of_this_version() -> None:
    for file in ("CITATION.cff", ".github/conda/recipe.yaml"):
        assert re.search(rf'^\s*version: "?{re.escape(mik.__version__)}"?$', (ROOT / file).read_text(), re.MULTILINE), (
            file
        )
