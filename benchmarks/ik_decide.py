"""Every target solved or proved unreachable: how many, how quickly, and whether the proofs can be believed.

    python benchmarks/ik_decide.py [arms margins complete soundness shelf twice starts] [--targets 200] ...

Writes the sections named, default all, into the page, and leaves its others as they are; each says by which command it
was measured, when and on what machine. All questions go through ``solve_ik`` and ``solve_ik_batch``, one thread unless
said otherwise. Times are processor times.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path

from ik_decide_arms import arms, complete, margins, starts
from ik_decide_grasps import shelf, twice
from proof_soundness import KINDS, counted
from sections import conditions, page_with

TITLE = "# Every target solved or proved unreachable"


def soundness(options: argparse.Namespace) -> list[str]:
    """What ``proof_soundness.py`` counts."""
    lines = [
        "Feasible targets, and boxes that hold a known solution, on arms and configurations at their worst: see "
        "`benchmarks/proof_soundness.py`.",
        "",
        "| what | looked at | arms | called out of reach |",
        "|---|---:|---:|---:|",
    ]
    for kind, asked in KINDS.items():
        count = int(options.soundness if kind != "public" else options.soundness / 10)
        looked, wrong, drawn = counted(kind, count, options.workers, kept=options.kept_parts)
        lines.append(f"| {asked.title} | {looked:,} | {drawn:,} | {wrong} |")
    return lines


SECTIONS: dict[str, tuple[str, Callable[[argparse.Namespace], list[str]]]] = {
    "arms": ("Random orientations at reachable positions", arms),
    "margins": ("By margin", margins),
    "complete": ("All solutions", complete),
    "soundness": ("Whether a proof is ever wrong", soundness),
    "shelf": ("Grasps on a shelf", shelf),
    "twice": ("The same twice", twice),
    "starts": ("Seeds and generators", starts),
}


def main() -> None:
    """Measure the sections named and write them into the page, one after the other."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sections", nargs="*", choices=[[], *SECTIONS], metavar="SECTION", help=", ".join(SECTIONS))
    parser.add_argument("--targets", type=int, default=200, help="of each arm")
    parser.add_argument("--robots", nargs="*", help="of the sections arms and margins; default: all in their tables")
    parser.add_argument("--soundness", type=float, default=1e6, help="boxes and targets; a tenth through solve_ik")
    parser.add_argument("--grasps", type=int, default=300, help="of the section shelf")
    parser.add_argument("--again", type=int, default=200, help="grasps of the section twice")
    parser.add_argument("--workers", type=int, default=2, help="processes of soundness and of the dense scan")
    parser.add_argument("--kept-parts", type=Path, help="file that finished parts of soundness are kept in")
    parser.add_argument("--kept-scan", type=Path, help="file that verdicts of the dense scan are kept in")
    parser.add_argument("--out", type=Path, default=Path(__file__).with_suffix(".md"))
    options = parser.parse_args()
    for name in options.sections or SECTIONS:
        title, measure = SECTIONS[name]
        lines = [conditions(), "", *measure(options)]
        page = options.out.read_text(encoding="utf-8") if options.out.exists() else ""
        options.out.write_text(
            page_with(page, TITLE, [name for name, _ in SECTIONS.values()], title, lines), encoding="utf-8"
        )
        print(f"## {title}", *lines, sep="\n", flush=True)


if __name__ == "__main__":
    main()
