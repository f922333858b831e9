"""A results folder that is sent: its rates, its hardest targets in the page of arms, and what it may not do."""

from __future__ import annotations

import json
import shutil
import sys
from pathlib import Path
from typing import Any

from pin_metaik.compare import read_results, summarise
from pin_metaik.compare.folder.manifest import MANIFEST

BUTTON = "Open a results folder: .zip"


def packed(folder: Path) -> bytes:
    return Path(shutil.make_archive(str(folder), "zip", folder)).read_bytes()


def test_rates_are_the_librarys_and_a_hard_target_opens_in_arms(socket: Any, results: Path, toolbox: Any) -> None:
    socket.set("Page", "Comparisons")
    socket.send_file(BUTTON, "results.zip", packed(results))
    words = socket.text("95 % interval")
    for method in ("dls", "gwo"):
        found = summarise(read_results(results).rows(method=method))
        assert f"| {method} | {found.solved} of {found.trials} |" in words
    socket.set("See it in Arms", True)
    socket.find("Orientation counts")
    (session,) = toolbox.tabs.values()
    assert session.page.kept()["robot"] == "ur5" and session.page.kept()["target"]


def test_a_folder_that_names_code_has_none_of_it_imported(socket: Any, results: Path, tmp_path: Path) -> None:
    folder = tmp_path / "hostile"
    shutil.copytree(results, folder)
    manifest = json.loads((folder / MANIFEST).read_text())
    manifest["cases"]["random"]["spec"] = "antigravity:case"
    (folder / MANIFEST).write_text(json.dumps(manifest))
    socket.set("Page", "Comparisons")
    socket.send_file(BUTTON, "results.zip", packed(folder))
    socket.see("95 % interval")
    socket.set("See it in Arms", True)
    socket.told("no case by name named 'antigravity:case'")
    assert "antigravity" not in sys.modules
    socket.send_file(BUTTON, "results.zip", b"PK")
    socket.told("not a .zip")
