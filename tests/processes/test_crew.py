"""Work in processes that are held, stepped and ended."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import pytest

from pin_metaik.errors import InvalidSetting
from pin_metaik.processes import Crew, Order, Run, Stage, Told
from pin_metaik.watching import Progress, Watch

WAIT = 60.0  # s, of a machine that does other things as well


def count(to: int, watch: Watch) -> int:
    """Steps until the watch says stop."""
    for number in range(1, to + 1):
        if watch(Progress(number, to)) is True:
            return number
    return to


def deaf(watch: Watch) -> None:
    """Work that does not hear."""
    watch(Progress(1, 2))
    time.sleep(1000.0)


def wrong(watch: Watch) -> None:
    raise InvalidSetting("seven is no colour")


class Heard:
    """What was told of a run."""

    def __init__(self) -> None:
        self.steps: list[float] = []
        self.over = threading.Event()

    def tell(self, told: Told) -> None:
        self.steps.append(told.progress.done)

    def end(self, run: Run) -> None:
        self.over.set()

    def until(self, met: Callable[[], bool]) -> None:
        end = time.monotonic() + WAIT
        while not met():
            assert time.monotonic() < end, self.steps
            time.sleep(0.01)


@pytest.fixture(scope="module")
def crew() -> Iterator[Crew]:
    opened = Crew(2)
    yield opened
    opened.close()
    assert not opened.pids


def test_work_that_is_held_makes_a_step_at_a_time_and_gives_what_it_has_when_it_is_stopped(crew: Crew) -> None:
    heard = Heard()
    run = crew.begin(partial(count, 1000), heard.tell, heard.end, held=True)
    for steps in (1, 2, 3):
        heard.until(lambda steps=steps: len(heard.steps) == steps)  # type: ignore[misc]
        time.sleep(0.05)
        assert len(heard.steps) == steps
        run.order(Order.STEP)
    run.stop()
    assert heard.over.wait(WAIT)
    assert run.stage is Stage.DONE and run.result == heard.steps[-1] < 1000


def test_work_beyond_the_processes_waits_for_its_turn_and_one_that_waits_can_be_stopped(crew: Crew) -> None:
    heard = [Heard() for _ in range(4)]
    runs = [crew.begin(partial(count, 5), one.tell, one.end, held=True) for one in heard]
    heard[0].until(lambda: heard[0].steps != [] and heard[1].steps != [])
    assert [run.stage for run in runs] == [Stage.WORKING, Stage.WORKING, Stage.WAITING, Stage.WAITING]
    runs[3].stop()
    assert runs[3].stage is Stage.ENDED and heard[3].over.is_set()
    runs[2].order(Order.GO)
    for run in runs[:2]:
        run.order(Order.GO)
    assert all(one.over.wait(WAIT) for one in heard)
    assert [run.result for run in runs] == [5, 5, 5, None]
    assert len(crew.pids) == 2


def test_errors_of_work_come_back_as_they_are(crew: Crew) -> None:
    heard = Heard()
    run = crew.begin(wrong, heard.tell, heard.end)
    assert heard.over.wait(WAIT)
    assert run.stage is Stage.FAILED and isinstance(run.error, InvalidSetting) and "seven" in str(run.error)


def test_work_that_does_not_hear_is_ended_with_its_process_and_so_is_one_that_somebody_kills() -> None:
    crew = Crew(1)
    heard: list[Any] = [Heard(), Heard()]
    run = crew.begin(deaf, heard[0].tell, heard[0].end)
    heard[0].until(lambda: heard[0].steps == [1])
    (pid,) = crew.pids
    run.stop()
    assert heard[0].over.wait(WAIT) and run.stage is Stage.ENDED
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)
    lost = crew.begin(deaf, heard[1].tell, heard[1].end)
    heard[1].until(lambda: heard[1].steps == [1])
    os.kill(crew.pids[-1], signal.SIGKILL)
    assert heard[1].over.wait(WAIT)
    assert lost.stage is Stage.FAILED and "ended from outside" in str(lost.error)
    crew.close()
    assert not crew.pids
