"""What comes from a browser: bounded, named without a path, and never outside of its folder."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path

import pytest

from pin_metaik.errors import InvalidModel, InvalidSetting
from pin_metaik.gui.pages.arms.arm import Arm
from pin_metaik.gui.pages.arms.state import ArmsState
from pin_metaik.gui.uploads import MOST, MOST_FILES, MOST_UNPACKED, only_inside, plain_name, received

KINDS = (".urdf", ".toml")


def packed(entries: dict[str, bytes]) -> bytes:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in entries.items():
            archive.writestr(name, data)
    return content.getvalue()


@pytest.mark.parametrize(
    "name", ["../../etc/passwd.toml", "/etc/x.toml", "..\\..\\x.toml", "\x00a/b\n.toml", "...x.toml"]
)
def test_a_name_leads_nowhere(name: str, tmp_path: Path) -> None:
    path = received(name, b"", tmp_path, KINDS)
    assert path.parent == tmp_path and path.is_file()
    assert "/" not in plain_name(name) and not plain_name(name).startswith(".")


def test_what_is_too_large_or_of_another_kind_is_told_and_not_kept(tmp_path: Path) -> None:
    for name, content, words in (
        ("a.toml", b" " * (MOST + 1), "MiB"),
        ("a.exe", b"", "neither one of .urdf, .toml"),
        ("a.zip", b"PK\x03\x04nonsense", "not a .zip"),
        ("a.zip", packed({"a.txt": b""}), "no file of the kinds"),
        ("a.zip", packed({f"{k}.toml": b"" for k in range(MOST_FILES + 1)}), "files"),
    ):
        with pytest.raises(InvalidSetting, match=words):
            received(name, content, tmp_path, KINDS)
    assert [path.name for path in tmp_path.rglob("*")] in ([], ["a.txt"])


@pytest.mark.parametrize("name", ["../a.toml", "/a.toml", "x/../../a.toml", "..\\a.toml", "C:\\a.toml"])
def test_an_archive_does_not_reach_out_of_its_folder(name: str, tmp_path: Path) -> None:
    inside = tmp_path / "inside"
    inside.mkdir()
    with pytest.raises(InvalidSetting, match="reaches out of its folder"):
        received("a.zip", packed({name: b""}), inside, KINDS)
    assert [path for path in tmp_path.rglob("*") if path != inside] == []


def test_an_archive_that_unpacks_to_too_much_is_told_before_it_is_all_there(tmp_path: Path) -> None:
    bomb = packed({f"{k}.toml": b"\0" * (MOST_UNPACKED // 3) for k in range(4)})
    assert len(bomb) < MOST // 16
    with pytest.raises(InvalidSetting, match="larger than 64 MiB when unpacked"):
        received("bomb.zip", bomb, tmp_path, KINDS)
    assert sum(path.stat().st_size for path in tmp_path.rglob("*.toml")) <= MOST_UNPACKED


def test_what_is_meant_in_an_archive_is_the_first_kind_and_the_least_deep(tmp_path: Path) -> None:
    content = packed({"deep/er/a.urdf": b"1", "b.toml": b"2", "deep/c.urdf": b"3"})
    assert received("a.zip", content, tmp_path, KINDS) == tmp_path / "deep" / "c.urdf"


@pytest.mark.parametrize("file", ["/etc/passwd", "../x.stl", "file:///etc/passwd", "~/x", "package://a/../../x"])
def test_what_was_sent_names_no_file_outside_of_itself(file: str) -> None:
    with pytest.raises(InvalidSetting, match="outside of what was uploaded"):
        only_inside([file], "robot")
    only_inside(["meshes/a.stl", "package://franka/a.stl"], "robot")


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_xacro_is_not_expanded_as_its_expressions_are_python(encoding: str, tmp_path: Path) -> None:
    mark = tmp_path / "run"
    files = "[c for c in ().__class__.__base__.__subclasses__()[:] if c.__name__ == '_IOBase'][0].__subclasses__()"
    code = f"${{(lambda: [c for c in {files} if c.__name__ == '_RawIOBase'][0].__subclasses__()[0]('{mark}', 'w'))()}}"
    text = f'<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="revolute"><origin xyz="{code} 0 0"/>'
    text += '<parent link="a"/><child link="b"/></joint></robot>'
    declared = "" if encoding == "utf-8" else '<?xml version="1.0" encoding="utf-16"?>'
    with pytest.raises(InvalidModel, match="whose expressions are Python: expand it first"):
        Arm.of(ArmsState(urdf=declared + text), tmp_path)
    assert not mark.exists()


def test_mjcf_names_no_mesh_outside_of_what_was_sent(tmp_path: Path) -> None:
    text = '<mujoco><asset><mesh name="m" file="/etc/m.stl"/></asset><worldbody><body name="b"><joint type="hinge"/>'
    text += '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body></worldbody></mujoco>'
    with pytest.raises(InvalidSetting, match=r"names the file '/etc/m\.stl'"):
        Arm.of(ArmsState(urdf=text), tmp_path)
