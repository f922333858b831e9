"""Inverse kinematics side by side: pin_metaik and other people's solvers on the same targets, in the same minutes.

    pip install pytracik | roboticstoolbox-python | placo | ik-geo numpy | eaik | pin-pink daqp | ikpy
    python benchmarks/ik_speed.py --peer placo=PYTHON --peer pytracik=PYTHON --out benchmarks/ik_speed.md

``--peer NAME=PYTHON`` names the interpreter of an environment that has the peer; those named by ``--solvers`` without
one are looked for in this environment. Every solver runs in a process of its own; block after block of targets goes to
ours, to the peers in turn, and to ours again, so that on a shared machine the ratios within a block hold. Every answer
is judged here, by Pinocchio. Ctrl-C writes what is finished.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from pathlib import Path
from threading import Timer
from typing import Any

import numpy as np
import pinocchio as pin
from ik_peers import LIMIT, SOLVERS, TOLERANCE
from ik_report import BatchRate, Report, Row
from ik_serial import SerialArm
from ik_targets import FAMILIES, Targets, targets
from numpy.typing import NDArray
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

import pin_metaik as mik

ROBOTS = ("baxter", "kinova", "panda", "pr2", "talos", "tiago", "ur10", "ur5", "xarm7", "z1")
OURS = "pin_metaik"
SLACK = 1e-6  # rad or m past a limit that nobody is blamed for: TRAC-IK keeps limits in single precision
LOADING = 300.0  # s, compiling included
GRACE = 60.0  # s for a block, beyond ten times what the limit of time allows
WARM_UP = 5  # targets solved before anything is measured: tables and compiled code are made
WARM_UP_SEED = 2**31
ROUNDS = 15  # of the batch with each number of workers


class SolverFailed(Exception):
    """A solver cannot go on with this robot; says why."""


class Worker:
    """A solver in a process of its own."""

    def __init__(self, name: str, python: str) -> None:
        self.name, self.python = name, python
        self.errors = tempfile.TemporaryFile("w+")  # noqa: SIM115 - closed by close
        self.process = self._started()

    def _started(self) -> subprocess.Popen[str]:
        threads = {f"{library}_NUM_THREADS": "1" for library in ("OMP", "OPENBLAS", "MKL")}
        return subprocess.Popen(
            [self.python, str(Path(__file__).with_name("ik_worker.py")), self.name],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self.errors,
            text=True,
            env={**os.environ, **threads},
            start_new_session=True,  # Ctrl-C is for this process
        )

    def ask(self, seconds: float, **request: Any) -> dict[str, Any]:
        """Its answer to a request.

        Raises:
            SolverFailed: If it cannot, does not within the time, or dies.
        """
        process = self.process
        timer = Timer(seconds, process.kill)
        timer.start()
        try:
            assert process.stdin is not None and process.stdout is not None
            process.stdin.write(json.dumps(request) + "\n")
            process.stdin.flush()
            line = process.stdout.readline()
        except BrokenPipeError:
            line = ""
        finally:
            timer.cancel()
        if not line:
            code = process.wait()
            self.errors.seek(0)
            last = self.errors.read().strip().splitlines()[-1:] or [f"exit code {code}"]
            self.process = self._started()
            raise SolverFailed(f"its process died or took more than {seconds:.0f} s: {last[0][:200]}")
        answer: dict[str, Any] = json.loads(line)
        if "failed" in answer or "unsuitable" in answer:
            raise SolverFailed(answer.get("failed") or answer["unsuitable"])
        return answer

    def close(self) -> None:
        self.process.kill()
        self.process.wait()
        self.errors.close()


def started(options: argparse.Namespace, stack: ExitStack, report: Report) -> dict[str, Worker]:
    """A worker for ours and for each peer that can be had; the report keeps the versions, and the reasons."""
    pythons = dict(peer.split("=", 1) for peer in options.peer)
    workers = {}
    for name in dict.fromkeys((OURS, *options.solvers, *pythons)):
        python = str(Path(pythons[name]).expanduser()) if name in pythons else sys.executable
        try:
            worker = Worker(name, python)
        except OSError as error:
            report.missing[name] = f"its interpreter does not start: {error.strerror}"
            continue
        stack.callback(worker.close)
        try:
            report.versions[name] = worker.ask(LOADING, do="version")["version"]
        except SolverFailed as error:
            report.missing[name] = str(error)
            continue
        workers[name] = worker
    return workers


def judged(chain: mik.Chain, poses: NDArray[np.float64], answers: list[list[float] | None]) -> list[bool]:
    """Whether each answer is within 1e-5 m and 1e-5 rad of its pose and inside the limits, by Pinocchio."""
    return [
        answer is not None
        and chain.limits.contains(np.array(answer), SLACK)
        and _within(chain.placements(chain.q(answer))[0], pin.SE3(pose))
        for pose, answer in zip(poses, answers, strict=True)
    ]


def _within(reached: pin.SE3, pose: pin.SE3) -> bool:
    error = pose.actInv(reached)
    distance, angle = np.linalg.norm(error.translation), np.linalg.norm(pin.log3(error.rotation))
    return bool(distance <= TOLERANCE and angle <= TOLERANCE)


def loaded(workers: dict[str, Worker], robot: str, chain: mik.Chain, report: Report) -> dict[str, Worker]:
    """The workers that can take this robot, after a few solves."""
    arm = SerialArm.of_chain(robot, chain).to_json()
    warm = targets(robot, chain, "random", WARM_UP, WARM_UP_SEED)
    able = {}
    for name, worker in workers.items():
        try:
            worker.ask(LOADING, do="load", arm=arm, poses=warm.poses.tolist(), starts=warm.starts.tolist())
            able[name] = worker
        except SolverFailed as error:
            if name == OURS:
                raise
            report.unsuitable.setdefault(name, {})[robot] = str(error)
    return able


def measure(
    workers: dict[str, Worker],
    robot: str,
    chain: mik.Chain,
    family: str,
    some: Targets,
    options: argparse.Namespace,
    report: Report,
) -> Iterator[int]:
    """Measure every worker on the targets, block by block; yields how many targets are done. Fills the report.

    A worker that fails is left out of ``workers`` from then on.
    """
    rows = {name: Row(robot, family, name) for name in workers}
    for block, first in enumerate(range(0, len(some.poses), options.block)):
        part = slice(first, min(first + options.block, len(some.poses)))
        peers = [name for name in rows if name != OURS] if first < options.peer_targets else []
        if peers:
            peers = peers[block % len(peers) :] + peers[: block % len(peers)]
        for name in (OURS, *peers, *([OURS] if peers else [])):
            poses, starts = some.poses[part], some.starts[part]
            try:
                answer = workers[name].ask(
                    GRACE + 10.0 * LIMIT * len(poses), do="solve", poses=poses.tolist(), starts=starts.tolist()
                )
            except SolverFailed as error:
                if name == OURS:
                    raise
                del rows[name], workers[name]
                report.unsuitable.setdefault(name, {})[f"{robot}, from {family} on"] = str(error)
                continue
            rows[name].add(block, answer, judged(chain, poses, answer["x"]))
        yield part.stop
    report.rows += rows.values()


def batch_rates(robots: Sequence[str], chains: dict[str, mik.Chain], count: int, seed: int) -> Iterator[BatchRate]:
    """What a random target costs in a batch, with one worker and with two, measured in turn."""
    for robot in robots:
        chain = chains[robot]
        some = targets(robot, chain, "random", count, seed)
        starts = chain.q(some.starts)
        for round_ in range(-1, ROUNDS):  # the first is for warming up
            for workers in (1, 2):
                wall, cpu = time.perf_counter(), time.process_time()
                found = mik.solve_ik_batch(chain, some.poses, starts, workers=workers)
                cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
                if round_ >= 0:
                    solved = judged(chain, some.poses, chain.x(found.q).tolist())
                    yield BatchRate(robot, workers, 1e6 * wall / count, 1e6 * cpu / count, sum(solved), count)


def run(options: argparse.Namespace, report: Report) -> None:
    bar = Progress(
        TextColumn("{task.description:28}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn(), transient=True
    )
    with ExitStack() as stack:
        workers = started(options, stack, report)
        if OURS not in workers:
            raise SystemExit(f"pin_metaik cannot be measured: {report.missing[OURS]}")
        stack.enter_context(bar)
        task = bar.add_task("", total=len(options.robots) * len(options.families) * options.targets)
        done = 0
        chains = {}
        for robot in options.robots:
            bar.update(task, description=f"{robot}, loading")
            model = mik.load_robot(robot)
            chain = chains[robot] = mik.Chain(model.model, model.frame)
            able = loaded(workers, robot, chain, report)
            for family in options.families:
                bar.update(task, description=f"{robot}, {family}")
                some = targets(robot, chain, family, options.targets, options.seed)
                for reached in measure(able, robot, chain, family, some, options, report):
                    bar.update(task, completed=done + reached)
                done += options.targets
                bar.console.print(report.line(robot, family), highlight=False, soft_wrap=True)
        if hasattr(mik, "solve_ik_batch") and not options.no_batch:
            bar.update(task, description="batches", total=None)
            report.batch += batch_rates(options.robots, chains, options.batch_targets, options.seed)


def main() -> None:
    report = Report()
    options = parsed()
    report.command = command(options)
    report.targets, report.peer_targets = options.targets, min(options.targets, options.peer_targets)
    try:
        run(options, report)
    except KeyboardInterrupt:
        report.interrupted = True
    text = report.markdown()
    if options.out:
        options.out.write_text(text)
        print(options.out)
    else:
        print(text)
    raise SystemExit(130 if report.interrupted else 0)


def command(options: argparse.Namespace) -> str:
    """The command line, without the paths of this machine."""
    words = ["python benchmarks/ik_speed.py", f"--targets {options.targets}", f"--peer-targets {options.peer_targets}"]
    words += [f"--block {options.block}", f"--seed {options.seed}"]
    if tuple(options.robots) != ROBOTS:
        words += ["--robots", *options.robots]
    if options.families != list(FAMILIES):
        words += ["--families", *options.families]
    if options.solvers != list(SOLVERS):
        words += ["--solvers", *options.solvers]
    words += [f"--peer {peer.partition('=')[0]}=PYTHON" for peer in options.peer]
    return " ".join(words)


def parsed() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__.splitlines()[0], epilog=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--targets", type=int, default=1000, help="for ours, of each robot and family (%(default)s)")
    parser.add_argument("--peer-targets", type=int, default=200, help="the first of these, for peers (%(default)s)")
    parser.add_argument("--robots", nargs="+", default=list(ROBOTS), metavar="NAME")
    parser.add_argument("--families", nargs="+", default=list(FAMILIES), choices=FAMILIES)
    parser.add_argument("--solvers", nargs="+", default=list(SOLVERS), choices=list(SOLVERS))
    parser.add_argument("--peer", action="append", default=[], metavar="NAME=PYTHON", help="may be repeated")
    parser.add_argument("--block", type=int, default=20, help="targets measured at a stretch (%(default)s)")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument(
        "--batch-targets", type=int, default=10_000, help="random ones, for solve_ik_batch (%(default)s)"
    )
    parser.add_argument("--no-batch", action="store_true", help="leave out solve_ik_batch")
    parser.add_argument("--out", type=Path, help="Markdown file; default: standard output")
    options = parser.parse_args()
    for peer in options.peer:
        if peer.partition("=")[0] not in SOLVERS or "=" not in peer:
            parser.error(f"--peer {peer}: give NAME=PYTHON; names: {', '.join(SOLVERS)}")
    if min(options.targets, options.block) < 1 or options.peer_targets < 0:
        parser.error("targets and blocks are at least 1")
    return options


if __name__ == "__main__":
    main()
