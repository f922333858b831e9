"""``pin-metaik compare``, ``report`` and ``replay`` from the command line."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from pin_metaik.cli import app
from pin_metaik.cli.options import split, spread
from pin_metaik.compare.folder.store import read_rows
from pin_metaik.errors import MetaIKError

SMALL = ["--tasks", "2", "--budget", "200"]
MODULE = """
from pin_metaik.compare import CASES, Answer, Case

class Still:
    name = "still"

    def solve(self, problem, x0, budget, rng):
        return Answer(x0, False, 0)

METHOD = Still()
CASE = Case("at_home", "Random poses.", CASES["random"].draw)
"""


def test_an_option_takes_all_words_up_to_the_next_one() -> None:
    words = ["--robot", "panda", "ur5", "--out", "x", "y", "--methods", "a,b", "c"]
    assert spread(words, {"--robot", "--methods"}) == [
        "--robot", "panda", "--robot", "ur5", "--out", "x", "y", "--methods", "a,b", "--methods", "c",
    ]  # fmt: skip
    assert split(["a, b", "c", ""]) == ("a", "b", "c")


def test_compare_report_and_replay_are_three_commands(tmp_path: Path) -> None:
    run, out = CliRunner(), str(tmp_path / "out")
    words = ["--robot", "ur5", "rv7fl", "--cases", "random", "--methods", "dls,gwo+dls", "--out", out, *SMALL]
    done = run.invoke(app, ["compare", *words])
    assert done.exit_code == 0, done.output
    assert "8 of 8 rows, 8 of them now" in done.output and f"next: pin-metaik report {out}" in done.output
    assert {trial.robot for trial in read_rows(tmp_path / "out")} == {"ur5", "rv7fl"}
    done = run.invoke(app, ["report", out])
    assert done.exit_code == 0 and "report.html" in done.output
    assert (tmp_path / "out" / "report" / "report.html").exists()
    done = run.invoke(app, ["replay", out, "rv7fl/random/1/gwo+dls/0"])
    assert done.exit_code == 0 and "as its row says" in done.output and "task 1: position [" in done.output


def test_methods_and_cases_of_ones_own_are_named_by_module_and_object(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "mine_for_a_test.py").write_text(MODULE)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.path", list(__import__("sys").path))
    words = ["--cases", "mine_for_a_test:CASE", "--methods", "mine_for_a_test:METHOD", "dls", "--out", "out", *SMALL]
    done = CliRunner().invoke(app, ["compare", "--robot", "ur5", *words])
    assert done.exit_code == 0, done.output
    assert {(trial.case, trial.method) for trial in read_rows(tmp_path / "out")} == {
        ("at_home", "still"),
        ("at_home", "dls"),
    }
    done = CliRunner().invoke(app, ["replay", "out", "ur5/at_home/0/still/0"])
    assert done.exit_code == 0 and "not solved" in done.output


def test_nonsense_is_an_error_of_ours(tmp_path: Path) -> None:
    words = ["--robot", "ur5", "--methods", "gwo", "--out", str(tmp_path / "out")]
    done = CliRunner().invoke(app, ["compare", *words, "--cases", "singula"])
    assert isinstance(done.exception, MetaIKError) and "did you mean 'singular'" in str(done.exception)
    done = CliRunner().invoke(app, ["report", str(tmp_path)])
    assert isinstance(done.exception, MetaIKError) and "holds no comparison" in str(done.exception)
    assert not (tmp_path / "out").exists()
