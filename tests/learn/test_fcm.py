import numpy as np
import pytest
import skfuzzy
from numpy.testing import assert_allclose

from pin_metaik.errors import InvalidSetting
from pin_metaik.learn import fcm, fuzzy_c_means, memberships


def three_clusters(rng):
    means = np.array([(0, 0), (4, 1), (1, 5)], dtype=float)
    return np.concatenate([mean + 0.5 * rng.standard_normal((40, 2)) for mean in means])


def textbook(Z, centres, m, iterations):
    """Bezdek's two steps with the whole membership matrix, as toolboxes write them."""
    history = []
    for _ in range(iterations):
        d = np.linalg.norm(Z[None] - centres[:, None], axis=2)  # (c, n)
        U = 1 / ((d[:, None] / d[None]) ** (2 / (m - 1))).sum(axis=1)
        history.append((U**m * d**2).sum())
        centres = (U**m @ Z) / (U**m).sum(axis=1, keepdims=True)
    return centres, np.array(history)


@pytest.mark.parametrize("m", [2.0, 1.5, 3.0])
def test_centres_and_objective_are_the_textbooks(m):
    Z = three_clusters(np.random.default_rng(0))
    start = Z[[0, 50, 100]] + 0.01
    found = fuzzy_c_means(Z, 3, m=m, start=start, iterations=40, tolerance=0)
    centres, history = textbook(Z, start, m, len(found.objective))
    assert_allclose(found.centres, centres, atol=1e-9)
    assert_allclose(found.objective, history, rtol=1e-9)


def test_on_three_clusters_any_start_finds_the_same_centres():
    Z = three_clusters(np.random.default_rng(1))
    reference, _ = textbook(Z, np.array([(0.1, 0), (4, 1), (1, 5)], dtype=float), 2.0, 300)
    for seed in range(5):
        found = fuzzy_c_means(Z, 3, rng=seed, tolerance=1e-9)
        assert found.converged
        order = [np.linalg.norm(found.centres - c, axis=1).argmin() for c in reference]
        assert_allclose(found.centres[order], reference, atol=1e-4)


@pytest.mark.parametrize("m", [2.0, 1.5])
def test_on_three_clusters_the_centres_are_those_of_scikit_fuzzy(m):
    Z = three_clusters(np.random.default_rng(1))
    reference, *_ = skfuzzy.cmeans(Z.T, 3, m, error=1e-9, maxiter=1000, seed=0)
    found = fuzzy_c_means(Z, 3, m=m, tolerance=1e-9)
    order = [np.linalg.norm(found.centres - c, axis=1).argmin() for c in reference]
    assert_allclose(found.centres[order], reference, atol=1e-4)


@pytest.mark.parametrize("m", [2.0, 1.3])
def test_the_objective_never_rises_and_memberships_sum_to_one(m):
    Z = np.random.default_rng(2).random((500, 3))
    found = fuzzy_c_means(Z, 20, m=m, iterations=60, rng=3)
    assert (np.diff(found.objective) <= 1e-12 * found.objective[:-1]).all()
    U = memberships(Z, found.centres, m)
    assert U.shape == (20, 500)
    assert_allclose(U.sum(axis=0), 1, atol=1e-12)
    assert (U >= 0).all()


def test_the_size_of_the_pieces_does_not_matter(monkeypatch):
    Z = np.random.default_rng(4).random((300, 2))
    whole = fuzzy_c_means(Z, 10, iterations=20)
    monkeypatch.setattr(fcm, "CHUNK", 50)
    assert_allclose(fuzzy_c_means(Z, 10, iterations=20).centres, whole.centres, atol=1e-12)


def test_points_that_lie_on_a_centre_belong_to_it():
    Z = np.array([(0.0, 0), (0, 0), (1, 1), (1, 1)])
    found = fuzzy_c_means(Z, 2, start=[(0.0, 0), (1, 1)])
    assert np.isfinite(found.centres).all()
    assert_allclose(memberships(Z, found.centres), [[1, 1, 0, 0], [0, 0, 1, 1]], atol=1e-12)


def test_the_same_seed_gives_the_same_centres_and_a_run_can_go_on():
    Z = np.random.default_rng(5).random((200, 2))
    assert np.array_equal(fuzzy_c_means(Z, 8, rng=1).centres, fuzzy_c_means(Z, 8, rng=1).centres)
    half = fuzzy_c_means(Z, 8, iterations=10, rng=1, tolerance=0)
    rest = fuzzy_c_means(Z, 8, iterations=10, start=half.centres, tolerance=0)
    assert_allclose(rest.centres, fuzzy_c_means(Z, 8, iterations=20, rng=1, tolerance=0).centres, atol=1e-12)


def test_ctrl_c_goes_through_with_the_centres_so_far():
    def stop(at):
        if at.done == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt) as press:
        fuzzy_c_means(np.random.default_rng(0).random((100, 2)), 5, watch=stop)
    found = press.value.result
    assert found.interrupted
    assert len(found.objective) == 3


@pytest.mark.parametrize(
    ("Z", "clusters", "more"),
    [
        ([1, 2, 3], 2, {}),
        ([[1, np.nan]], 1, {}),
        ([["a"]], 1, {}),
        ([[1.0], [2.0]], 3, {}),
        ([[1.0], [2.0]], 0, {}),
        ([[1.0], [2.0]], 2, {"m": 1.0}),
        ([[1.0], [2.0]], 2, {"iterations": 0}),
        ([[1.0], [2.0]], 2, {"tolerance": -1.0}),
        ([[1.0], [2.0]], 2, {"start": [[1.0]]}),
    ],
)
def test_nonsense_is_refused(Z, clusters, more):
    with pytest.raises(InvalidSetting):
        fuzzy_c_means(Z, clusters, **more)
