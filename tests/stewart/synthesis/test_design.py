from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from pin_metaik.errors import InvalidBounds, InvalidSetting, UnknownName
from pin_metaik.optimize.pso import PSO
from pin_metaik.optimize.qpso import QPSO
from pin_metaik.stewart import (
    NAMED,
    DesignTask,
    Dexterity,
    Fitness,
    Grid,
    LegLimits,
    Mechanism,
    Ranges,
    Verdict,
    design,
    standard_geometry,
    survey,
)
from tests.stewart.cases import reference, stroke

GAP = 0.042


def with_task(mechanism, **changes):
    return replace(mechanism, task=replace(mechanism.task, **changes))


@pytest.mark.parametrize("mm", [50, 100])
@pytest.mark.parametrize("algorithm", [PSO(agents=60), QPSO(agents=60)])
def test_swarms_reach_the_known_fitness_and_keep_the_gap(mm, algorithm):  # A12, in a third of its evaluations
    mechanism = with_task(stroke(mm), algorithm=algorithm, evaluations=1200, seed=3)
    found = design(mechanism)
    assert found.success
    assert found.score.fitness >= 0.750
    assert found.mechanism.geometry.joint_gap >= GAP - 1e-9
    best = found.history[:, 1]
    assert (np.diff(best) >= 0).all()
    assert best[-1] == found.score.fitness
    assert found.search.evaluations == 1200
    finer = with_task(found.mechanism, grid=replace(mechanism.task.grid, counts=(40, 40, 40)))
    fitness = Fitness(finer)
    score = fitness.score(fitness.workspace(found.mechanism.geometry, found.mechanism.limits))
    assert_allclose(score.fitness, found.score.fitness, atol=0.003)  # the coarse grid did not flatter it much


@pytest.mark.parametrize("algorithm", [PSO(agents=20), QPSO(agents=20)])
def test_the_same_seed_gives_the_same_design_bit_for_bit(algorithm):  # A12
    mechanism = with_task(stroke(50), algorithm=algorithm, evaluations=100)
    first, again, other = design(mechanism), design(mechanism), design(mechanism, rng=1)
    assert first.mechanism == again.mechanism
    assert_array_equal(first.history, again.history)
    assert other.mechanism != first.mechanism


@pytest.mark.parametrize("algorithm", ["pso", "qpso", "gwo", "mtde", "de", "ga", "sfla"])
def test_any_metaheuristic_designs(algorithm):
    found = design(with_task(stroke(50), algorithm=algorithm, evaluations=300))
    assert found.success
    assert found.score.fitness > 0.4


@pytest.mark.parametrize("type", NAMED)
def test_every_type_is_designed_by_the_same_lines(type):  # A13
    geometry = standard_geometry(type, 0.2, 0.1)
    wide = tuple((angle - 0.3, angle + 0.3) for angle in geometry.base_angles)
    task = DesignTask(Ranges((0.1, 0.3), (0.042, 0.15), wide), joint_gap=0.02, evaluations=60, algorithm=PSO(agents=20))
    found = design(Mechanism(type, geometry, LegLimits(0.25, 0.35), task=task))
    assert found.success
    assert found.mechanism.geometry.type == type
    assert found.mechanism.geometry.legs == geometry.legs
    assert found.mechanism.geometry.joint_gap >= 0.02
    assert found.mechanism.geometry.platform_angles == geometry.platform_angles  # fixed


def test_legs_can_be_optimised_too():
    ranges = Ranges(shortest=(0.2, 0.3), longest=(0.3, 0.4))
    task = DesignTask(ranges, evaluations=100, algorithm=PSO(agents=20))
    found = design(Mechanism("legs", standard_geometry("6x6", 0.2, 0.1), LegLimits(0.25, 0.35), task=task))
    limits = found.mechanism.limits
    assert 0.2 <= limits.shortest <= 0.3 <= limits.longest <= 0.4
    assert found.mechanism.geometry == standard_geometry("6x6", 0.2, 0.1)


def test_lci_enlarges_the_dexterous_workspace_of_an_existing_mechanism():
    mechanism = with_task(
        stroke(100), index="lci", threshold=0.88, weights=(0.5, 0.5), evaluations=300, from_current=True
    )
    found = design(mechanism)
    before, after = (m.survey().dexterous_volume(0.88) for m in (mechanism, found.mechanism))
    assert after > before
    assert (
        found.score.fitness
        >= Fitness(mechanism).score(Fitness(mechanism).workspace(mechanism.geometry, mechanism.limits)).fitness
    )


def test_starting_from_the_mechanism_is_never_worse_than_it():
    good = design(with_task(stroke(50), evaluations=300)).mechanism
    again = design(with_task(good, evaluations=1, from_current=True))
    assert again.mechanism == with_task(good, evaluations=1, from_current=True)


def test_the_weights_decide_between_dexterity_and_workspace():
    dexterous = design(with_task(stroke(50), weights=(1.0, 0.0), evaluations=300))
    large = design(with_task(stroke(50), weights=(0.0, 1.0), evaluations=300))
    assert dexterous.score.dexterity > large.score.dexterity
    assert dexterous.score.workspace < large.score.workspace


def test_fitness_is_the_weighted_sum_of_what_the_survey_says():
    mechanism = with_task(stroke(100), grid=Grid((40, 40, 40)), cube=0.2)
    workspace = survey(mechanism.geometry, mechanism.limits, mechanism.task.grid)
    fitness = Fitness(mechanism)
    score = fitness.score(fitness.workspace(mechanism.geometry, mechanism.limits))
    assert_allclose(score.fitness, 0.78 * workspace.gdi + 0.22 * workspace.volume / 0.2**3)
    x = fitness.variables.point(mechanism.geometry, mechanism.limits)
    assert_allclose(fitness(np.array([x, x])), -score.fitness)


def test_the_best_length_and_the_other_norm_design_as_well():
    mechanism = replace(stroke(50), dexterity=Dexterity("two", "best"))
    found = design(with_task(mechanism, evaluations=20, algorithm=PSO(agents=10), grid=Grid((8, 8, 8))))
    assert found.success
    assert 0 < found.score.dexterity < 1


def test_what_cannot_be_built_costs_more_than_what_does_not_work_and_that_more_than_anything_else():
    mechanism = stroke(100)
    fitness = Fitness(mechanism)
    good = fitness.variables.point(mechanism.geometry, mechanism.limits)

    def moved(**changes):
        own = replace(mechanism.geometry, **changes)
        return fitness.variables.point(own, mechanism.limits)

    tight = moved(platform_radius=0.02)
    tighter = moved(platform_radius=0.01)
    nowhere = moved(base_radius=1.0)
    disordered = good.copy()
    disordered[-1] = disordered[-3]
    costs = fitness(np.array([good, nowhere, tight, tighter, disordered]))
    assert costs[0] < 0
    assert costs[1] == 2
    assert 3 < costs[2] < costs[3]
    assert costs[4] > 3
    turning = Fitness(with_task(mechanism, grid=Grid((6, 6, 6), steps=(1, 1, 9), yaw=(0, 2.4))))  # across a singularity
    assert 1 < turning(np.array([good]))[0] < 2
    large = Fitness(with_task(mechanism, least_workspace=0.9))
    assert 1 < large(np.array([good]))[0] < 2


def test_a_gap_that_fits_nowhere_has_no_design():
    found = design(with_task(stroke(50), joint_gap=1.0, evaluations=120))
    assert not found.success
    assert found.score is None
    assert found.mechanism == with_task(stroke(50), joint_gap=1.0, evaluations=120)
    assert (found.history[:, 1] < 0).all()
    assert "no feasible design" in str(found)


def test_the_least_workspace_keeps_dexterous_specks_out():
    mechanism = with_task(stroke(150), evaluations=300, weights=(1.0, 0.0), least_workspace=0.08)
    found = design(mechanism)
    assert found.score.workspace >= 0.08


def test_ctrl_c_goes_through_with_the_best_design_so_far():
    def press(at):
        if at.done >= 240:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt) as stop:
        design(stroke(50), watch=press)
    found = stop.value.result
    assert found.interrupted
    assert found.success
    assert found.search.evaluations == 240
    assert found.mechanism.survey().verdict is Verdict.REGULAR


def test_a_mechanism_without_a_task_is_not_designed():
    with pytest.raises(InvalidSetting, match="reference_6x6 has no design settings"):
        design(reference())


def test_legs_without_stroke_need_a_cube():
    task = DesignTask(Ranges(base_radius=(0.1, 0.2)))
    mechanism = Mechanism("rigid", standard_geometry("3x3", 0.2, 0.1), LegLimits(0.3, 0.3), task=task)
    with pytest.raises(InvalidSetting, match="no stroke"):
        design(mechanism)


@pytest.mark.parametrize(
    ("settings", "error", "message"),
    [
        ({"index": "gci"}, InvalidSetting, "index must be one of 'gdi', 'lci'"),
        ({"weights": (0, 0)}, InvalidSetting, "one of the weights is above zero"),
        ({"weights": (-1, 2)}, InvalidSetting, "a weight must be a number from 0"),
        ({"weights": 3}, InvalidSetting, "weights: expected two values, each a number"),
        ({"threshold": 1.5}, InvalidSetting, "threshold"),
        ({"joint_gap": -1}, InvalidSetting, "joint_gap"),
        ({"least_workspace": -0.1}, InvalidSetting, "least_workspace"),
        ({"cube": 0.0}, InvalidSetting, "cube is a length above zero"),
        ({"evaluations": 0}, InvalidSetting, "evaluations"),
        ({"seed": -1}, InvalidSetting, "seed"),
        ({"from_current": "yes"}, InvalidSetting, "from_current: expected True or False"),
        ({"algorithm": "psa"}, UnknownName, "no metaheuristic named 'psa'; did you mean 'pso'"),
    ],
)
def test_settings_that_make_no_sense_are_refused(settings, error, message):
    with pytest.raises(error, match=message):
        DesignTask(Ranges(), **settings)


def test_ranges_for_other_joints_are_refused():
    with pytest.raises(InvalidBounds, match="base_angles has 1 ranges for 3 joints"):
        design(with_task(stroke(50), ranges=Ranges(base_angles=((0.0, 1.0),))))
