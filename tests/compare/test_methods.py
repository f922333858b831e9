"""Methods: every one keeps its budget and the limits, and gives the same answer for the same seed."""

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import pin_metaik as mik
from pin_metaik.compare import METHODS, Method, Search
from pin_metaik.compare.methods import named
from pin_metaik.compare.methods.cost import FK_WITH_JACOBIAN, evaluations_of, steps_within
from pin_metaik.compare.methods.counted import Counted
from pin_metaik.errors import MissingExtra, UnknownName
from pin_metaik.ik.refine import make_refiner
from pin_metaik.optimize.gwo import GWO
from tests.robots_under_test import chain_of

ALONE = [*mik.REFINERS, *mik.ALGORITHMS, "default", "default_nearest"]
TOGETHER = ["lm+restarts", "dls+restarts", "qp+restarts", "gwo+dls", "mtde+qp", "sfla+lm", "mtde@60+dls", "gwo@31+lm"]
PEERS = ["ikpy", "pink"]


def problem_of(robot: str, seed: int) -> mik.IKProblem:
    chain = chain_of(robot)
    x = chain.box.sample(np.random.default_rng(seed), 1)[0]
    return mik.IKProblem.of(chain, chain.placements(chain.q(x))[0])


@pytest.mark.parametrize("name", [*ALONE, *TOGETHER, *PEERS])
def test_a_method_keeps_its_budget_and_the_limits_and_repeats_itself(name: str) -> None:
    if name in PEERS:
        pytest.importorskip(name)
    method = named(name)
    assert isinstance(method, Method) and method.name == name
    for budget in (1, 40, 333):
        problem = problem_of("panda", budget)
        x0 = problem.box.sample(np.random.default_rng(99), 1)[0]
        one, again = (method.solve(problem, x0.copy(), budget, np.random.default_rng(5)) for _ in range(2))
        assert one.evaluations is not None and 0 <= one.evaluations <= budget
        assert problem.limits.contains(one.x)
        assert_array_equal(one.x, again.x)
        assert (one.evaluations, one.status) == (again.evaluations, again.status)
        assert one.claimed == problem.accepts(problem.chain.q(one.x))


@pytest.mark.parametrize(
    "name", ["lm+restarts", "dls+restarts", "qp+restarts", "mtde+dls", "gwo@60+dls", "default", *PEERS]
)
def test_those_that_should_solve_a_random_pose_do(name: str) -> None:
    if name in PEERS:
        pytest.importorskip(name)
    for seed in range(3):
        problem = problem_of("ur5", seed)
        x0 = problem.box.sample(np.random.default_rng(99), 1)[0]
        answer = named(name).solve(problem, x0, 5000, np.random.default_rng(seed))
        assert answer.claimed and problem.accepts(problem.chain.q(answer.x))


def test_data_the_price_of_a_jacobian_is_the_one_that_was_measured() -> None:
    assert 1.16 <= FK_WITH_JACOBIAN <= 1.2  # benchmarks/kernel_costs.py


def test_no_budget_is_overdrawn_by_the_steps_it_pays_for() -> None:
    assert [evaluations_of(steps) for steps in (0, 1, 2, 3, 5)] == [0, 2, 3, 4, 6]
    assert all(evaluations_of(steps_within(budget)) <= budget for budget in range(1, 200))


def test_a_refiner_gets_what_its_budget_pays_for_and_a_rest_is_written_off() -> None:
    problem, refiner = problem_of("ur5", 0), make_refiner("lm_chan")
    starts = problem.box.sample(np.random.default_rng(0), 1)
    plain, priced = refiner.refine(problem, starts, 10), Counted(refiner).refine(problem, starts, 12)
    assert_array_equal(priced.x, plain.x)
    assert priced.evaluations == evaluations_of(plain.evaluations)
    broke = Counted(refiner).refine(problem, starts, 1)
    assert (broke.met, broke.evaluations) == (False, 1)


def test_a_metaheuristic_alone_keeps_its_convergence() -> None:
    problem = problem_of("ur5", 1)
    answer = METHODS["gwo"].solve(problem, np.zeros(6), 300, np.random.default_rng(0))
    assert answer.trace is not None and answer.trace[-1, 0] == 300
    assert (np.diff(answer.trace[:, 1]) <= 0.0).all()


def test_a_metaheuristic_of_ones_own_is_a_method_with_one_line() -> None:
    mine = Search("mine", GWO(agents=10), "dls")
    assert isinstance(mine, Method)
    answer = mine.solve(problem_of("ur5", 2), np.zeros(6), 3000, np.random.default_rng(0))
    assert answer.claimed


def test_unknown_methods_are_told_what_there_is() -> None:
    for name in ("gvo+dls", "gwo@x+dls", "gwo@10", "gwo@10+dsl"):
        with pytest.raises(UnknownName, match="no method named"):
            named(name)


def test_a_peer_that_is_not_there_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pin_metaik.lookup.find_spec", lambda name: None)
    with pytest.raises(MissingExtra, match=r"pip install .*\[roboticstoolbox\]'"):
        METHODS["toolbox"].need()  # type: ignore[attr-defined]
