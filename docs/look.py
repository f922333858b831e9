"""Look at the site as it is built: a picture of every page, light and dark, no request to another host, and the search.

python docs/look.py build/docs build/looks              # every page
python docs/look.py build/docs build/looks tasks        # those whose path holds a word

It needs playwright and a chromium. Exit code 1: a page asked another host for something, or a word is not found.
"""

from __future__ import annotations

import argparse
import functools
import http.server
import shutil
import sys
import threading
from pathlib import Path
from typing import Any

SEARCHED = {
    "calibrated": "calibrated_arms",
    "look at": "keep_an_axis",
    "unreachable": "proofs",
    "grasp": "list_of_grasps",
    "Dask": "cluster",
}
"""Words, and a page that the search must find for each."""
FOUND = "#search-results li a"
WIDTH, HEIGHT, TALLEST = 1280, 900, 2600  # pixels
PATIENCE = 180_000  # ms


def served(folder: Path) -> tuple[http.server.ThreadingHTTPServer, str]:
    """A server of a folder, and its address."""

    class Quiet(http.server.SimpleHTTPRequestHandler):
        def log_message(self, *_: Any) -> None:
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=str(folder)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return server, f"http://127.0.0.1:{server.server_port}"


def main() -> int:
    """Look; the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("site", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("word", nargs="?", default="")
    options = parser.parse_args()
    from playwright.sync_api import sync_playwright

    every = [page.relative_to(options.site) for page in sorted(options.site.rglob("*.html"))]
    skipped = {Path("index.html")}  # it leads to another page at once
    pages = [page for page in every if options.word in str(page) and page.parts[0] != "_static" and page not in skipped]
    options.out.mkdir(parents=True, exist_ok=True)
    server, address = served(options.site)
    strange: list[str] = []
    missed: list[str] = []
    with sync_playwright() as play:
        browser = play.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        for scheme in ("light", "dark"):
            context = browser.new_context(color_scheme=scheme, viewport={"width": WIDTH, "height": HEIGHT})
            context.set_default_timeout(PATIENCE)
            tab = context.new_page()
            tab.on(
                "request",
                lambda request: (
                    strange.append(request.url) if not request.url.startswith((address, "data:", "blob:")) else None
                ),
            )
            for place in pages:
                answer = tab.goto(f"{address}/{place}")
                if answer is None or not answer.ok:
                    raise SystemExit(f"{place} cannot be opened")
                tall = min(TALLEST, int(tab.evaluate("document.documentElement.scrollHeight")))
                name = f"{'_'.join(place.with_suffix('').parts)}_{scheme}.png"
                tab.screenshot(
                    path=options.out / name, clip={"x": 0, "y": 0, "width": WIDTH, "height": tall}, full_page=True
                )
            context.close()
        tab = browser.new_page()
        for words, wanted in SEARCHED.items():
            tab.goto(f"{address}/search.html?q={words.replace(' ', '+')}")
            tab.wait_for_selector(FOUND, timeout=PATIENCE)
            tab.wait_for_timeout(500)
            found = tab.eval_on_selector_all(FOUND, "links => links.map(link => link.getAttribute('href'))")
            place = next((i for i, link in enumerate(found, start=1) if wanted in link), None)
            missed += [words] if place is None else []
            print(f"search {words!r}: {len(found)} pages, {wanted} is number {place}")
        browser.close()
    server.shutdown()
    print(f"{len(pages)} pages in light and dark; requests to other hosts: {len(strange)}")
    for url in sorted(set(strange)):
        print("  ", url)
    return 1 if strange or missed else 0


if __name__ == "__main__":
    sys.exit(main())
