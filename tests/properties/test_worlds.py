"""An answer in a world is free of collisions, by distances that coal computes of the shapes as they were given."""

from random import Random

import coal
import numpy as np
import pinocchio as pin
from hypothesis import given
from hypothesis import strategies as st

import pin_metaik as mik
from pin_metaik.collision import Obstacle, Sphere
from tests.properties.questions import Question, questions

ROUNDING = 1e-6  # m, to which distances are judged


@given(questions(most=7), st.randoms(use_true_random=False))
def test_a_success_in_a_world_keeps_its_margin(question: Question, rnd: Random) -> None:
    margin = rnd.choice((0.0, 0.01, 0.05))
    ball = Obstacle("ball", Sphere(rnd.uniform(0.02, 0.3)), tuple(rnd.uniform(-1.0, 1.0) for _ in range(3)))
    world = mik.CollisionWorld(question.robot, [ball], margin=margin)
    result = question.solve(world=world, solver=mik.IKSolver(budget=mik.Budget(evaluations=500)))
    assert question.inside(result.q)
    assert result.status is not mik.IKStatus.UNREACHABLE
    if result.success:
        assert question.met(result.q)
        assert not world.in_collision(result.q) and not world.pairs_in_collision(result.q)
        assert nearest(question, world, ball, result.q) > margin - ROUNDING


def nearest(question: Question, world: mik.CollisionWorld, ball: Obstacle, q: np.ndarray) -> float:
    """The least distance (m) between the ball and a body that moves, of the pairs that are checked."""
    model, bodies = question.robot.model, question.robot.collision_model
    data, placed = model.createData(), bodies.createData()
    pin.updateGeometryPlacements(model, data, bodies, placed, q)
    found = np.inf
    for i, body in enumerate(bodies.geometryObjects):
        link = model.frames[body.parentFrame].name
        if body.parentJoint and not world.pairs[tuple(sorted((link, ball.name)))]:
            at = placed.oMg[i]
            distance = coal.distance(
                body.geometry, coal.Transform3s(at.rotation, at.translation), coal.Sphere(ball.shape.radius),
                coal.Transform3s(np.eye(3), ball.pose.translation), coal.DistanceRequest(), coal.DistanceResult(),
            )  # fmt: skip
            found = min(found, distance)
    return found
