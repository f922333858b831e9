import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

from pin_metaik.compare.papers import Options
from pin_metaik.compare.papers.aerial_arm import effort, inconsistent, rows, sections, sfla
from pin_metaik.compare.papers.aerial_arm_setup import CM, ROWS, SIGMA, G, J, arm, case, differences, poses, total_error
from pin_metaik.compare.papers.arm import hybrid

ROW_1 = np.array([[-15.7365, 5.43, 52.57, 6.63, 12.66, 16.164]])  # printed poses, cm and degrees
ROW_2 = np.array([[-21.183, 2.915, 50.77, -0.201, 10.01, 14.85]])


@pytest.fixture(scope="module")
def chain():
    return arm()


def test_the_printed_poses_give_the_printed_J():
    assert_allclose(J(ROW_1), ROWS[1].J, atol=2e-3)  # the pose is printed to two decimals
    assert_allclose(J(ROW_2), ROWS[2].J, atol=2e-3)


def test_the_printed_pose_of_row_1_gives_its_total_error_and_that_of_row_2_does_not():
    assert_allclose(total_error(ROW_1), ROWS[1].total, atol=1e-2)
    assert_allclose(total_error(ROW_2), 12.399, atol=1e-3)
    assert ROWS[2].total == 12.08


def test_other_weights_and_radians_do_not_give_the_printed_J():
    e = differences(ROW_1)[0]
    p, rpy = np.linalg.norm(e[:3]), np.linalg.norm(e[3:])
    for wrong in (0.3 * p + 0.7 * rpy, 0.7 * p + 0.3 * np.radians(rpy), 0.3 * p + 0.7 * np.radians(rpy)):
        assert abs(wrong - ROWS[1].J) > 1.0


def test_poses_are_pinocchios(chain):
    X = chain.box.sample(np.random.default_rng(0), 50)
    for x, pose in zip(X, poses(chain, X), strict=True):
        (placement,) = chain.placements(chain.q(x))
        assert_allclose(pose[:3], CM * placement.translation, atol=1e-10)
        assert_allclose(pin.rpy.rpyToMatrix(*np.radians(pose[3:])), placement.rotation, atol=1e-12)


def test_at_zero_the_tip_is_where_the_table_has_it(chain):
    assert_allclose(poses(chain, np.zeros((1, 6)))[0, :3], (8.4, 0.0, 64.6), atol=1e-12)


def test_where_the_refiner_stops_J_is_zero(chain):
    trial = hybrid(case(chain, 1), "SFLA", sfla(ROWS[1]), 5000, 0, np.random.default_rng(0)).work()
    assert trial.cost < 1e-9  # cm and degrees, at a tolerance of 1e-12 m and rad


def test_angles_differ_the_short_way_round():
    assert_allclose(J(G[None] + np.array([0, 0, 0, 359.0, 0, 0])), J(G[None] + np.array([0, 0, 0, 1.0, 0, 0])))


def test_J_is_at_most_sigma_times_the_total_error_which_some_printed_rows_exceed(chain):
    reached = poses(chain, chain.box.sample(np.random.default_rng(1), 1000))
    assert (J(reached) <= SIGMA * total_error(reached)).all()
    assert "rows 4, 5, 6, 7, 13, 20 have more" in inconsistent()


def test_the_printed_times_go_with_the_number_of_frogs():
    assert "810 to 23505 us a leap, but 67 to 122 us for each of the NP frogs" in effort()


def test_quick_leaves_out_the_long_rows():
    assert set(rows(Options(1))) == set(ROWS)
    assert 19 not in rows(Options(1, quick=True)) and 1 in rows(Options(1, quick=True))


def test_the_search_has_the_settings_of_its_row():
    frogs = sfla(ROWS[19])
    assert (frogs.frogs, frogs.memeplexes, frogs.leaps, frogs.leap) == (500, 3, 100, 1.3)


def test_what_was_not_run_is_a_dash_and_not_an_error():
    for section in sections([], Options(1)):
        for table in section.tables:
            assert all(len(row) == len(table.columns) for row in table.rows)
        assert not section.figures
