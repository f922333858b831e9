import json
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

from pin_metaik import stewart
from pin_metaik.cli import app
from pin_metaik.errors import InvalidSetting, InvalidTarget, UnknownName
from pin_metaik.stewart import load_mechanism, save_mechanism
from tests.stewart.cases import similar_hexagons


def run(*arguments):
    return CliRunner().invoke(app, ["stewart", *map(str, arguments)])


def test_analyse_says_what_there_is_to_say():
    result = run("analyse", "stroke_100", "--cells", 40, "--pose", 20, -15, 240, 5, -8, 12)
    assert result.exit_code == 0
    for text in ("3x3, 6 legs: B1-M3", "295.425, 293.187, 327.868", "REGULAR", "0.876", "203.3 mm", "cm3"):
        assert text in result.output


def test_analyse_follows_a_way_across_a_singularity():
    ends = ("--pose", 0, 0, 370, 0, 0, 0, "--to", 0, 0, 370, 0, 0, 120)
    result = run("analyse", "reference_6x6", "--cells", 20, *ends, "--seconds", 2)
    for text in (
        "along the way",
        "2 s",
        "fastest leg",
        "mm/s",
        "too far for a leg",
        "det J changes sign",
        "0, 0, 370 mm",
    ):
        assert text in result.output
    alone = run("analyse", "reference_6x6", "--to", *ends[8:])
    assert isinstance(alone.exception, InvalidTarget)


def test_analyse_as_json_is_plain_values():
    result = run("analyse", "reference_6x6", "--cells", 30, "--json", "--norm", "two", "--length", "best")
    report = json.loads(result.stdout)
    assert report["verdict"] == "REGULAR"
    assert 0.28 < report["gdi"] < 0.32
    assert report["characteristic_length"] != 0.12


def test_a_singular_mechanism_is_reported_and_has_no_number(tmp_path):
    path = save_mechanism(replace(load_mechanism("reference_6x6"), geometry=similar_hexagons()), tmp_path / "s.toml")
    result = run("analyse", path, "--cells", 20)
    assert result.exit_code == 1
    assert "SINGULAR" in result.output
    assert "none: every pose reached is singular" in result.output
    assert json.loads(run("analyse", path, "--cells", 20, "--json").stdout)["gdi"] is None


def test_design_writes_a_mechanism_and_its_history(tmp_path):
    out, history = tmp_path / "found.toml", tmp_path / "history.csv"
    result = run("design", "stroke_50", "--evaluations", 240, "--algorithm", "qpso", "-o", out, "--history", history)
    assert result.exit_code == 0
    assert "fitness" in result.output
    found = load_mechanism(out)
    assert found.task.evaluations == 240
    assert found.geometry.joint_gap >= 0.042
    table = np.genfromtxt(history, delimiter=",", names=True)
    assert table["designs"][-1] == 240
    again = run("design", out, "--json")
    assert json.loads(again.stdout)["mechanism"] == out.read_text()


def test_design_without_a_feasible_one_is_exit_code_1(tmp_path):
    mechanism = load_mechanism("stroke_50")
    path = save_mechanism(replace(mechanism, task=replace(mechanism.task, joint_gap=1.0)), tmp_path / "tight.toml")
    result = run("design", path, "--evaluations", 60, "-o", tmp_path / "none.toml")
    assert result.exit_code == 1
    assert "none found" in result.output
    assert not (tmp_path / "none.toml").exists()


def test_an_interrupted_design_is_kept_and_says_so(tmp_path, monkeypatch):
    whole = stewart.design

    def interrupted(mechanism, watch):
        def press(done, total):
            if done >= 120:
                raise KeyboardInterrupt

        return whole(mechanism, watch=press)

    monkeypatch.setattr(stewart, "design", interrupted)
    result = run("design", "stroke_50", "-o", tmp_path / "partial.toml")
    assert result.exit_code == 130
    assert "interrupted" in result.output
    assert load_mechanism(tmp_path / "partial.toml").geometry.joint_gap >= 0.042


def test_an_interrupted_survey_is_shown_and_says_so(monkeypatch):
    def survey(mechanism, watch):
        def press(done, total):
            if done > total / 2:
                raise KeyboardInterrupt

        return stewart.survey(mechanism.geometry, mechanism.limits, mechanism.grid, watch=press)

    monkeypatch.setattr(stewart.Mechanism, "survey", survey)
    result = run("analyse", "reference_6x6", "--cells", 80)
    assert result.exit_code == 130
    assert "PARTIAL" in result.output
    assert "not looked at" in result.output


def test_show_prints_draws_and_exports(tmp_path):
    pytest.importorskip("matplotlib")
    result = run("show", "stroke_150", "--urdf", tmp_path / "m.urdf", "-o", tmp_path / "m.png", "--no-workspace")
    assert result.exit_code == 0
    assert "Guesses" in result.output
    assert "leg_6_end" in (tmp_path / "m.urdf").read_text()
    assert (tmp_path / "m.png").stat().st_size > 10_000
    assert run("show", "stroke_150", "--toml").stdout.startswith('name = "stroke_150"')


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        (("analyse", "strok_50"), UnknownName, "did you mean 'stroke_50'"),
        (("analyse", "stroke_50", "--norm", "tow"), InvalidSetting, "norm must be one of"),
        (("analyse", "stroke_50", "--length", "rb"), InvalidSetting, "length is 'rm'"),
        (("design", "reference_6x6"), InvalidSetting, "no design settings"),
        (("design", "stroke_50", "--algorithm", "psa"), UnknownName, "did you mean 'pso'"),
    ],
)
def test_nonsense_is_named(arguments, error, message):
    result = run(*arguments)
    assert isinstance(result.exception, error)
    assert message in str(result.exception)
