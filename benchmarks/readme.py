"""Write the README's table of comparison, from the page that ``ik_speed.py`` wrote.

python benchmarks/readme.py
"""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).parents[1]
README, PAGE = ROOT / "README.md", ROOT / "benchmarks" / "ik_speed.md"
BEGIN, END = "<!-- written by benchmarks/readme.py -->\n", "<!-- end -->"
FAMILIES = {"random": "random", "near-limit": "near the limits", "singular": "singular"}
NAMES = {
    "**pin_metaik**": "**pin_metaik**",
    "roboticstoolbox": "Robotics Toolbox, LM Chan (C++)",
    "placo": "placo (C++ QP)",
    "pytracik": "TRAC-IK (two threads)",
    "pink": "pink with daqp, restarted",
    "eaik": "EAIK (analytic)",
    "ik-geo": "ik-geo (analytic)",
}
"""By the name of a solver on the page, in this order."""


def rows_of(page: str, family: str) -> dict[str, dict[str, str]]:
    """The rows over all robots of a family of targets: by solver, by heading."""
    section = page.split(f"\n## {family}\n", 1)[1].split("\n## ", 1)[0]
    lines = [line for line in section.splitlines() if line.startswith("|")]
    headings, _, *rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    whole = [row for row in rows if len(row) == len(headings)]
    return {row[0]: dict(zip(headings, row, strict=True)) for row in whole}


def cell(row: dict[str, str]) -> str:
    """The share solved, the mean time, and how many times as long as ours that is."""
    solved = row["solved"].partition(" (")[0].replace("100.00 %", "100 %")
    times = float(row["x ours, of means"])
    longer = "" if times == 1.0 else f" ({times:.1f}x)" if times < 10 else f" ({times:.0f}x)"
    mean = float(row["mean us"])
    return f"{solved}, {mean:.1f} us{longer}" if mean < 100 else f"{solved}, {mean:,.0f} us{longer}"


def table(page: str) -> str:
    """The table, with the command, the date and the machine above it."""
    command, date, machine = re.search(r"^`(python \S+).*`, (\S+), (.*?), Python", page, re.MULTILINE).groups()  # type: ignore[union-attr]
    families = {family: rows_of(page, family) for family in FAMILIES}
    lines = [
        "| solver (number of arms, if not ten) | " + " | ".join(FAMILIES.values()) + " |",
        "|---|---|---|---|",
    ]
    for key, name in NAMES.items():
        arms = families["random"][key]["robots"]
        cells = " | ".join(cell(rows[key]) for rows in families.values())
        lines.append(f"| {name}{'' if arms == '10' else f', {arms} arms'} | {cells} |")
    lines += ["", f"`{command}` ([whole command and page](benchmarks/ik_speed.md)), {date}, {machine}."]
    return "\n".join(lines) + "\n"


def written(readme: str, page: str) -> str:
    """The README with the table of the page between its marks."""
    head, rest = readme.split(BEGIN, 1)
    return head + BEGIN + table(page) + END + rest.split(END, 1)[1]


if __name__ == "__main__":
    text = written(README.read_text(encoding="utf-8"), PAGE.read_text(encoding="utf-8"))
    README.write_text(text, encoding="utf-8")
