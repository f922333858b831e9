"""One protocol to watch long work and to end it, for everything that takes long."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import pin_metaik as mik
from pin_metaik import learn, mobile, stewart
from pin_metaik.interrupts import Interrupted
from pin_metaik.watching import Progress, Watch

RNG = np.random.default_rng(0)
X = RNG.uniform(-1.0, 1.0, (60, 2))
Y = X[:, 0] * X[:, 1]


def small_design(watch: Watch) -> Any:
    return stewart.design(stewart.load_mechanism("stroke_50"), watch=watch)


WORK: dict[str, Callable[[Watch], Any]] = {
    "minimize": lambda watch: mik.minimize(
        lambda Q: (Q**2).sum(axis=1), mik.Box([-1, -1], [1, 1]), "gwo", mik.Budget(evaluations=3000), watch=watch
    ),
    "fit": lambda watch: learn.fit(X, Y, (3,), iterations=200, watch=watch).training,
    "fuzzy_c_means": lambda watch: learn.fuzzy_c_means(X, 3, watch=watch),
    "plan_path": lambda watch: mobile.plan_path(mobile.load_scene("ten_obstacles"), "pso", watch=watch),
    "design": small_design,
}


@pytest.mark.parametrize("name", WORK)
def test_a_watch_hears_how_far_work_is_and_ends_it_with_what_was_found(name: str) -> None:
    heard: list[Progress] = []

    def watch(at: Progress) -> bool:
        heard.append(at)
        return len(heard) == 3

    found = WORK[name](watch)
    assert len(heard) == 3
    assert all(0 < at.done <= at.total for at in heard)
    assert [at.done for at in heard] == sorted(at.done for at in heard)
    assert all(at.best is not None for at in heard)
    interrupted = found.status is mik.optimize.Status.INTERRUPTED if name == "minimize" else found.interrupted
    assert interrupted


@pytest.mark.parametrize("name", WORK)
def test_ctrl_c_in_a_watch_is_still_one(name: str) -> None:
    def press(at: Progress) -> None:
        raise KeyboardInterrupt

    with pytest.raises(Interrupted) as stop:
        WORK[name](press)
    assert type(stop.value) is Interrupted
    assert stop.value.result is not None
