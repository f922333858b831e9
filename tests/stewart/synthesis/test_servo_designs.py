"""Designs of platforms moved by servos."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from pin_metaik.errors import InvalidBounds, UnknownName
from pin_metaik.stewart import (
    Fitness,
    Ranges,
    ServoLimits,
    Verdict,
    compare_types,
    design,
    load_mechanism,
    new_servo_mechanism,
)
from pin_metaik.stewart.mechanism.ranges import Variables
from tests.stewart.cases import general_servos, stroke


def with_task(mechanism, **changes):
    return replace(mechanism, task=replace(mechanism.task, **changes))


def test_a_design_is_better_than_what_it_started_from_and_what_a_survey_says():
    start = with_task(load_mechanism("servo_sg90"), evaluations=240, from_current=True)
    found = design(start)
    assert found.success
    at_start = Fitness(start)
    assert found.score.fitness > at_start.score(at_start.workspace(start.geometry, start.limits)).fitness + 0.05
    servos, ranges = found.mechanism.geometry.servos, start.task.ranges
    assert ranges.horn[0] <= servos.horn <= ranges.horn[1]
    assert ranges.rod[0] <= servos.rod <= ranges.rod[1]
    assert servos.directions == pytest.approx(start.geometry.servos.directions)
    workspace = found.mechanism.survey()
    assert workspace.verdict is Verdict.REGULAR
    assert workspace.gdi == pytest.approx(found.score.dexterity, abs=0.01)
    cube = 4 * ranges.horn[1]
    assert workspace.volume / cube**3 == pytest.approx(found.score.workspace, rel=0.05)
    assert design(start).mechanism == found.mechanism


def test_servos_turn_with_their_joints():
    mechanism = load_mechanism("servo_sg90")
    angles = mechanism.geometry.base_angles
    ranges = Ranges(base_angles=tuple((angle - 0.2, angle + 0.2) for angle in angles), directions=((-3, 0), *[1.0] * 5))
    fitness = Fitness(with_task(mechanism, ranges=ranges))
    x = np.append(np.array(angles) + 0.1, -2.0)
    geometry, limits = fitness.build(fitness.variables.dimensions(x))
    assert_allclose(geometry.servos.directions, np.array([-2.0, *[1.0] * 5]) + 0.1)
    assert limits == mechanism.limits
    assert_allclose(fitness.variables.point(mechanism.geometry, mechanism.limits)[:6], angles)


def test_at_its_own_point_a_design_is_the_mechanism():
    mechanism = load_mechanism("servo_sg90")
    free = Ranges(base_angles=((-1, 1), *mechanism.geometry.base_angles[1:]), horn=(0.01, 0.02))
    fitness = Fitness(with_task(mechanism, ranges=free))
    point = fitness.variables.point(mechanism.geometry, mechanism.limits)
    assert fitness.build(fitness.variables.dimensions(point)) == (mechanism.geometry, mechanism.limits)


def test_horns_and_rods_of_each_leg_stay_as_they_are_or_become_one():
    geometry, limits = general_servos(), ServoLimits(-1, 1)
    kept = Variables.of(Ranges(rod=(0.1, 0.13)), geometry, limits)
    found = kept.dimensions(np.array([0.11]))
    assert_allclose(found.horn, geometry.servos.horn)
    assert_allclose(found.rod, [0.11])
    assert_allclose(kept.point(geometry, limits), np.mean(geometry.servos.rod))
    assert kept.longest_stroke == pytest.approx(2 * max(geometry.servos.horn))


def test_ranges_of_the_other_kind_of_legs_are_refused():
    servos = load_mechanism("servo_sg90")
    with pytest.raises(
        InvalidBounds, match="these legs have no longest to give a range; they have directions, horn, rod"
    ):
        design(with_task(servos, ranges=Ranges(longest=(0.1, 0.2))))
    with pytest.raises(InvalidBounds, match="no horn to give a range; they have longest, shortest"):
        design(with_task(stroke(100), ranges=Ranges(horn=(0.1, 0.2))))
    with pytest.raises(InvalidBounds, match="directions has 2 ranges for 6 servos"):
        design(with_task(servos, ranges=Ranges(directions=(0.0, (1.0, 2.0)))))


def test_a_new_platform_of_servos_is_designed_and_compared_by_types():
    mechanism = new_servo_mechanism("6x3", 0.06, 0.04, 0.02, 0.11)
    assert mechanism.survey().verdict is Verdict.REGULAR
    found = compare_types(with_task(mechanism, evaluations=60))
    assert sorted(one.type for one in found) == ["6x3", "6x4", "6x5", "6x6"]
    assert all(one.designed.success for one in found)
    with pytest.raises(UnknownName, match="type of platform with 6 servos"):
        new_servo_mechanism("4x3", 0.06, 0.04, 0.02, 0.11)
    with pytest.raises(UnknownName, match="known: 6x3, 6x4, 6x5, 6x6"):
        compare_types(mechanism, ["3x3"])
