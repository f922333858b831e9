"""``pin-metaik reachability`` and ``place-base``, as users call them."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from pin_metaik.reachable import Reachability
from tests.cli.calls import Call, caller


@pytest.fixture
def call(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Call:
    monkeypatch.chdir(tmp_path)
    return caller(monkeypatch, capsys)


def test_a_map_is_made_kept_written_and_drawn(call: Call) -> None:
    words = ("reachability", "ur5", "--spacing", 0.4, "--orientations", 4, "--folder", "parts")
    code, out, _ = call(*words, "-o", "map.parquet", "-o", "map.png")
    assert code == 0 and "4 orientations" in out
    found = Reachability.load("map.parquet")
    assert Path("map.png").stat().st_size > 10_000
    again = json.loads(call(*words, "--json")[1])
    np.testing.assert_array_equal(again["share"], found.share)
    code, out, _ = call("reachability", "ur5", "--box", 0.3, 0, 0.3, 0.5, 0, 0.3, "--spacing", 0.1, "--orientations", 0)
    assert "3 positions, 1 orientations: 3 of 3 poses reached" in out


def test_a_base_is_placed_for_poses_in_a_file(call: Call) -> None:
    Path("poses.csv").write_text("x,y,z,roll,pitch,yaw\n3,2,0.3,180,0,10\n3.2,2.1,0.2,180,0,-20\n")
    code, out, _ = call("place-base", "ur5", "poses.csv", "--degrees", "--places", 100)
    assert code == 0 and "2 of 2 poses reached" in out
    Path("positions.csv").write_text("# x, y, z\n3,2,0.3\n30,20,0.3\n")
    code, out, _ = call("place-base", "ur5", "positions.csv", "--places", 20, "--json")
    assert code == 1 and json.loads(out)["reached"] < 2


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("reachability", "ur5", "-o", "map.csv"), ".npz or .parquet"),
        (("reachability", "ur5", "--spacing", 0), "spacing"),
        (("reachability", "ur5", "--box", 1, 0, 0, 0, 1, 1), "lower corner"),
        (("place-base", "ur5", "none.csv"), "cannot read none.csv"),
        (("place-base", "ur5", "words.csv"), "row 2 has words"),
        (("place-base", "ur5", "few.csv"), "x,y,z or x,y,z,roll,pitch,yaw"),
    ],
)
def test_what_makes_no_sense_is_one_line(call: Call, words: tuple[object, ...], says: str) -> None:
    Path("words.csv").write_text("1,2,3\n1,2,up\n")
    Path("few.csv").write_text("1,2\n")
    code, _, err = call(*words)
    assert code == 2 and says in " ".join(err.split())
