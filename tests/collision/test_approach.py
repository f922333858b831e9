"""Kind 23: links that are left out, as they never touch, are looked for by going downhill in their distance."""

import numpy as np
import pinocchio as pin
import pytest

import pin_metaik as mik
from pin_metaik.collision.approach import Approach
from pin_metaik.collision.body import robot_bodies
from pin_metaik.collision.solids import Solids
from pin_metaik.collision.srdf import pair_of
from tests.collision.worlds import configurations, robot_of


def approaches(name: str) -> list[Approach]:
    robot = robot_of(name)
    solids = Solids(robot.model, robot_bodies(robot, "convex"))
    joints = [body.joint for body in solids.moving]
    return [Approach(solids, i, j) for j in range(len(joints)) for i in range(j) if joints[i] != joints[j]]


@pytest.mark.parametrize("name", ["ur5", "panda"])  # the Panda's second finger follows the first
def test_the_slope_of_a_distance_is_that_of_finite_differences(name: str) -> None:
    rng, model = np.random.default_rng(0), robot_of(name).model
    errors = []
    for q in configurations(name, 40):
        approach = approaches(name)[rng.integers(len(approaches(name)))]
        distance, slope = approach._gap(q).distance, approach._slope(q, approach._gap(q))
        if distance < 0.01:
            continue
        steps = 1e-3 * np.eye(model.nv)[approach.free]
        ends = [[approach.distance(pin.integrate(model, q, s * v)) for s in (1.0, -1.0)] for v in steps]
        errors.append(np.abs(np.array(ends) @ [1.0, -1.0] / 2e-3 - slope).max())
    assert np.quantile(errors, 0.9) < 1e-3  # distances of hulls have kinks


def test_a_descent_stays_inside_the_limits_and_never_goes_up() -> None:
    model = robot_of("ur5").model
    for approach in approaches("ur5"):
        for q in configurations("ur5", 3):
            distance, there = approach.descend(q)
            assert distance <= approach.distance(q) + 1e-9
            assert distance == pytest.approx(approach.distance(there), abs=1e-6)
            assert (there >= model.lowerPositionLimit).all()
            assert (there <= model.upperPositionLimit).all()


@pytest.mark.slow
@pytest.mark.parametrize("name", ["panda", "ur5", "kinova", "talos"])
def test_links_left_out_as_never_touching_are_not_made_to_touch_by_descent(name: str) -> None:
    disabled = mik.CollisionWorld(robot_of(name), srdf=False).disabled
    never = {pair for pair, reason in disabled.items() if reason == "Never"}
    assert never
    for approach in approaches(name):
        if pair_of(*approach.links) in never:
            for q in configurations(name, 3, seed=9):  # 20,000 in benchmarks/never_touching.py
                assert approach.descend(q)[0] > 0.0
