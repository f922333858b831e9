import os
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import pin_metaik
from pin_metaik.collision.cache import Arrays, cache_folder, kept, where_kept


def test_what_was_made_once_is_read_back(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PIN_METAIK_CACHE", str(tmp_path / "cache"))
    made = []

    def make() -> Arrays:
        made.append(1)
        return {"x": np.arange(3.0)}

    for content in (b"a", b"a", b"b"):
        assert kept("test", content, make)["x"].tolist() == [0.0, 1.0, 2.0]
    assert len(made) == 2


def test_a_damaged_file_is_made_again_and_no_place_to_write_is_no_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PIN_METAIK_CACHE", str(tmp_path / "cache"))
    kept("test", b"a", lambda: {"x": np.zeros(1)})
    (file,) = (tmp_path / "cache").glob("*.npz")
    file.write_bytes(b"PK damaged")
    assert kept("test", b"a", lambda: {"x": np.ones(1)})["x"].tolist() == [1.0]
    monkeypatch.setenv("PIN_METAIK_CACHE", str(file / "no folder"))
    assert kept("test", b"a", lambda: {"x": np.ones(1)})["x"].tolist() == [1.0]


@pytest.mark.parametrize("damage", [b"", b"PK damaged", "half", "flipped", "not an archive"])
def test_whatever_a_damaged_file_holds_it_is_made_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, damage: bytes | str
) -> None:
    monkeypatch.setenv("PIN_METAIK_CACHE", str(tmp_path))
    made = {"x": np.arange(50.0), "y": np.ones((3, 3))}
    kept("test", b"a", lambda: made)
    (file,) = tmp_path.glob("*.npz")
    whole = file.read_bytes()
    rng = np.random.default_rng(0)
    for _ in range(40):
        match damage:
            case bytes():
                file.write_bytes(damage)
            case "half":
                file.write_bytes(whole[: rng.integers(len(whole))])
            case "flipped":
                place = int(rng.integers(len(whole)))
                file.write_bytes(whole[:place] + bytes([whole[place] ^ 0xFF]) + whole[place + 1 :])
            case _:
                with file.open("wb") as opened:
                    np.save(opened, np.arange(3))
        found = kept("test", b"a", lambda: made)
        assert set(found) >= {"x", "y"}
        np.testing.assert_array_equal(found["x"], made["x"])


def test_two_that_write_at_once_leave_a_whole_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PIN_METAIK_CACHE", str(tmp_path))
    made = {"x": np.arange(20_000.0)}

    def write(_: int) -> bool:
        for file in tmp_path.glob("*.npz"):
            file.unlink(missing_ok=True)
        return len(kept("test", b"a", lambda: made)["x"]) == 20_000

    with ThreadPoolExecutor(4) as pool:
        assert all(pool.map(write, range(100)))
    assert not list(tmp_path.glob("*.tmp"))


def test_a_user_without_a_home_keeps_nothing_and_is_told_what_to_set(monkeypatch: pytest.MonkeyPatch) -> None:
    def homeless() -> Path:
        raise RuntimeError("Could not determine home directory.")

    for name in ("PIN_METAIK_CACHE", "XDG_CACHE_HOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(Path, "home", homeless)
    assert cache_folder() is None
    assert kept("test", b"a", lambda: {"x": np.ones(1)})["x"].tolist() == [1.0]
    assert "set PIN_METAIK_CACHE" in where_kept()


WORLD = """
import numpy as np
import pin_metaik as mik
world = mik.CollisionWorld(mik.load_robot("panda"))
print(len(world.in_collision_batch(np.zeros((2, world.model.nq)))))
"""


@pytest.mark.skipif(not shutil.which("setpriv") or os.getuid() != 0, reason="only root can become another user")
@pytest.mark.parametrize("home", [None, "/", "/nonexistent"])
def test_another_user_without_a_place_to_write_has_a_world(home: str | None) -> None:
    source = str(Path(pin_metaik.__file__).parents[1])
    environment = {"PATH": os.environ["PATH"], "PYTHONPATH": source} | ({} if home is None else {"HOME": home})
    other = ["setpriv", "--reuid", "12345", "--regid", "12345", "--clear-groups", sys.executable, "-c"]
    options = {"capture_output": True, "text": True, "env": environment, "cwd": tempfile.gettempdir()}
    if subprocess.run([*other, "import pinocchio, pin_metaik"], **options).returncode:
        pytest.skip("another user cannot read the package")
    run = subprocess.run([*other, WORLD], **options)
    assert (run.returncode, run.stdout.strip()) == (0, "2"), run.stderr
