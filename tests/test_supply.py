"""What is installed, imported and asked of the network: the floors as they are written, little, and nothing."""

import os
import subprocess
import sys
import tomllib
from importlib.metadata import version
from pathlib import Path

from packaging.requirements import Requirement

ROOT = Path(__file__).parents[1]
LONGEST = 3.5  # times what Pinocchio and numpy take to import, in processor time; 1.9 where nothing else runs

OFFLINE = """
import os, runpy, sys

def refuse(event, arguments):
    here = (None, "localhost", "127.0.0.1", "::1")  # and paths are between processes of this machine, too
    if event in ("socket.connect", "socket.bind", "socket.sendto") and isinstance(arguments[1], tuple):
        asks = arguments[1][0] not in here
    elif event in ("socket.getaddrinfo", "socket.gethostbyname"):
        asks = arguments[0] not in here
    else:
        asks = event in ("urllib.Request", "webbrowser.open")
    if asks:
        sys.stderr.write(f"{event} {arguments}")
        os._exit(3)  # from whichever thread

sys.addaudithook(refuse)
sys.argv = sys.argv[1:]
runpy.run_path(sys.argv[0], run_name="__main__")
"""
TRIES = "import socket; socket.create_connection(('192.0.2.1', 9))"  # an address of documentation, which nobody has


def test_nothing_that_the_package_offers_asks_the_network(tmp_path: Path) -> None:
    (tmp_path / "tries.py").write_text(TRIES)
    for program, expected in ((tmp_path / "tries.py", 3), (ROOT / "tests" / "typed_program.py", 0)):
        done = subprocess.run([sys.executable, "-c", OFFLINE, program], capture_output=True, text=True)
        assert done.returncode == expected, done.stderr


def test_importing_takes_a_few_times_as_long_as_pinocchio(tmp_path: Path) -> None:
    """With bytecode, as where the package is installed: without, half of the time is compiling."""
    written = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    written["PYTHONPYCACHEPREFIX"] = str(tmp_path)
    subprocess.run([sys.executable, "-c", "import pin_metaik"], check=True, env=written)

    def seconds(code: str) -> float:
        before = os.times()
        subprocess.run([sys.executable, "-c", code], check=True, env=written)
        after = os.times()
        return after.children_user + after.children_system - before.children_user - before.children_system

    without = min(seconds("import numpy, pinocchio") for _ in range(2))
    assert min(seconds("import pin_metaik") for _ in range(2)) < LONGEST * without


def test_every_floor_is_met_here_and_printed_for_the_job_that_installs_it() -> None:
    printed = subprocess.run(
        [sys.executable, ROOT / ".github" / "floors.py"], capture_output=True, text=True, check=True
    ).stdout
    floors = dict(line.split("==") for line in printed.split())
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    for dependency in project["dependencies"]:
        name, _, floor = dependency.partition(">=")
        assert floor and floors[name] == floor, "a dependency without a floor"
        assert numbers(version(name)) >= numbers(floor)


def test_the_lock_of_ci_has_a_version_of_every_dependency_that_is_allowed() -> None:
    lines = (ROOT / ".github" / "constraints.txt").read_text().splitlines()
    locked = [Requirement(line) for line in lines if not line.startswith("#")]
    here = {one.name.lower(): one.specifier for one in locked if one.marker is None or one.marker.evaluate()}
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    extras = ("plots", "cma", "mobile", "qp", "timing", "compare", "cluster", "peers", "viewer", "toolbox", "dev")
    asked = [*project["dependencies"], *(one for name in extras for one in project["optional-dependencies"][name])]
    for one in map(Requirement, asked):
        if one.name != project["name"] and (one.marker is None or one.marker.evaluate()):
            (pin,) = here[one.name.lower()]
            assert pin.version in one.specifier, f"run make lock: {one} and {pin}"


def numbers(text: str) -> list[int]:
    return [int(part) for part in text.split(".") if part.isdigit()]
