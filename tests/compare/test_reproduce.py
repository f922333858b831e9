"""The command, with experiments cut down to seconds."""

import sys

import pytest
from typer.testing import CliRunner

from pin_metaik import cli
from pin_metaik.compare.papers import aerial_arm
from pin_metaik.compare.papers.arm import ArmTrial
from pin_metaik.errors import CannotWrite, InvalidSetting
from pin_metaik.folder_lock import locked


def command(*words):
    return CliRunner().invoke(cli.app, ["reproduce", *map(str, words)])


def files(folder):
    return {path.name for path in folder.iterdir()}


def test_rv7fl_puts_the_paper_and_ours_side_by_side(tmp_path):
    result = command("rv7fl", "--quick", "--runs", 1, "--out", tmp_path)
    assert result.exit_code == 0, result.output
    for word in (
        "evals paper",
        "evals ours",
        "s paper",
        "CPU s ours",
        "0.0005234",
        "What changes. MTDE",
        "--long runs them",
    ):
        assert word in result.output
    tables = {"as_printed", "equal", "long", "hybrids", "angles", "runs"}
    assert files(tmp_path) == {
        "rv7fl.html",
        "rv7fl.md",
        *(f"rv7fl_{table}.csv" for table in tables),
        "rv7fl_convergence.png",
        "rv7fl_per_run.png",
    }
    assert "| Case 1 | MTDE | 1,000 | 300,000 | 4.861 |" in (tmp_path / "rv7fl.md").read_text()


def test_a_page_of_before_that_cannot_be_written_over_is_told_before_the_work(tmp_path):
    (tmp_path / "rv7fl.md").mkdir()
    result = command("rv7fl", "--quick", "--runs", 1, "--out", tmp_path)
    assert isinstance(result.exception, CannotWrite)
    assert result.output == ""


def test_one_process_at_a_time_reproduces_into_a_folder(tmp_path):
    with locked(tmp_path, "reproduction"):
        result = command("rv7fl", "--quick", "--runs", 1, "--out", tmp_path)
        assert isinstance(result.exception, InvalidSetting)
        assert "another process" in str(result.exception)
    assert files(tmp_path) == set()


def test_aerial_arm_puts_the_paper_and_ours_side_by_side(tmp_path, monkeypatch):
    monkeypatch.setattr(aerial_arm, "LONG", 4200)
    result = command("aerial_arm", "--quick", "--runs", 1, "--out", tmp_path)
    assert result.exit_code == 0, result.output
    for word in ("J paper", "total paper", "total ours", "s paper", "CPU s ours", "11.62", "SFLA + DLS"):
        assert word in result.output
    tables = {"text", "times", "readings", "de", "hybrids", "angles", "runs"}
    assert files(tmp_path) == {
        "aerial_arm.html",
        "aerial_arm.md",
        *(f"aerial_arm_{table}.csv" for table in tables),
        "aerial_arm_per_run.png",
        "aerial_arm_de_per_run.png",
    }


def test_puma_offset_puts_the_paper_and_ours_side_by_side(tmp_path):
    result = command("puma_offset", "--runs", 1, "--out", tmp_path)
    assert result.exit_code == 0, result.output
    for word in ("O paper", "s paper", "0.386", "GA + DLS", "PSO + DLS"):
        assert word in result.output
    tables = {"o", "printed", "hybrids", "angles", "runs"}
    assert files(tmp_path) == {
        "puma_offset.html",
        "puma_offset.md",
        *(f"puma_offset_{table}.csv" for table in tables),
        "puma_offset_convergence.png",
        "puma_offset_per_run.png",
    }


def test_the_same_seed_gives_the_same_numbers(tmp_path):
    for folder in ("once", "twice"):
        command("puma_offset", "--runs", 1, "--rng", 3, "--out", tmp_path / folder, "--no-figures")
    once, twice = ((tmp_path / folder / "puma_offset_angles.csv").read_text() for folder in ("once", "twice"))
    assert once == twice


def test_ctrl_c_prints_and_writes_what_is_done_and_marks_it_partial(tmp_path, monkeypatch):
    real, made = ArmTrial.__init__, []

    def impatient(self, *values, **named):
        if len(made) == 3:
            raise KeyboardInterrupt
        made.append(self)
        real(self, *values, **named)

    monkeypatch.setattr(ArmTrial, "__init__", impatient)
    result = command("puma_offset", "--runs", 2, "--out", tmp_path)
    assert result.exit_code == 130
    assert "PARTIAL: interrupted after 3 of 16 jobs" in result.output
    assert "PARTIAL: interrupted after 3 of 16 jobs" in (tmp_path / "puma_offset.md").read_text()
    assert len((tmp_path / "puma_offset_runs.csv").read_text().splitlines()) == 1 + 3


def test_an_unknown_paper_is_named_with_those_there_are(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["pin-metaik", "reproduce", "rv8fl"])
    with pytest.raises(SystemExit) as ended:
        cli.run()
    assert ended.value.code == 2
    assert "no paper named 'rv8fl'; did you mean 'rv7fl'? known: aerial_arm" in capsys.readouterr().err


def test_without_matplotlib_figures_are_refused_before_anything_is_run(tmp_path, monkeypatch):
    monkeypatch.setattr("pin_metaik.lookup.find_spec", lambda name: None)
    refused = command("rv7fl", "--out", tmp_path)
    assert "drawing figures needs an optional dependency" in str(refused.exception)
    assert command("puma_offset", "--runs", 1, "--out", tmp_path, "--no-figures").exit_code == 0
