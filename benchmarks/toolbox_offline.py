"""The toolbox with the network cut off: server and Chromium where loopback is all there is; one page after the other.

    unshare --net --map-root-user sh -c 'ip link set lo up; python benchmarks/toolbox_offline.py'

Prints a line of JSON: the pages that were opened, hosts that were asked for anything, faults of scripts, and whether
anything but loopback could be reached.
"""

from __future__ import annotations

import json
import socket
from typing import Any

from playwright.sync_api import sync_playwright
from toolbox_browser import COARSE, Page, launched

from pin_metaik.gui import open_toolbox
from pin_metaik.gui.pages import PAGES

OUTSIDE = ("192.0.2.1", 80)  # an address that is kept for documentation (RFC 5737): even a route to it is too much
ANSWERS = {  # what an answer on a page has in it
    "arms": "SOLVED",
    "metaheuristics": "Examples of the paper",
    "paths": "SHORTEST",
    "platforms": "dexterity nu",
    "comparisons": "Send the folder",
    "information": "a page for teachers",
}


def reachable() -> bool:
    """Whether there is a way out of this machine."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        try:
            one.connect(OUTSIDE)
        except OSError:
            return False
    return True


def main() -> None:
    """Open every page, and wait for its answer."""
    opened = []
    with open_toolbox(port=0) as toolbox, sync_playwright() as playwright:
        browser: Any = launched(playwright)
        tab = Page(browser, toolbox.url + COARSE)
        for name, entry in PAGES.items():
            if name != next(iter(PAGES)):
                tab.choose("Page", entry.title)
            tab.see(ANSWERS[name])
            opened.append(name)
        asked, faults = sorted(filter(None, tab.asked)), len(tab.faults)
        tab.close()
        browser.close()
    print(json.dumps({"opened": opened, "asked": asked, "faults": faults, "reachable": reachable()}))


if __name__ == "__main__":
    main()
