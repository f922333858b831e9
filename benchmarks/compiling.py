"""What compiling costs: by loop, by phase, by kind of first solve; and the baseline against this processor's own.

    python benchmarks/compiling.py --before OTHER_CHECKOUT --out docs/compiling.md

writes its tables between the two marks in that file. Seconds are of processor time, so that other work on the machine
does not count, or not much; what another checkout takes is measured beside this one's, in the same minutes. Speeds are
ratios of the same blocks of targets, solved by turns in two processes.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
from datetime import date
from pathlib import Path
from typing import Any

PACKAGE = Path(__file__).parents[1] / "pin_metaik"
BEGIN, END = "<!-- measured -->\n", "<!-- end -->\n"
ROUNDS = 21  # blocks of each of the two

LOOPS = """
import json, time
from collections import Counter
from numba.core.codegen import CPUCodeLibrary, JITCodeLibrary
from numba.core.compiler_machinery import PassManager
from pin_metaik.compiled import ahead
spent, inner = Counter(), [0.0]
def count(owner, name, phase):  # its own time, without that of what it calls and is counted
    plain = getattr(owner, name)
    def timed(*arguments, **named):
        began = time.process_time()
        inner.append(0.0)
        try:
            return plain(*arguments, **named)
        finally:
            whole = time.process_time() - began
            spent[phase(arguments)] += whole - inner.pop()
            inner[-1] += whole
    setattr(owner, name, timed)
count(CPUCodeLibrary, "add_ir_module", lambda _: "LLVM's code as text, and read again")
count(CPUCodeLibrary, "_optimize_functions", lambda _: "optimising functions")
count(CPUCodeLibrary, "_optimize_final_module", lambda _: "optimising modules")
count(JITCodeLibrary, "_finalize_specific", lambda _: "machine code")
count(PassManager, "_runPass", lambda arguments: arguments[2].name().replace("_", " "))
for loop in ahead.versions()[0]:
    began = time.process_time()
    loop.compile()
    print(json.dumps([loop.module, loop.name, loop.without, time.process_time() - began]), flush=True)
print(json.dumps(spent))
"""

KINDS = """
import json
import numpy as np, pinocchio as pin
import pin_metaik as mik
from pin_metaik import mobile, stewart
from pin_metaik.compiled.loop import Loop
used, compiled = [], Loop.compiled
def noted(self, without=False):
    used.append([self.module, self.name, without])
    return compiled(self, without)
Loop.compiled = noted
robot = mik.load_robot("panda")
chain = mik.Chain(robot, "panda_hand_tcp")
pose = pin.SE3(np.diag([1.0, -1.0, -1.0]), np.array([0.4, 0.0, 0.4]))
both = mik.Chain(robot, ["panda_hand_tcp", "panda_link4"])
elbow = both.placements(both.q(np.full(len(both.names), 0.1)))
box = mobile.read_polygons([[(1.0, -1.0), (2.0, -1.0), (2.0, 1.0), (1.0, 1.0)]])
kinds = {
    "a pose": lambda: mik.solve_ik(chain, pose),
    "a position": lambda: mik.solve_ik(chain, [0.4, 0.1, 0.5]),
    "a free axis": lambda: mik.solve_ik(chain, mik.Target(pose, orientation_tolerance=(1e-5, 1e-5, np.inf))),
    "two frames": lambda: mik.solve_ik(both, list(elbow)),
    "all": lambda: mik.solve_ik_all(chain, pose),
    "the nearest": lambda: mik.solve_ik(chain, pose, solver=mik.IKSolver(select="nearest")),
    "a path": lambda: mik.solve_ik_path(chain, [pose, pose], max_step=0.1),
    "a batch": lambda: mik.solve_ik_batch(chain, [pose] * 10),
    "a seeder": lambda: mik.solve_ik(chain, pose, solver=mik.IKSolver("gwo", "dls")),
    "a world": lambda: mik.solve_ik(chain, pose, world=mik.CollisionWorld(robot)),
    "a mobile path": lambda: mobile.plan_path(mobile.Scene((0.0, 0.0), (3.0, 0.0), box)),
}
for kind, solve in kinds.items():
    used.clear()
    solve()
    print(json.dumps([kind, used]), flush=True)
"""

SPEED = """
import json, sys, time
import numpy as np
import pin_metaik as mik
arms = {}
for name in ("panda", "ur5", "tiago"):
    robot = mik.load_robot(name)
    chain = mik.Chain(robot, robot.frame)
    low, high = chain.limits.lower, chain.limits.upper
    arms[name] = chain, np.random.default_rng(1), low, high
for line in sys.stdin:
    answer = {}
    for name, (chain, rng, low, high) in arms.items():
        poses = [chain.placements(chain.q(low + (high - low) * rng.random(len(low))))[0] for _ in range(2000)]
        began = time.process_time()
        found = [mik.solve_ik(chain, pose).q for pose in poses]
        answer[name] = time.process_time() - began, np.array(found).tolist()
    print(json.dumps(answer), flush=True)
"""


class Place:
    """A copy of the package, without machine code, and a folder for what is compiled of it."""

    def __init__(self, folder: Path, package: Path = PACKAGE, processor: str = "") -> None:
        shutil.copytree(package, folder / "pin_metaik", ignore=shutil.ignore_patterns("__pycache__", "machine_code"))
        self.folder = folder
        target = {"NUMBA_CPU_NAME": processor, "NUMBA_CPU_FEATURES": ""} if processor else {}
        self.environment = {**os.environ, "PYTHONPATH": str(folder), "NUMBA_CACHE_DIR": str(folder), **target}

    def lines(self, program: str) -> list[Any]:
        """What a program prints, a JSON value a line."""
        return said(self.started(program))

    def _file(self, program: str) -> Path:
        path = self.folder / "program.py"
        path.write_text(program)
        return path

    def started(self, program: str) -> subprocess.Popen[str]:
        """A program that was begun; it may answer lines by lines."""
        return subprocess.Popen(
            [sys.executable, self._file(program)],
            env=self.environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )


def said(process: subprocess.Popen[str]) -> list[Any]:
    """What a program printed when it is done, a JSON value a line."""
    printed, _ = process.communicate()
    if process.returncode:
        raise SystemExit(process.returncode)
    return [json.loads(line) for line in printed.splitlines()]


def asked(process: subprocess.Popen[str]) -> dict[str, Any]:
    assert process.stdin is not None and process.stdout is not None
    print(file=process.stdin, flush=True)
    answer: dict[str, Any] = json.loads(process.stdout.readline())
    return answer


def speeds(own: Place, baseline: Place) -> list[str]:
    """Rows: arm, time with the baseline's code over that with this processor's own, equal answers."""
    first, second = own.started(SPEED), baseline.started(SPEED)
    rounds = [(asked(first), asked(second)) for _ in range(ROUNDS + 1)][1:]  # the first one loads
    for process in (first, second):
        process.communicate()
    rows = []
    for arm in rounds[0][0]:
        ratios = [there[arm][0] / here[arm][0] for here, there in rounds]
        answers = [pair for here, there in rounds for pair in zip(here[arm][1], there[arm][1], strict=True)]
        same = sum(one == other for one, other in answers)
        apart = max(max(abs(a - b) for a, b in zip(*pair, strict=True)) for pair in answers)
        rows.append(f"| {arm} | {statistics.median(ratios):.3f} | {same} of {len(answers)} | {apart:.1e} |")
    return rows


def label(module: str, name: str, without: bool) -> str:
    return f"{module.removeprefix('pin_metaik.')}.{name}{', without' if without else ''}"


def phases(runs: list[list[Any]], loops: list[dict[str, float]]) -> list[str]:
    """Rows of seconds by phase, a column for each run."""
    spent = [phases for *_, phases in runs]
    rows = [(phase, [some.get(phase, 0.0) for some in spent]) for phase in dict.fromkeys(p for s in spent for p in s)]
    rows = [(phase, times) for phase, times in rows if max(times) > 0.01 * sum(loops[-1].values())]
    rows = sorted(rows, key=lambda row: -row[1][-1])
    both = [loop for loop in loops[-1] if all(loop in some for some in loops)]
    rows += [
        (f"**all {len(both)} loops that there are in each**", [sum(some[loop] for loop in both) for some in loops])
    ]
    return [f"| {phase} | {' | '.join(f'{time:.1f}' for time in times)} |" for phase, times in rows]


def processor() -> str:
    found = re.search(r"model name\s*: (.*)", Path("/proc/cpuinfo").read_text())
    return found[1] if found else platform.machine()


def commit(checkout: Path) -> str:
    asked = ["git", "-C", str(checkout), "rev-parse", "--short", "HEAD"]
    return subprocess.run(asked, capture_output=True, text=True, check=True).stdout.strip()


def measured(folder: Path, baseline: str, before: Path | None) -> str:
    own, other = Place(folder / "own"), Place(folder / "baseline", processor=baseline)
    places = [other] if before is None else [Place(folder / "before", before / "pin_metaik", baseline), other]
    running = [place.started(LOOPS) for place in places]  # at once, so that what slows one slows the other
    runs = [said(process) for process in running]
    names = ["s"] if before is None else [f"s in {commit(before)}", "s now"]
    return page(names, runs, other.lines(KINDS), baseline, speeds(own, other))


def page(names: list[str], runs: list[list[Any]], firsts: list[Any], baseline: str, speed: list[str]) -> str:
    """The tables: of the last run, and of its phases beside those of the one before."""
    by_loop = [{label(*loop): time for *loop, time in loops} for *loops, _ in runs]
    seconds = by_loop[-1]
    kinds = {kind: [label(*loop) for loop in used] for kind, used in firsts}
    lines = [
        f"`python benchmarks/compiling.py --before CHECKOUT --out docs/compiling.md`, {date.today()}, {processor()} "
        f"with {os.cpu_count()} cores, Python {platform.python_version()}. Seconds of processor time "
        f"in one process; the code is for {baseline}.",
        "",
        "| the first solve in a process with an empty cache | loops that it needs, and no kind above did | s |",
        "|---|---|---|",
    ]
    seen: set[str] = set()
    for kind, used in kinds.items():
        new = [loop for loop in dict.fromkeys(used) if loop not in seen]
        seen.update(new)
        cost = sum(seconds[loop] for loop in new)
        lines.append(f"| {kind} | {', '.join(f'`{loop}`' for loop in new) or 'none'} | {cost:.1f} |")
    lines += ["", "| loop | s |", "|---|---|"]
    lines += [f"| `{loop}` | {time:.1f} |" for loop, time in sorted(seconds.items(), key=lambda item: -item[1])]
    lines += [f"| **all {len(seconds)}** | **{sum(seconds.values()):.0f}** |", ""]
    lines += [f"| phase, of a hundredth or more | {' | '.join(names)} |", f"|---{'|---' * len(names)}|"]
    lines += [*phases(runs, by_loop), ""]
    lines += [
        f"| `solve_ik`, {2000 * ROUNDS} random poses | time with code for {baseline}, over that with this processor's "
        "own | answers equal to the last bit | largest difference of a joint, rad |",
        "|---|---|---|---|",
        *speed,
    ]
    return "\n".join(lines) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--out", type=Path, required=True, help="a file with the two marks")
    parser.add_argument("--baseline", default="x86-64-v3", help="LLVM's name of a processor")
    parser.add_argument("--before", type=Path, help="a checkout to compare with")
    wanted = parser.parse_args()
    before, _, rest = wanted.out.read_text().partition(BEGIN)
    after = rest.partition(END)[2]
    with tempfile.TemporaryDirectory() as folder:
        wanted.out.write_text(before + BEGIN + measured(Path(folder), wanted.baseline, wanted.before) + END + after)


if __name__ == "__main__":
    main()
