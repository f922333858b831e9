"""What is given as ``rng`` is a seed, a generator or None, everywhere."""

from collections.abc import Callable

import numpy as np
import pytest

import pin_metaik as mik
from pin_metaik.errors import InvalidSetting
from pin_metaik.randomness import as_generator
from tests.robots_under_test import chain_of

BOX = mik.Box([-1.0] * 2, [1.0] * 2)


def test_a_generator_is_kept_and_a_seed_gives_the_same_numbers() -> None:
    mine = np.random.default_rng(3)
    assert as_generator(mine) is mine
    assert as_generator(3).random() == as_generator(np.int64(3)).random()


@pytest.mark.parametrize("rng", [-1, 1.5, "seed"])
@pytest.mark.parametrize(
    "call",
    [
        lambda rng: mik.solve_ik(chain_of("ur5"), [0.3, 0.3, 0.3], rng=rng),
        lambda rng: mik.solve_ik(chain_of("ur5"), [0.3, 0.3, 0.3], solver=mik.IKSolver("gwo", None), rng=rng),
        lambda rng: mik.solve_ik_all(chain_of("ur5"), [0.3, 0.3, 0.3], rng=rng),
        lambda rng: mik.solve_ik_batch(chain_of("ur5"), [[0.3, 0.3, 0.3]], rng=rng),
        lambda rng: mik.minimize(lambda X: X.sum(axis=1), BOX, "gwo", mik.Budget(evaluations=100), rng=rng),
    ],
    ids=["solve", "seeder", "all", "batch", "minimize"],
)
def test_anything_else_is_told_apart(call: Callable[[object], object], rng: object) -> None:
    with pytest.raises(InvalidSetting, match=rf"Generator.* or None, got {rng!r}"):
        call(rng)
