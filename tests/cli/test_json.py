"""Answers for other programs: one JSON object, with versions, whatever the command; and what the shell completes."""

import json
from pathlib import Path

import pytest

from pin_metaik.cli import complete
from tests.cli.calls import caller

VERSIONS = {"pin_metaik", "pin", "coal", "numpy", "numba"}


def test_robots_tell_their_joints_and_what_is_proved(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    call = caller(monkeypatch, capsys)
    code, out, _ = call("robots", "--json")
    answer = json.loads(out)
    assert code == 0 and set(answer["versions"]) == VERSIONS
    by_name = {row["robot"]: row for row in answer["robots"]}
    assert by_name["ur5"]["closed_form"] and by_name["ur5"]["all_solutions_proved_by"] == "closed form"
    assert not by_name["panda"]["closed_form"]
    assert (by_name["panda"]["joints"], by_name["panda"]["joints_to_tip"]) == (8, 7)
    assert by_name["panda"]["unreachable_proved_by"] == "boxes"
    assert by_name["talos"]["unreachable_proved_by"] == "little"
    assert complete.robots("ur5") == [name for name in by_name if name.startswith("ur5")]
    code, out, _ = call("robots", "ur5")
    assert code == 0 and "all solutions" in out and "closed form" in out


def test_a_comparison_its_report_and_a_trial_of_it_are_objects(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    call = caller(monkeypatch, capsys)
    words = ("--robot", "ur5", "--cases", "random", "--methods", "default", "--tasks", 3, "--out", tmp_path / "out")
    code, out, _ = call("compare", *words, "--json")
    assert code == 0 and json.loads(out)["done"] == 3 and not json.loads(out)["partial"]
    code, out, _ = call("report", tmp_path / "out", "--json")
    assert code == 0 and Path(json.loads(out)["page"]).is_file()
    assert all(Path(file).is_file() for file in json.loads(out)["files"])
    code, out, _ = call("replay", tmp_path / "out", "ur5/random/1/default/0", "--json")
    answer = json.loads(out)
    assert code == 0 and answer["same"] and answer["trial"]["robot"] == answer["row"]["robot"] == "ur5"
