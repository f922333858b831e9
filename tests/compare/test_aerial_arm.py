import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

from pin_metaik.compare.papers import Options
from pin_metaik.compare.papers.aerial_arm import COMPARED, jobs, rows, sections, turned_back
from pin_metaik.compare.papers.aerial_arm_setup import (
    CM,
    FREE,
    READINGS,
    ROWS,
    SIGMA,
    SOLVED,
    TEXT,
    TIMES,
    WALLS,
    G,
    J,
    arm,
    case,
    differences,
    poses,
    total_error,
)
from pin_metaik.compare.papers.aerial_arm_tables import at_the_walls, effort, inconsistent
from pin_metaik.compare.papers.arm import ArmTrial, hybrid, search

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
    assert abs(total_error(ROW_2) - ROWS[2].total) > 0.3


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
    trial = hybrid(case(chain, 1), "SFLA", TEXT.sfla(ROWS[1]), 5000, 0, np.random.default_rng(0)).work()
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


def test_the_searches_have_the_settings_of_their_row():
    for reading in READINGS:
        frogs = reading.sfla(ROWS[19])
        assert (frogs.frogs, frogs.memeplexes, frogs.leaps, frogs.leap) == (500, 3, 100, 1.3)
        assert (frogs.leapers, frogs.fallbacks) == (reading.leapers, True)


def test_the_text_pays_for_three_evaluations_a_leap_and_the_times_for_one_a_frog_and_step():
    assert TEXT.evaluations(ROWS[19]) == 500 + 3 * 3 * 200 * 100
    assert TIMES.evaluations(ROWS[19]) == 500 + 500 * 200 * 100


def test_every_row_is_run_in_both_readings_and_those_compared_in_all():
    planned = [job.label for job in jobs(Options(2))]
    for reading, count in zip(READINGS, (len(ROWS), len(COMPARED), len(COMPARED), len(ROWS)), strict=True):
        assert sum(f"{reading}, " in label for label in planned) == 2 * count


@pytest.mark.slow
@pytest.mark.parametrize("number", [14, 18])
def test_read_by_the_printed_times_a_row_finds_the_region_in_the_best_of_three_runs(number):
    """One run in four ends elsewhere, so three do in one trial of sixty; rows 17 and 19 take too long here."""
    here, row = case(arm(FREE), number), ROWS[number]
    runs = (
        search(here, "SFLA", TIMES.sfla(row), TIMES.evaluations(row), run, np.random.default_rng(run)).work()
        for run in range(3)
    )
    assert any(trial.cost <= SOLVED for trial in runs)


def test_with_freer_joints_every_posture_has_a_copy_a_quarter_turn_from_all_ends(chain):
    X = chain.box.sample(np.random.default_rng(2), 500)
    copies = X - 2 * np.pi * np.rint(X / (2 * np.pi))
    assert_allclose(arm(FREE).box.upper, 1.5 * np.pi)
    assert (1.5 * np.pi - np.abs(copies) >= 0.5 * np.pi).all()


def test_angles_are_turned_back_to_the_same_posture():
    free = arm(FREE)
    x = free.box.sample(np.random.default_rng(3), 1)[0]
    back = turned_back(ArmTrial("row 1", str(TIMES), 1, 0, 0.0, x, 1, 0.1)).x
    assert (np.abs(back) <= np.pi).all() and (np.abs(x) > np.pi).any()
    assert_allclose(poses(free, back[None]), poses(free, x[None]), atol=1e-10)


def test_runs_at_the_walls_are_counted():
    def trial(cost, angle):
        return ArmTrial("row 1", str(TEXT), 1, 0, cost, np.radians([0, 0, angle, 0, 0, 0]), 1, 0.1)

    sentence = at_the_walls([trial(1.0, WALLS), trial(1.0, 10.0), trial(0.0, WALLS)])
    assert "Of the 2 runs that found no solution" in sentence and "1 ended with a joint" in sentence


def test_what_was_not_run_is_a_dash_and_not_an_error():
    for section in sections([], Options(1)):
        for table in section.tables:
            assert all(len(row) == len(table.columns) for row in table.rows)
        assert not section.figures
