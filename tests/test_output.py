"""What cannot be written is told before the work, and looking leaves nothing behind."""

import os
from pathlib import Path

import pytest

from pin_metaik.errors import CannotWrite
from pin_metaik.output import writable


def test_looking_at_a_file_leaves_it_as_it_was(tmp_path: Path) -> None:
    new, old = tmp_path / "new.txt", tmp_path / "old.txt"
    old.write_text("kept")
    assert writable(new) == new
    assert writable(str(old)) == old
    assert not new.exists()
    assert old.read_text() == "kept"


def test_a_folder_need_not_be_there_yet_and_is_not_made(tmp_path: Path) -> None:
    assert writable(tmp_path / "a" / "b", folder=True) == tmp_path / "a" / "b"
    assert not (tmp_path / "a").exists()


@pytest.mark.parametrize(
    ("path", "folder", "says"),
    [
        ("folder", False, "it is a folder"),
        ("none/x.txt", False, "there is no folder"),
        ("file/x.txt", False, "there is no folder"),
        ("file", True, "is a file, not a folder"),
        ("file/deeper", True, "is a file, not a folder"),
        ("a" * 300, False, "File name too long"),
    ],
)
def test_what_stands_in_the_way_is_named(tmp_path: Path, path: str, folder: bool, says: str) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").write_text("")
    with pytest.raises(CannotWrite, match=says):
        writable(tmp_path / path, folder=folder)


@pytest.mark.skipif(os.geteuid() == 0, reason="nothing is read-only to the system's administrator")
def test_a_read_only_folder_is_named(tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    for folder in (False, True):
        with pytest.raises(CannotWrite, match=r"read-only|Permission denied"):
            writable(tmp_path / "new", folder=folder)
