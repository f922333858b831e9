import json
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

from pin_metaik import stewart
from pin_metaik.cli import app
from pin_metaik.errors import InvalidSetting, InvalidTarget, MetaIKError, UnknownName
from pin_metaik.optimize.qpso import QPSO
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


def test_analyse_as_json_has_the_pose_and_the_way_that_were_asked_for():  # N15
    ends = ("--pose", 20, -15, 240, 5, -8, 12, "--to", 0, 0, 230, 0, 0, 0)
    result = run("analyse", "stroke_100", "--cells", 20, *ends, "--seconds", 2, "--json")
    report = json.loads(result.stdout)
    legs = [0.295424803, 0.293187101, 0.327867639, 0.309894107, 0.300489699, 0.301245912]
    np.testing.assert_allclose(report["at_pose"]["leg_lengths"], legs, atol=1e-8)
    assert report["at_pose"]["reached"] is True
    np.testing.assert_allclose(report["at_pose"]["nu"], 0.873296, atol=1e-6)
    assert np.shape(report["at_pose"]["jacobian"]) == (6, 6)
    way = report["along_way"]
    assert np.shape(way["leg_lengths"]) == np.shape(way["leg_rates"]) == (101, 6)
    np.testing.assert_allclose(way["leg_lengths"][0], legs, atol=1e-8)
    np.testing.assert_allclose([way["times"][-1], way["poses"][-1][2][3]], [2.0, 0.23])
    assert way["singular"] == []
    assert report["cells_reached"] >= 1000
    plain = json.loads(run("analyse", "stroke_100", "--cells", 20, "--json").stdout)
    assert "at_pose" not in plain
    assert "along_way" not in plain


def test_the_picture_shows_the_pose_that_was_asked_for(tmp_path):  # N15
    pytest.importorskip("matplotlib")
    pictures = []
    for name, pose in (
        ("none", ()),
        ("one", ("--pose", 20, -15, 240, 5, -8, 12)),
        ("two", ("--pose", 0, 0, 230, 0, 0, 9)),
    ):
        result = run("analyse", "stroke_100", "--cells", 12, *pose, "--picture", tmp_path / f"{name}.png")
        assert result.exit_code == 0
        pictures.append((tmp_path / f"{name}.png").read_bytes())
    assert len(set(pictures)) == 3


def test_an_orientation_workspace_is_a_share_not_a_volume(tmp_path):
    mechanism = load_mechanism("reference_6x6")
    grid = stewart.Grid.at((0.0, 0.0, 0.37), steps=(9, 9, 1), roll=(-0.6, 0.6), pitch=(-0.6, 0.6))
    path = save_mechanism(replace(mechanism, grid=grid), tmp_path / "turns.toml")
    result = run("analyse", path)
    assert "% of 81 at 0, 0, 370 mm are reached" in result.output
    assert "volume" not in result.output
    assert 0 < json.loads(run("analyse", path, "--json").stdout)["share_reached"] < 1


def test_fewer_than_six_legs_are_said_to_leave_freedoms(tmp_path):
    mechanism = load_mechanism("reference_6x6")
    for legs in (3, 5):
        geometry = stewart.standard_geometry("3x3", 0.25, 0.12, legs=legs)
        path = save_mechanism(replace(mechanism, geometry=geometry), tmp_path / f"{legs}.toml")
        result = run("analyse", path, "--cells", 12)
        assert result.exit_code == 1
        assert "UNDERCONSTRAINED" in result.output
        assert (
            f"{legs} legs between universal and spherical joints leave the platform {6 - legs} degree" in result.output
        )
    assert "leave the platform" in run("show", path).output


def test_a_stroke_longer_than_the_leg_is_said_to_be_so(tmp_path):
    mechanism = load_mechanism("reference_6x6")
    path = save_mechanism(replace(mechanism, limits=stewart.LegLimits(0.18, 0.38)), tmp_path / "long.toml")
    assert "a stroke of 200 mm does not fit into a leg that is 180 mm long" in run("show", path).output
    assert "stroke of" not in run("show", "reference_6x6").output


def test_nothing_is_written_about_progress_where_nobody_watches():
    result = run("analyse", "stroke_100", "--cells", 40)
    assert result.stderr.strip() == ""


def test_a_design_is_saved_before_it_is_printed(tmp_path, monkeypatch):
    def closed(*arguments, **keywords):
        raise BrokenPipeError

    monkeypatch.setattr("pin_metaik.cli.stewart.design.show_lines", closed)
    out, history = tmp_path / "x.toml", tmp_path / "h.csv"
    run("design", "stroke_50", "--evaluations", 60, "-o", out, "--history", history)
    assert load_mechanism(out).geometry.joint_gap >= 0.042
    assert history.exists()


def test_another_algorithm_keeps_the_size_of_the_swarm_and_settings_are_set(tmp_path):
    out = tmp_path / "x.toml"
    asked = ("design", "stroke_50", "--evaluations", 60, "--algorithm", "qpso", "-o", out)
    run(*asked)
    assert load_mechanism(out).task.algorithm == QPSO(agents=60)
    run(*asked, "--set", "agents=20", "--norm", "two", "--length", "50", "--cells", 8)
    found = load_mechanism(out)
    assert found.task.algorithm == QPSO(agents=20)
    assert found.dexterity == stewart.Dexterity("two", 0.05)
    assert found.task.grid.counts == (8, 8, 8)
    run("design", "stroke_50", "--evaluations", 60, "-o", out, "--set", "c1=1.5", "--set", "variant=inertia")
    assert load_mechanism(out).task.algorithm == replace(
        load_mechanism("stroke_50").task.algorithm, c1=1.5, variant="inertia"
    )


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
        def press(at):
            if at.done >= 120:
                raise KeyboardInterrupt

        return whole(mechanism, watch=press)

    monkeypatch.setattr(stewart, "design", interrupted)
    result = run("design", "stroke_50", "-o", tmp_path / "partial.toml")
    assert result.exit_code == 130
    assert "interrupted" in result.output
    assert load_mechanism(tmp_path / "partial.toml").geometry.joint_gap >= 0.042


def test_an_interrupted_survey_is_shown_and_says_so(monkeypatch):
    def survey(mechanism, watch):
        def press(at):
            if at.done > at.total / 2:
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
        (("design", "stroke_50", "--set", "agent=3"), UnknownName, "did you mean 'agents'"),
        (("design", "stroke_50", "--set", "agents"), InvalidSetting, "a setting is key=value"),
        (("design", "stroke_50", "--set", "agents=few"), InvalidSetting, "agents"),
    ],
)
def test_nonsense_is_named(arguments, error, message):
    result = run(*arguments)
    assert isinstance(result.exception, error)
    assert message in str(result.exception)


@pytest.mark.parametrize(
    "command",
    [
        ("analyse", "stroke_50", "--picture"),
        ("design", "stroke_50", "--output"),
        ("design", "stroke_50", "--history"),
        ("design", "stroke_50", "--picture"),
        ("show", "stroke_50", "--urdf"),
        ("show", "stroke_50", "--output"),
    ],
)
def test_what_cannot_be_written_is_told_before_the_work(command, tmp_path, monkeypatch):
    def work(*arguments, **keywords):
        raise AssertionError("worked before looking whether it can be written")

    monkeypatch.setattr(stewart.Mechanism, "survey", work)
    monkeypatch.setattr(stewart, "design", work)
    result = run(*command, tmp_path / "nowhere" / "x.png")
    assert isinstance(result.exception, MetaIKError)
    assert "nowhere" in str(result.exception)
