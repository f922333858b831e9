"""Running comparisons: rows depend on names and numbers alone, and nothing that was done is lost."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, suppress
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pyarrow import parquet

import pin_metaik as mik
from pin_metaik.compare import METHODS as KNOWN
from pin_metaik.compare import Answer, Suite, compare, read_results, replay, write_report
from pin_metaik.compare.cases.case import NoTask
from pin_metaik.compare.folder.environment import read_environment
from pin_metaik.compare.folder.manifest import Manifest
from pin_metaik.compare.folder.store import ROWS, read_manifest, read_rows
from pin_metaik.compare.report.by_case import by_case
from pin_metaik.compare.report.overview import reading
from pin_metaik.compare.trials.trial import generator
from pin_metaik.errors import CannotWrite, InvalidSetting, MetaIKError, MissingExtra, UnknownName
from tests.compare.suites import IMPOSSIBLE, JUMPING, METHODS, SMALL, Interrupted, rows

ROOT = Path(__file__).parents[2]
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT)}
COMMAND = [
    sys.executable, "-m", "pin_metaik", "compare", "--robot", "ur5", "--cases", "singular", "path",
    "--methods", ",".join(METHODS), "--tasks", "3", "--seeds", "2", "--budget", "300",
]  # fmt: skip
# The same, but that it and all its processes are killed as soon as the first rows are written.
KILLED = """
import os, signal
from pin_metaik.compare.folder.store import Appender

def add(self, trials, add=Appender.add):
    add(self, trials)
    os.killpg(0, signal.SIGKILL)

Appender.add = add
from pin_metaik_command import run
run()
"""


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The small comparison, run at a stretch in this process."""
    folder = tmp_path_factory.mktemp("whole")
    outcome = compare(SMALL, folder)
    assert (outcome.done, outcome.fresh, outcome.errors, outcome.partial) == (48, 48, 0, False)
    return folder


def test_rows_do_not_depend_on_the_number_of_processes(whole: Path, tmp_path: Path) -> None:
    compare(SMALL, tmp_path, jobs=2)
    assert rows(tmp_path) == rows(whole)


def test_rows_do_not_depend_on_what_else_is_compared(whole: Path, tmp_path: Path) -> None:
    compare(Suite(("ur5",), ("path",), ("default", "gwo"), tasks=2, seeds=1, budget=300), tmp_path)
    there = rows(whole)
    assert rows(tmp_path).items() <= there.items()


def test_another_seed_gives_other_tasks() -> None:
    same, other = (generator(0, "ur5", "path", 1, 0, method).random() for method in ("gwo", "gwo"))
    assert same == other
    paths = [
        ("ur5", "path", 1, 0, "gwo"),
        ("ur5", "path", 0, 1, "gwo"),
        ("ur5", "path", 1, 0, "gwo+dls"),
        ("ur5", "path", 1),
    ]
    drawn = [generator(0, *path).random() for path in paths] + [generator(1, *paths[0]).random()]
    assert len(set(drawn)) == len(drawn)


def test_what_was_cut_off_is_done_again_and_nothing_else(whole: Path, tmp_path: Path) -> None:
    compare(SMALL, tmp_path)
    text = (tmp_path / ROWS).read_bytes()
    lines = text.splitlines(keepends=True)
    (tmp_path / ROWS).write_bytes(b"".join(lines[:20]) + lines[20][:57])
    assert len(read_rows(tmp_path)) == 20
    outcome = compare(SMALL, tmp_path)
    assert (outcome.done, outcome.fresh) == (48, 28)
    assert rows(tmp_path) == rows(whole)
    assert (tmp_path / ROWS).read_bytes().startswith(b"".join(lines[:20]))
    assert len(read_environment(tmp_path)) == 2


def test_a_comparison_may_grow_but_not_change(whole: Path, tmp_path: Path) -> None:
    compare(Suite(("ur5",), ("path",), ("gwo",), tasks=1, seeds=1, budget=300), tmp_path)
    outcome = compare(SMALL, tmp_path)
    assert outcome.fresh == 47
    assert rows(tmp_path) == rows(whole)
    for changed, complaint in (
        (Suite(("ur5",), ("singular", "path"), METHODS, 3, 2, 400), "--budget 300, not 400"),
        (Suite(("ur5",), ("singular", "path"), METHODS, 3, 2, 300, 1), "--rng 0, not 1"),
        (Suite(("ur5",), ("singular",), METHODS, 3, 2, 300), "cases path"),
        (Suite(("ur5",), ("singular", "path"), METHODS, 2, 2, 300), "3 tasks"),
    ):
        with pytest.raises(InvalidSetting, match=complaint):
            compare(changed, tmp_path)


def test_a_line_that_is_no_row_is_named(tmp_path: Path) -> None:
    (tmp_path / ROWS).write_text('{"robot": "ur5"}\n')
    with pytest.raises(InvalidSetting, match="line 1"):
        read_rows(tmp_path)


def test_what_a_method_raises_is_a_row_and_not_the_end(tmp_path: Path) -> None:
    outcome = compare(Suite(("ur5",), ("random",), (JUMPING, "dls"), tasks=8, budget=100), tmp_path)
    assert outcome.done == 16
    raised = [trial for trial in read_rows(tmp_path) if trial.error is not None]
    assert 0 < len(raised) == outcome.errors < 8
    assert {trial.error for trial in raised} == {"ZeroDivisionError: one over nothing"}
    assert not any(trial.solved for trial in raised)
    claimed = [trial for trial in read_rows(tmp_path) if trial.method == "jumping" and trial.error is None]
    assert all(trial.claimed and not trial.met and not trial.solved for trial in claimed)


def test_a_case_that_raises_is_a_row_for_each_method(tmp_path: Path) -> None:
    assert compare(Suite(("ur5",), (IMPOSSIBLE,), ("dls", "lm"), tasks=2), tmp_path).errors == 4


def test_a_trial_over_its_budget_has_not_solved_its_task(tmp_path: Path) -> None:
    compare(Suite(("ur5",), ("random",), ("tests.compare.suites:SPENDTHRIFT",), tasks=3), tmp_path)
    assert all(trial.met and not trial.solved for trial in read_rows(tmp_path))


def test_methods_that_know_nothing_of_collisions_try_again_within_their_budget(tmp_path: Path) -> None:
    methods = ("dls+restarts", "mtde@60+dls", "default")
    compare(Suite(("ur5",), ("cluttered",), methods, tasks=5, budget=2000), tmp_path)
    trials = read_rows(tmp_path)
    assert all(trial.solved and trial.evaluations is not None and trial.evaluations <= 2000 for trial in trials)


def test_ctrl_c_keeps_what_is_done(tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt) as press:
        compare(Suite(("ur5",), ("random",), (Interrupted(),), tasks=6), tmp_path)
    outcome = press.value.result
    assert outcome.partial and outcome.done == len(read_rows(tmp_path)) == 2
    assert "interrupted: the same command resumes" in str(outcome)


def test_the_parquet_file_has_the_same_rows(whole: Path) -> None:
    table = parquet.read_table(whole / "rows.parquet").to_pylist()
    trials = sorted(read_rows(whole), key=lambda trial: trial.key)
    assert json.loads(json.dumps([trial.row() for trial in trials])) == table


def test_a_suite_and_its_environment_are_written_down(whole: Path) -> None:
    record = read_manifest(whole)
    assert record == Manifest.from_suite(SMALL) and record.suite(whole) == SMALL
    (session,) = read_environment(whole)
    assert {"pin-metaik", "pin", "numpy", "numba", "scipy", "joblib"} <= session["packages"].keys()
    assert session["processor"] and session["cores"] >= 1 and session["date"].startswith("20")
    assert session["kernel_evaluations"]["measured by"] == "python benchmarks/kernel_costs.py"


def test_a_trial_can_be_run_again_by_its_name(whole: Path) -> None:
    trial = next(trial for trial in read_rows(whole) if trial.method == "mtde@60+dls" and trial.case == "singular")
    again = replay(whole, trial.name)
    assert again.same and again.trial.reproducible == trial.reproducible
    assert "as its row says" in "\n".join(again.lines())
    with pytest.raises(UnknownName, match="no method named 'gwo2'"):
        replay(whole, "ur5/singular/0/gwo2/0")
    with pytest.raises(InvalidSetting, match="ROBOT/CASE/TASK/METHOD/SEED"):
        replay(whole, "ur5/singular")


@pytest.mark.parametrize(
    ("call", "error"),
    [
        (lambda: Suite(("ur55",), ("path",), ("gwo",)), UnknownName),
        (lambda: Suite(("ur5",), ("paht",), ("gwo",)), UnknownName),
        (lambda: Suite(("ur5",), ("path",), ("gow",)), UnknownName),
        (lambda: Suite(("ur5",), ("path",), ("nowhere:gwo",)), InvalidSetting),
        (lambda: Suite(("ur5",), ("path",), ("tests.compare.suites:NONE",)), UnknownName),
        (lambda: Suite(("ur5",), ("tests.compare.suites:JUMPING",), ("gwo",)), InvalidSetting),
        (lambda: Suite(("ur5",), ("path",), ("tests.compare.suites:MINE",)), InvalidSetting),
        (lambda: Suite(("ur5",), ("path",), ("gwo", "gwo")), InvalidSetting),
        (lambda: Suite((), ("path",), ("gwo",)), InvalidSetting),
        (lambda: Suite(("ur5",), ("path",), ("gwo",), tasks=0), InvalidSetting),
    ],
)
def test_what_makes_no_sense_is_said_before_anything_runs(call: object, error: type[MetaIKError]) -> None:
    with pytest.raises(error):
        call()  # type: ignore[operator]


def test_peers_that_are_missing_are_told_before_anything_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pin_metaik.lookup.find_spec", lambda name: None)
    with pytest.raises(MissingExtra, match="peers"):
        Suite(("ur5",), ("path",), ("ikpy",))
    assert "ikpy" in KNOWN


@pytest.mark.slow
def test_killed_half_way_and_started_again_the_rows_are_those_of_one_stretch(whole: Path, tmp_path: Path) -> None:
    out = ["--jobs", "2", "--out", str(tmp_path)]
    killed = [COMMAND[0], "-c", KILLED, *COMMAND[3:], *out]
    with subprocess.Popen(killed, env=ENVIRONMENT, start_new_session=True, stderr=subprocess.DEVNULL) as running:
        assert running.wait(timeout=300) == -signal.SIGKILL
    there = rows(tmp_path)
    assert 0 < len(there) < 48
    done = subprocess.run([*COMMAND, *out], env=ENVIRONMENT, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert f"48 of 48 rows, {48 - len(there)} of them now" in done.stdout
    assert rows(tmp_path) == rows(whole)


@pytest.fixture(scope="module")
def scheduler(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The address of a Dask cluster on this machine: a scheduler and two workers, each a process."""
    pytest.importorskip("distributed")
    folder = tmp_path_factory.mktemp("dask")
    where, quiet = folder / "scheduler.json", {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    dask = [sys.executable, "-m", "dask"]
    here = ["--host", "127.0.0.1", "--no-dashboard"]
    with ExitStack() as stack:

        def start(*words: str) -> None:
            process = subprocess.Popen([*dask, *words], env=ENVIRONMENT, cwd=folder, **quiet)
            stack.callback(process.wait)
            stack.callback(process.terminate)

        start("scheduler", "--port", "0", "--scheduler-file", str(where), *here)
        address, until = None, time.monotonic() + 60.0
        while address is None and time.monotonic() < until:
            time.sleep(0.05)
            with suppress(FileNotFoundError, json.JSONDecodeError):  # it is not there yet, or not whole
                address = str(json.loads(where.read_text())["address"])
        assert address is not None
        for _ in range(2):
            start("worker", address, "--nworkers", "1", "--nthreads", "1", *here)
        from distributed import Client

        with Client(address, timeout=60) as client:  # type: ignore[no-untyped-call]
            client.wait_for_workers(2, timeout=60)
        yield address


@pytest.mark.slow
def test_a_dask_cluster_gives_the_same_rows(whole: Path, tmp_path: Path, scheduler: str) -> None:
    words = [*COMMAND, "--backend", "dask", "--scheduler", scheduler, "--out", str(tmp_path)]
    done = subprocess.run(words, env=ENVIRONMENT, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert rows(tmp_path) == rows(whole)


def test_a_cluster_that_does_not_answer_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr("pin_metaik.workers.CONNECTING", 0.5)
    for scheduler, complaint in ((None, "--scheduler ADDRESS"), ("tcp://127.0.0.1:9", "no Dask scheduler answers")):
        with pytest.raises(InvalidSetting, match=complaint):
            compare(SMALL, tmp_path / "out", backend="dask", scheduler=scheduler)


SMALL_ARM = ("a1", "double_pendulum", "finger_edu")


@pytest.mark.parametrize("robot", SMALL_ARM)
def test_a_case_that_an_arm_has_none_of_is_said_once_and_the_others_go_on(robot: str, tmp_path: Path) -> None:
    outcome = compare(Suite((robot, "ur5"), ("singular", "random"), ("lm",), tasks=2, budget=100), tmp_path)
    assert not outcome.partial
    absent = {line.partition(":")[0] for line in outcome.absent}
    assert absent <= {f"{robot}/singular"}
    assert outcome.done == outcome.planned == 2 * (4 - len(absent))
    assert str(outcome).count("without ") == len(absent)
    if absent:
        report = read_results(tmp_path)
        assert f"Not compared: {robot}/singular" in " ".join(reading(report).text)
        with pytest.raises(InvalidSetting, match="no trial"):
            replay(tmp_path, f"{robot}/singular/0/lm/0")


def test_where_no_arm_has_any_of_the_cases_that_is_said_before_the_work(tmp_path: Path) -> None:
    with pytest.raises(NoTask, match="a1/singular: no configuration of these 3 joints loses a direction"):
        compare(Suite(("a1",), ("singular",), ("lm",), tasks=2), tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_a_second_process_is_refused_and_a_killed_one_leaves_no_lock(tmp_path: Path) -> None:
    holder = "import sys, time; from pathlib import Path; from pin_metaik.folder_lock import locked\n"
    holder += f"with locked(Path({str(tmp_path)!r}), 'comparison'): print('held', flush=True); time.sleep(3600)"
    with subprocess.Popen([sys.executable, "-c", holder], env=ENVIRONMENT, stdout=subprocess.PIPE) as running:
        try:
            assert running.stdout is not None and running.stdout.readline() == b"held\n"
            with pytest.raises(InvalidSetting, match=rf"another process \({running.pid}\) works on the comparison"):
                compare(SMALL, tmp_path)
        finally:
            running.kill()
    outcome = compare(Suite(("ur5",), ("random",), ("lm",), tasks=1, budget=50), tmp_path)
    assert outcome.done == 1
    assert not list(tmp_path.glob(".*.lock"))


def test_a_comparison_of_ones_own_robot_is_run_again_in_another_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    here, there = tmp_path / "here", tmp_path / "there"
    here.mkdir()
    (here / "mine.urdf").write_text(mik.load_robot("rv7fl").urdf)
    (here / "mine.toml").write_bytes(mik.load_robot("cobra600").source.read_bytes())
    monkeypatch.chdir(here)
    compare(Suite(("mine.urdf", "mine.toml", "ur5"), ("random",), ("lm",), tasks=1, budget=50), Path("out"))
    trials = [trial.name for trial in read_rows(here / "out")]
    (here / "out").rename(there)
    (here / "mine.urdf").unlink()
    (here / "mine.toml").unlink()
    monkeypatch.chdir("/")
    assert len(trials) == 3
    assert all(replay(there, trial).same for trial in trials)


def test_meshes_travel_where_a_case_has_a_world(tmp_path: Path) -> None:
    robot = mik.load_robot("ur5")
    meshes = {path for piece in robot.collision_model.geometryObjects if (path := Path(piece.meshPath)).is_file()}
    package = tmp_path / "here" / "example-robot-data"
    for mesh in meshes:
        tail = mesh.as_posix().partition("/example-robot-data/")[2]
        (package / tail).parent.mkdir(parents=True, exist_ok=True)
        (package / tail).write_bytes(mesh.read_bytes())
    own = tmp_path / "here" / "mine.urdf"
    own.write_text(robot.urdf)
    compare(Suite((str(own),), ("cluttered",), ("default",), tasks=1, budget=500), tmp_path / "out")
    (trial,) = read_rows(tmp_path / "out")
    assert trial.error is None
    (tmp_path / "here").rename(tmp_path / "gone")
    assert replay(tmp_path / "out", trial.name).same


def test_rows_of_another_robot_of_the_same_name_are_not_mixed(tmp_path: Path) -> None:
    own, urdf = tmp_path / "mine.urdf", mik.load_robot("rv7fl").urdf
    suite = Suite(("ur5",), ("random",), ("lm",), tasks=1, budget=50)
    own.write_text(urdf)
    compare(replace(suite, robots=(str(own),)), tmp_path / "out")
    own.write_text(urdf.replace("<robot", "<!-- measured anew --><robot", 1))
    with pytest.raises(InvalidSetting, match="rows of another 'rv7fl'"):
        compare(replace(suite, robots=(str(own),)), tmp_path / "out")


def test_folders_from_before_robots_travelled_are_read(whole: Path, tmp_path: Path) -> None:
    values = read_manifest(whole).to_json()
    del values["files"], values["absent"]
    assert Manifest.from_json(values) == read_manifest(whole)


@pytest.mark.parametrize(
    ("file", "change", "says"),
    [
        ("suite.json", lambda text: text.replace('"budget"', '"bugdet"'), "unknown key 'bugdet'"),
        ("suite.json", lambda text: text.replace('"about"', '"around"'), "unknown key 'around'"),
        ("suite.json", lambda text: text.replace('"rng"', '"absent"'), "the key 'absent' occurs twice"),
        ("suite.json", lambda text: json.dumps({"robots": json.loads(text)["robots"]}), "is missing"),
        ("suite.json", lambda text: text.replace('"tasks": 3', '"tasks": "3"'), "tasks: expected a whole number"),
        ("suite.json", lambda text: text[:-9], "is not JSON"),
        ("suite.json", lambda text: "[]", "is not an object"),
        ("environment.json", lambda text: text[:-9], "is not JSON"),
        ("environment.json", lambda text: "{}", "is not a list"),
        ("environment.json", lambda text: text.replace('"cores"', '"kernels"'), "unknown key 'kernels'"),
    ],
)
def test_what_somebody_spoilt_in_a_folder_is_named(
    file: str, change: Callable[[str], str], says: str, whole: Path, tmp_path: Path
) -> None:
    folder = Path(shutil.copytree(whole, tmp_path / "spoilt"))
    text = (folder / file).read_text()
    (folder / file).write_text(change(text))
    assert (folder / file).read_text() != text
    for call in (lambda: write_report(folder), lambda: compare(SMALL, folder)):
        with pytest.raises(InvalidSetting, match=says):
            call()


def test_rows_that_cannot_be_written_are_told_before_the_work(tmp_path: Path) -> None:
    (tmp_path / ROWS).mkdir()
    with pytest.raises(CannotWrite, match=ROWS):
        compare(SMALL, tmp_path)


def test_a_trial_that_was_never_asked_for_is_named(whole: Path) -> None:
    with pytest.raises(InvalidSetting, match="tasks of this comparison are 0 to 2, got 3"):
        replay(whole, "ur5/path/3/gwo/0")
    with pytest.raises(InvalidSetting, match="seeds of this comparison are 0 to 1, got 2"):
        replay(whole, "ur5/path/0/gwo/2")
    lines = list(replay(whole, "ur5/path/2/gwo/0").lines())
    assert lines[1].startswith("task 2, pose 1: position [")
    assert sum("rotation" in line for line in lines) == 20


def test_the_error_that_most_rows_have_is_said(tmp_path: Path) -> None:
    outcome = compare(Suite(("ur5",), (IMPOSSIBLE,), ("dls", "lm"), tasks=2), tmp_path)
    assert "4 raised an error, most often RuntimeError: no such pose" in str(outcome)
    results = read_results(tmp_path)
    assert "4 of 4 raised RuntimeError: no such pose" in " ".join(by_case(results, results.cases["impossible"]).text)


class Swallowing:
    """Catches whatever is raised while it works, Ctrl-C included, and answers all the same."""

    name = "swallowing"

    def __init__(self) -> None:
        self.calls = 0

    def solve(self, problem: mik.IKProblem, x0: np.ndarray, budget: int, rng: np.random.Generator) -> Answer:
        self.calls += 1
        with suppress(BaseException):
            if self.calls == 4:  # the first call is for warming up
                os.kill(os.getpid(), signal.SIGINT)
                time.sleep(1.0)
        return Answer(x0, False, 1)


@pytest.mark.parametrize("later", [0.0, 0.1, 0.3, 1.0])
def test_ctrl_c_in_a_terminal_ends_all_processes_without_last_words(later: float, tmp_path: Path) -> None:
    options = ["--targets", "500", "--jobs", "2", "--out", str(tmp_path)]
    words = ["-m", "pin_metaik", "compare", "--robot", "ur5", "--cases", "singular", "--methods", "gwo,mtde", *options]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True, "env": ENVIRONMENT}
    with subprocess.Popen([sys.executable, *words], start_new_session=True, **pipes) as process:
        while not ((tmp_path / "environment.json").exists() and (tmp_path / ROWS).exists()):
            time.sleep(0.01)
        time.sleep(later)
        os.killpg(process.pid, signal.SIGINT)
        said, error = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "interrupted: the same command resumes" in said
    assert "Traceback" not in error
    assert "arning" not in error


def test_a_method_that_swallows_ctrl_c_ends_the_comparison_and_leaves_no_row(tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt):
        compare(Suite(("ur5",), ("random",), (Swallowing(),), tasks=6), tmp_path)
    assert len(read_rows(tmp_path)) == 2
