"""What the toolbox costs: its size, its start, a target dragged for a minute, many tabs; writes toolbox.md.

    python benchmarks/toolbox.py [--seconds 60] [--tabs 50] [--out benchmarks/toolbox.md]

Times of answers are from a frame of the target on the socket to the robot's new pose on it, both in one process.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import re
import subprocess
import sys
import time
from datetime import date
from importlib import metadata
from pathlib import Path

import numpy as np
from toolbox_socket import SocketTab

from pin_metaik.gui import open_toolbox

HZ = 20  # updates a second of a target that is dragged
DOWN = (0.0, 1.0, 0.0, 0.0)
TARGET, ROBOT = "/page/target", "/page/robot/"
PAGE = os.sysconf("SC_PAGE_SIZE") if hasattr(os, "sysconf") else 4096
START = """
import sys, time
clock, processor = time.perf_counter(), time.process_time()
{}
print(time.perf_counter() - clock, time.process_time() - processor, "viser" in sys.modules)
"""


def requirements(name: str, extra: str = "") -> set[str]:
    """The packages that a package needs, with all that these need; None of them for an extra that is not asked for."""
    found: set[str] = set()
    todo = [(name, extra)]
    while todo:
        package, wanted = todo.pop()
        try:
            lines = metadata.requires(package) or []
        except metadata.PackageNotFoundError:
            continue
        for line in lines:
            marker = re.search(r'extra == ["\']([\w-]+)["\']', line)
            if marker and marker[1] != wanted:
                continue
            match = re.match(r"([\w.-]+)(?:\[([\w,-]+)\])?", line)
            if match is None:
                continue
            needed = match[1].lower().replace("_", "-")
            inner = (match[2] or "").split(",")
            if needed not in found or match[2]:
                found.add(needed)
                todo += [(match[1], each) for each in inner]
    return found - {"pin-metaik"}


def megabytes(package: str) -> float:
    """What a package takes on disk, MB."""
    try:
        files = metadata.files(package) or []
    except metadata.PackageNotFoundError:
        return 0.0
    return sum(Path(str(each.locate())).stat().st_size for each in files if Path(str(each.locate())).is_file()) / 1e6


def size_of_extra() -> tuple[float, float]:
    """MB of what the extra adds, and MB of viser alone."""
    base = requirements("pin-metaik")
    added = requirements("pin-metaik", "toolbox") | requirements("viser") | {"viser", "trimesh", "pycollada", "pillow"}
    return sum(map(megabytes, added - base)), megabytes("viser")


def measured(code: str) -> tuple[float, float, bool]:
    """Seconds on the clock and of the processor of some code in a fresh process, and whether it imports viser."""
    done = subprocess.run([sys.executable, "-c", START.format(code)], capture_output=True, text=True, check=True)
    clock, processor, imported = done.stdout.splitlines()[0].split()
    return float(clock), float(processor), imported == "True"


def cut_off() -> str:
    """Every page opened in Chromium, with server and browser in a network namespace that has loopback alone."""
    child = f"ip link set lo up && exec {sys.executable} {Path(__file__).with_name('toolbox_offline.py')}"
    done = subprocess.run(["unshare", "--net", "--map-root-user", "sh", "-c", child], capture_output=True, text=True)
    if done.returncode:
        return f"not run here: {(done.stderr.strip().splitlines() or ['no reason given'])[-1]}"
    seen = json.loads(done.stdout.splitlines()[-1])
    found = f"{len(seen['opened'])} pages answered, asked {', '.join(seen['asked'])}, {seen['faults']} faults"
    return found + ("; there was a way out" if seen["reachable"] else "; no way out")


def resident() -> float:
    """Memory of this process, MB."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * PAGE / 1e6


def pulled(tab: SocketTab, place: tuple[float, float, float]) -> tuple[float, float]:
    """Drag the target, and wait until the robot has moved: the time between on the clock and of the processor, s."""
    before, clock, processor = len(tab.moved), time.perf_counter(), time.process_time()
    tab.drag(TARGET, place, DOWN)
    tab.wait_until(lambda: any(name.startswith(ROBOT) for name, _ in tab.moved[before:]))
    return time.perf_counter() - clock, time.process_time() - processor


def dragged(tab: SocketTab, seconds: float) -> tuple[list[tuple[float, float]], list[float]]:
    """Times from a frame to its answer, and the memory in MB each second, of a target that goes round."""
    times, memory = [], [resident()]
    end, number = time.perf_counter() + seconds, 0
    while time.perf_counter() < end:
        angle = 2.0 * np.pi * number / (4 * HZ)
        began = time.perf_counter()
        times.append(pulled(tab, (0.45 + 0.1 * np.cos(angle), 0.2 * np.sin(angle), 0.5)))
        number += 1
        if number % HZ == 0:
            memory.append(resident())
            tab.moved.clear()
        time.sleep(max(0.0, 1.0 / HZ - (time.perf_counter() - began)))
    return times, memory


def in_ms(times: list[float]) -> str:
    """Quantiles of times in s."""
    least, median, most = (1e3 * np.quantile(times, share) for share in (0.05, 0.5, 0.95))
    return f"5 % {least:.1f} ms, median {median:.1f} ms, 95 % {most:.1f} ms"


def main(argv: list[str] | None = None) -> None:
    """Measure and write."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--tabs", type=int, default=50)
    parser.add_argument("--out", type=Path, default=Path(__file__).with_suffix(".md"))
    chosen = parser.parse_args(argv)
    alone = measured("import pin_metaik")
    start = measured("from pin_metaik.gui import open_toolbox; box = open_toolbox(port=0)")
    extra, viser = size_of_extra()
    offline = cut_off()
    with open_toolbox(port=0) as toolbox:
        clock, processor = time.perf_counter(), time.process_time()
        tab = SocketTab(toolbox.url)
        tab.find("Code")
        page = time.perf_counter() - clock, time.process_time() - processor
        tab.see("SOLVED")
        dragged(tab, 5.0)
        times, memory = dragged(tab, chosen.seconds)
        clock, processor = time.perf_counter(), time.process_time()
        others = [SocketTab(toolbox.url) for _ in range(chosen.tabs)]
        for other in others:
            other.see("SOLVED")
        many = time.perf_counter() - clock, time.process_time() - processor
        crowded = [pulled(tab, (0.45, 0.01 * k, 0.5)) for k in range(20)]
        for each in (tab, *others):
            each.close()
        pids = toolbox.pids
    left = sum(Path(f"/proc/{pid}").exists() for pid in pids)
    half = len(memory) // 2
    rows = [
        ("`import pin_metaik`", f"{alone[1]:.2f} s of the processor; imports viser: {alone[2]}"),
        ("import and start, until it listens", f"{start[1]:.2f} s of the processor, {start[0]:.2f} s on the clock"),
        ("first page, from the socket on", f"{page[1]:.2f} s of the processor, {page[0]:.2f} s on the clock"),
        ("the extra on disk", f"{extra:.0f} MB beyond the package's own needs, {viser:.1f} MB of it viser"),
        (f"target dragged for {chosen.seconds:g} s", f"{len(times) / chosen.seconds:.1f} answers a second"),
        ("frame to answer, on the clock", in_ms([clock for clock, _ in times])),
        ("frame to answer, of the processor, both ends", in_ms([processor for _, processor in times])),
        ("memory in the second half of it", f"{max(memory[half:]) - max(memory[:half]):+.1f} MB"),
        (f"{chosen.tabs} tabs more", f"{many[1]:.1f} s of the processor, {many[0]:.1f} s on the clock"),
        ("frame to answer among them, of the processor", in_ms([processor for _, processor in crowded])),
        ("with the network cut off, in Chromium", offline),
        ("processes left when it is closed", f"{left} of {len(pids)}"),
    ]
    load = os.getloadavg()[0]
    command = " ".join(["python benchmarks/toolbox.py", *(argv or sys.argv[1:])])
    lines = [
        "# What the toolbox costs",
        "",
        f"`{command}`, {date.today()}, {os.cpu_count()}-core {platform.machine()} at a load of {load:.0f}, "
        f"Python {platform.python_version()}, viser {metadata.version('viser')}.",
        "",
        "| what | measured |",
        "|---|---|",
        *(f"| {what} | {value} |" for what, value in rows),
        "",
        "A frame is a message of a dragged target on the socket, and its answer the robot's new pose there: viser's",
        "server, the gate, the tab's thread and the library are between them, and no browser. Memory is of the process",
        "that serves; the tabs are in it, too.",
    ]
    chosen.out.write_text("\n".join(lines) + "\n", encoding="utf-8")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
