"""A warning names the line that called this package, whatever it went through on its way."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import pin_metaik as mik
from pin_metaik import collision, mobile, robots

LIMIT = '<limit lower="-1" upper="1" effort="-1" velocity="1"/>'
SPHERE = '<visual><geometry><sphere radius="0.1"/></geometry></visual>'
ARM = (
    f'<robot name="arm"><link name="a"/><link name="b">{SPHERE}</link><joint name="j" type="revolute">'
    f'<parent link="a"/><child link="b"/><axis xyz="0 0 1"/>{LIMIT}</joint></robot>'
)
TABLE = """name = "t"
convention = "modified"
length = "m"
angle = "deg"
[parameters]
idle = 1
[[joint]]
a = 1
alpha = 0
d = 0
limits = [-90, 90]
"""
CORNERS = 1000.0 * np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])


def quietly(text: str) -> mik.Robot:
    with pytest.warns(UserWarning, match="effort"):
        return mik.load_robot(text)


CALLS: dict[str, Callable[[], object]] = {
    "load_robot": lambda: mik.load_robot(ARM),
    "read_table": lambda: robots.read_table("table.toml"),
    "Chain": lambda: mik.Chain(mik.load_robot("ur5"), "tool0", limits={"elbow_joint": (-90.0, 90.0)}),
    "CollisionWorld": lambda: mik.CollisionWorld(ARMS[0]),
    "Mesh": lambda: collision.Mesh(CORNERS),
    "Scene": lambda: mobile.load_scene("site.geojson", start=(8.5, 47.3), goal=(8.6, 47.4)),
}
ARMS: list[mik.Robot] = []


@pytest.mark.parametrize("door", CALLS)
def test_a_warning_points_at_who_called(door: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("table.toml").write_text(TABLE)
    ring = [[8.5, 47.3], [8.52, 47.3], [8.52, 47.32], [8.5, 47.3]]
    Path("site.geojson").write_text(f'{{"type": "Polygon", "coordinates": [{ring}]}}')
    ARMS[:] = [quietly(ARM)]
    with pytest.warns(UserWarning) as said:
        CALLS[door]()
    where = sys.modules[__name__].__file__
    assert [warning.filename for warning in said] == [where] * len(said)
    assert {warning.lineno for warning in said} == {CALLS[door].__code__.co_firstlineno}
