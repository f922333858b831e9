"""The pictures of docs/toolbox.md, taken by clicking through: python benchmarks/toolbox_pictures.py [PAGE ...]."""

from __future__ import annotations

import io
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from PIL import Image
from playwright.sync_api import sync_playwright
from toolbox_browser import Page, launched

from pin_metaik.gui import open_toolbox
from pin_metaik.gui.kept import to_address
from pin_metaik.gui.pages.arms.obstacles import entries_of

IMAGES = Path(__file__).parents[1] / "docs" / "images"
LARGEST = 150_000  # bytes
COLOURS = 96
TARGET = (0.45, 0.2, 0.5, 1.0, 0.0, 0.0, 0.0)  # x, y, z in m, and a quaternion x, y, z, w
REST = 4.0  # s until the scene has come to rest


def arms(tab: Page) -> None:
    """A Panda among obstacles, with the tool pointing down, and the closest points of it and of them."""
    state = {"target": TARGET, "avoid": True, "obstacles": entries_of("table")}
    tab.page.goto(tab.page.url.split("?")[0].rstrip("/") + to_address("arms", {"arms": state}))
    tab.dismiss()
    tab.see("nearest to an obstacle")
    tab.type("x, y, z, m, 1 of 3", "0.46")  # the first answer had its loops to load
    tab.see("nearest to an obstacle")
    tab.open("Joints")


def metaheuristics(tab: Page) -> None:
    """The paper's first example, GA against PSO."""
    tab.choose("Page", "Metaheuristics at work")
    tab.see("Examples of the paper")
    tab.click("Set up")
    tab.click_until("Run both side by side", "pso 2")
    tab.wait_until(lambda: tab.text().count("than the shortest") + tab.text().count("not free") >= 2)
    tab.scroll_to("Results")


def paths(tab: Page) -> None:
    """Obstacles by number and seed, the shortest path and other ways round, and a robot that drives along one."""
    tab.choose("Page", "Path planning")
    tab.see("Quickest motion")
    tab.click("Random map")
    tab.see("SHORTEST")
    tab.open("Other ways round")
    tab.click("Find ways round")
    tab.see("longer than the shortest")
    tab.click("Plan a motion")
    tab.see("with a stop at every corner")
    tab.scroll_to("Shortest path")


def platforms(tab: Page) -> None:
    """The 3x3 platform for a stroke of 100 mm and its workspace."""
    tab.choose("Page", "Stewart platforms")
    tab.see("dexterity nu")
    tab.open("Workspace")
    tab.click("Survey")
    tab.see("lowest nu")
    tab.scroll_to("Workspace")


def comparisons(tab: Page) -> None:
    """Three methods on two cases: their figures."""
    from pin_metaik.compare import Suite, compare

    folder = Path(tab.folder) / "results"
    compare(
        Suite(("ur5", "panda"), ("random", "near_limit"), ("dls", "dls+restarts", "gwo+dls"), tasks=20, budget=2000),
        folder,
    )
    packed = tab.packed(folder)
    tab.choose("Page", "Comparisons")
    tab.dismiss()
    tab.send("Open a results folder: .zip", packed)
    tab.see("95 % interval")
    tab.scroll_to("Share solved within so many evaluations")


def information(tab: Page) -> None:
    """What the algorithms are."""
    tab.choose("Page", "Information")
    tab.choose("Subject", "Algorithm: pso")
    tab.see("Particle swarm")


SCENES: dict[str, Callable[[Page], None]] = {
    "arms": arms,
    "metaheuristics": metaheuristics,
    "paths": paths,
    "platforms": platforms,
    "comparisons": comparisons,
    "information": information,
}


def compressed(png: bytes) -> bytes:
    """A picture with a palette, small enough for the repository."""
    image = Image.open(io.BytesIO(png)).convert("RGB").quantize(COLOURS, method=Image.Quantize.MEDIANCUT)
    packed = io.BytesIO()
    image.save(packed, "PNG", optimize=True)
    if len(packed.getvalue()) > LARGEST:
        raise ValueError(f"a picture has {len(packed.getvalue()):,} bytes; at most {LARGEST:,} are wanted")
    return packed.getvalue()


def main(names: list[str]) -> None:
    """Take the pictures."""
    with open_toolbox(port=0) as toolbox, sync_playwright() as playwright:
        browser: Any = launched(playwright)
        tab = Page(browser, toolbox.url)
        for name in names or list(SCENES):
            SCENES[name](tab)
            time.sleep(REST)
            (IMAGES / f"toolbox_{name}.png").write_bytes(compressed(tab.page.screenshot()))
            print(f"{name}: asked {', '.join(sorted(filter(None, tab.asked)))}; {len(tab.faults)} faults", flush=True)
        tab.close()
        browser.close()


if __name__ == "__main__":
    main(sys.argv[1:])
