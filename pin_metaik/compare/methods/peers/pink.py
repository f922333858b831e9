"""pink with daqp: a frame task, joint limits in the QP; where it stalls it starts again at random."""

from __future__ import annotations

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.compare.methods.cost import evaluations_of, steps_within
from pin_metaik.compare.methods.method import Answer
from pin_metaik.compare.methods.peers.peer import TOLERANCE, Peer, Solve
from pin_metaik.compare.methods.peers.serial_arm import TIP, SerialArm

PATIENCE, PROGRESS = 3, 0.9  # steps without a tenth of progress that end a start


def load(arm: SerialArm) -> Solve:
    """The arm as a pink configuration."""
    import daqp  # noqa: F401 - qpsolvers finds it
    import pink
    import pinocchio as pin
    from pink.limits import ConfigurationLimit

    model = pin.buildModelFromXML(arm.urdf())
    configuration = pink.Configuration(model, model.createData(), pin.neutral(model))
    limits = [ConfigurationLimit(model, config_limit_gain=1.0)]
    task = pink.FrameTask(TIP, position_cost=1.0, orientation_cost=1.0, lm_damping=1e-3)

    def solve(pose: Array, x0: Array, budget: int, rng: np.random.Generator) -> Answer:
        task.set_target(pin.SE3(pose))
        allowed, steps, start, best, nearest = steps_within(budget), 0, x0, np.inf, x0
        while True:
            configuration.update(arm.q(start))
            idle, least = 0, np.inf
            while idle < PATIENCE:
                error = task.compute_error(configuration)
                distance, angle = float(np.linalg.norm(error[:3])), float(np.linalg.norm(error[3:]))
                if distance + angle < best:
                    best, nearest = distance + angle, arm.x(configuration.q)
                if distance <= TOLERANCE and angle <= TOLERANCE:
                    return Answer(arm.x(configuration.q), True, evaluations_of(steps))
                if steps >= allowed:
                    return Answer(nearest, False, evaluations_of(steps))
                least, idle = (distance + angle, 0) if distance + angle < PROGRESS * least else (least, idle + 1)
                steps += 1
                try:
                    velocity = pink.solve_ik(configuration, [task], 1.0, "daqp", limits=limits)
                except pink.exceptions.PinkError:
                    break
                configuration.integrate_inplace(velocity, 1.0)
            start = rng.uniform(arm.lower, arm.upper)

    return solve


PINK = Peer("pink", "pink", "peers", load)
