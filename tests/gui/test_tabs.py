"""Tabs without a browser: answers that follow, sessions that do not disturb each other, attacks, and what is left."""

from __future__ import annotations

import io
import logging
import resource
import time
import zipfile
from pathlib import Path
from typing import Any
from urllib.error import HTTPError
from urllib.request import Request, urlopen

import numpy as np
import pinocchio as pin
import pytest

import pin_metaik as mik
from pin_metaik.gui import open_toolbox
from pin_metaik.gui.kept import to_address
from pin_metaik.gui.uploads import MOST
from tests.gui.conftest import benchmark

DOWN = (0.0, 1.0, 0.0, 0.0)  # quaternion w, x, y, z
TARGET, ROBOT = "/page/target", "/page/robot/"
MANY = 50  # tabs
QUICK = 0.05  # s, from a frame of the target to the answer
HZ, SECONDS = 20, 5.0


@pytest.fixture(autouse=True)
def no_stumble(caplog: pytest.LogCaptureFixture) -> Any:
    """Nothing that is sent or clicked is a fault of the toolbox."""
    with caplog.at_level(logging.ERROR):
        yield
    assert [record.getMessage() for record in caplog.records if record.name.startswith("pin_metaik")] == []


def archive(name: str, data: bytes) -> bytes:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as made:
        made.writestr(name, data)
    return content.getvalue()


def pulled(tab: Any, place: tuple[float, float, float]) -> tuple[float, float]:
    """Drag the target, and wait until the robot has moved: the time between on the clock and of the processor, s."""
    before, clock, processor = len(tab.moved), time.perf_counter(), time.process_time()
    tab.drag(TARGET, place, DOWN)
    tab.wait_until(lambda: any(name.startswith(ROBOT) for name, _ in tab.moved[before:]))
    return time.perf_counter() - clock, time.process_time() - processor


def test_the_answer_follows_a_dragged_target_and_memory_does_not_grow(socket: Any) -> None:
    socket.see("SOLVED")
    for k in range(30):
        pulled(socket, (0.4 + 0.002 * k, 0.1, 0.5))
    before, times = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, []
    for k in range(int(HZ * SECONDS)):
        angle = 2.0 * np.pi * k / (HZ * SECONDS)
        took = pulled(socket, (0.45 + 0.1 * np.cos(angle), 0.2 * np.sin(angle), 0.5))
        times.append(took)
        time.sleep(max(0.0, 1.0 / HZ - took[0]))
    grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before  # KiB; both ends of the socket are in it
    clock, processor = np.array(times).T
    assert clock.min() <= QUICK and np.median(processor) <= QUICK  # a machine that is busy keeps answers waiting
    assert grown < 8 * 1024


def test_the_answer_is_the_librarys_and_says_why_there_is_none(socket: Any) -> None:
    robot = mik.load_robot("panda")
    chain = mik.Chain(robot.model, robot.frame)
    socket.see("SOLVED")
    for place, status in (((0.5, 0.1, 0.4), "SOLVED"), ((0.4, 0.1, 3.0), "UNREACHABLE")):
        socket.drag(TARGET, place, DOWN)
        socket.wait_until(lambda status=status: any(f"**{status}**" in str(v) for v in socket.values.values()))
        result = mik.solve_ik(chain, pin.SE3(np.diag([1.0, -1.0, -1.0]), np.array(place)))
        assert str(result.status) == status
    words = socket.text("UNREACHABLE")
    assert result.why in words and f"**Proved:** {result.proof}" in words
    socket.set("Find all", True)
    socket.see("0 solutions")


def test_a_typed_table_redraws_the_robot_and_nonsense_is_told_in_words(socket: Any) -> None:
    socket.see("SOLVED")
    socket.set("Type a table", True)
    socket.find("a, alpha, d")
    socket.see("SOLVED")
    socket.set("a, alpha, d", (0.5, 0.0, 0.25))
    socket.wait_until(lambda: socket.value("x, y, z, m") is not None)
    socket.set("zero, lower, upper", (0.0, 10.0, -10.0))
    socket.told("limits are crossed")
    socket.set("Page", "Information")
    socket.find("Subject")
    socket.set("Page", "Arms")
    socket.find("a, alpha, d")  # the table is still there


BOMB = archive("a.urdf", b"\0" * (1 << 27))
ROBOTS = {
    "big.urdf": (b" " * (MOST + 1), "at most 16 MiB"),
    "broken.urdf": (b"<robot name='x'><link", ""),
    "laughs.urdf": (
        b"<!DOCTYPE r [<!ENTITY a 'aa'><!ENTITY b '&a;&a;'>]><robot name='&b;'><link name='l'/></robot>",
        "",
    ),
    "reads.urdf": (
        b"<robot name='x'><link name='a'/><link name='b'><visual><geometry><mesh filename='/etc/passwd'/></geometry>"
        b"</visual></link><joint name='j' type='revolute'><parent link='a'/><child link='b'/><axis xyz='0 0 1'/>"
        b"<limit lower='-1' upper='1' velocity='1' effort='1'/></joint></robot>",
        "outside of what was uploaded",
    ),
    "wrong.toml": (b"name = 'x'\nconvention = 'sideways'", ""),
    "no.exe": (b"MZ", "neither one of .urdf"),
    "bomb.zip": (BOMB, "larger than 64 MiB"),
    "climbs.zip": (archive("../a.urdf", b"<robot/>"), "reaches out"),
}
MAPS = {
    "broken.geojson": (b"{", ""),
    "deep.geojson": (b"[" * 100_000, ""),
    "nan.geojson": (b'{"type": "Polygon", "coordinates": [[[0, 0], [NaN, 1], [1, 1]]]}', ""),
    "map.yaml": (b"image: /etc/passwd\nresolution: 1\norigin: [0, 0, 0]\nnegate: 0\n", "outside of what was uploaded"),
    "many.yaml": (b"a: &a [x, x]\nb: &b [*a, *a]\nimage: [*b, *b]\n", ""),
}


def test_malformed_and_hostile_files_are_told_in_words_and_the_page_goes_on(socket: Any) -> None:
    socket.see("SOLVED")
    for button, page, files in (
        ("Open a URDF, an MJCF or a table", "Arms", ROBOTS),
        ("Open a map: GeoJSON, ROS, scene", "Path planning", MAPS),
    ):
        socket.set("Page", page)
        socket.find(button)
        for name, (content, words) in files.items():
            before = len(socket.notes)
            socket.send_file(button, name, content)
            socket.wait_until(lambda before=before: len(socket.notes) > before)
            text = socket.notes[-1][1]
            assert words in text and "fault of the toolbox" not in text and "Traceback" not in text, (name, text)
    socket.set("Page", "Arms")
    socket.see("SOLVED")


def test_a_state_in_an_address_opens_its_page_and_a_damaged_one_opens_the_first(toolbox: Any) -> None:
    sockets = benchmark("toolbox_socket")
    address = to_address("information", {"information": {"subject": "Algorithm: ga"}})
    for path, text in ((address, "Genetic algorithm"), ("/state/abc", "SOLVED")):
        tab = sockets.SocketTab(toolbox.url.rstrip("/") + path)
        tab.see(text)
        assert bool(tab.notes) == (path != address)
        tab.close()


def test_other_sites_and_paths_out_of_the_page_are_refused(toolbox: Any) -> None:
    for path, headers, status in (
        ("", {"Host": "evil.example"}, 403),
        ("", {"Origin": "http://evil.example"}, 403),
        ("../../etc/passwd", {}, 404),
        ("%2e%2e/%2e%2e/etc/passwd", {}, 404),
    ):
        with pytest.raises(HTTPError) as refused:
            urlopen(Request(toolbox.url + path, headers=headers), timeout=20)
        assert refused.value.code == status
        refused.value.close()


def test_a_run_goes_step_by_step_and_on(socket: Any, toolbox: Any) -> None:
    socket.set("Page", "Metaheuristics at work")
    socket.find("Run both side by side")
    socket.set("Iterations", 20)
    (session,) = toolbox.tabs.values()

    def evaluations() -> list[float]:
        return list(session.page._records[-1].evaluations) if session.page._records else []

    for steps in (1, 2, 3):
        socket.set("Going", "Step")  # the first begins a run that is held
        socket.wait_until(lambda steps=steps: len(evaluations()) >= steps)
        assert len(evaluations()) == steps
    socket.set("Going", "Go on")
    socket.see("by the exact test")


def test_a_tab_that_is_closed_ends_its_run_and_a_run_that_is_stopped_gives_its_best(toolbox: Any) -> None:
    sockets = benchmark("toolbox_socket")
    for stopped in (True, False):
        tab = sockets.SocketTab(toolbox.url)
        tab.set("Page", "Metaheuristics at work")
        tab.find("Run both side by side")
        tab.set("Iterations", 1_000_000)
        tab.set("Run", True)
        tab.see("goes on")
        assert toolbox.busy == 1
        if stopped:
            tab.set("Going", "Stop")
            tab.see("by the exact test")
            assert toolbox.busy == 0
        tab.close()
        end = time.monotonic() + 60.0
        while toolbox.busy or toolbox.tabs:
            assert time.monotonic() < end
            time.sleep(0.05)


def test_many_tabs_have_pages_of_their_own_and_leave_nothing() -> None:
    sockets = benchmark("toolbox_socket")
    with open_toolbox(port=0) as many:
        tabs = [sockets.SocketTab(many.url) for _ in range(MANY)]
        for tab in tabs:
            tab.see("SOLVED")
        folders = [tab.folder for tab in many.tabs.values()]
        assert len(set(folders)) == MANY and all(folder.is_dir() for folder in folders)
        pulled(tabs[0], (0.5, 0.1, 0.4))
        assert not any(
            name.startswith(ROBOT) for tab in tabs[1:] for name, at in tab.moved[-1:] if at > tabs[0].moved[-1][1]
        )
        tabs[0].set("Page", "Information")
        tabs[0].find("Subject")
        assert "Subject" not in tabs[1].labels.values()
        pids = many.pids
    assert not any(folder.exists() for folder in folders)
    assert not any(Path(f"/proc/{pid}").exists() for pid in pids)
    for tab in tabs:
        tab.close()
