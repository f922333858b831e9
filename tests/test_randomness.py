"""What is given as ``rng`` is a seed, a generator or None, everywhere."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import pin_metaik as mik
from pin_metaik import learn, mobile
from pin_metaik.errors import InvalidSetting
from pin_metaik.randomness import as_generator, as_seed
from tests.robots_under_test import chain_of

BOX = mik.Box([-1.0] * 2, [1.0] * 2)
FEW = mik.Budget(evaluations=200)


def test_a_generator_is_kept_and_a_seed_gives_the_same_numbers() -> None:
    mine = np.random.default_rng(3)
    assert as_generator(mine) is mine
    assert as_generator(3).random() == as_generator(np.int64(3)).random()


@pytest.mark.parametrize("rng", [None, 0], ids=["None", "the fixed seed"])
def test_none_is_one_fixed_seed_in_the_whole_house(rng: int | None) -> None:
    found = mik.minimize(half, BOX, "de", FEW, rng)
    assert_array_equal(found.x, mik.minimize(half, BOX, "de", FEW, 0).x)
    points = np.random.default_rng(1).random((50, 2))
    same = learn.fuzzy_c_means(points, 3, rng=0)
    assert_array_equal(learn.fuzzy_c_means(points, 3, rng=rng).centres, same.centres)
    assert mobile.plan_path(mobile.load_scene("ten_obstacles"), "de", budget=FEW, rng=rng).seed == 0


def half(X: np.ndarray) -> np.ndarray:
    """Costs (k,) of points (k, n)."""
    return np.square(X).sum(axis=1)


@pytest.mark.parametrize("bits", [np.random.PCG64, np.random.Philox, np.random.SFC64])
def test_a_generator_gives_62_bits_as_a_seed(bits: Callable[[int], np.random.BitGenerator]) -> None:
    mine, same = np.random.Generator(bits(3)), np.random.Generator(bits(3))
    assert [as_seed(mine) for _ in range(9)] == [int(same.integers(2**62)) for _ in range(9)]
    assert (as_seed(None), as_seed(7), as_seed(np.int64(7))) == (None, 7, 7)


@pytest.mark.parametrize("robot", ["ur5", "panda"])
def test_a_generator_is_one_draw_on_whatever_is_asked(robot: str) -> None:
    chain = chain_of(robot)
    easy = chain.poses(chain.box.sample(np.random.default_rng(0), 1))[0, 0]
    turned, far = easy.copy(), easy.copy()
    turned[:3, :3] = turned[:3, :3].T
    far[:3, 3] *= 100.0
    few = mik.IKSolver(budget=mik.Budget(evaluations=2_000))
    for goal in easy, turned, far:
        mine, same = np.random.default_rng(5), np.random.default_rng(5)
        result = mik.solve_ik(chain, goal, solver=few, rng=mine)
        assert result.q.tolist() == mik.solve_ik(chain, goal, solver=few, rng=int(same.integers(2**62))).q.tolist()
        assert mine.random() == same.random()


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
