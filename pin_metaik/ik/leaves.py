"""Points of the self-motions of a pose: solutions that descents from scattered starts are not sure to come near."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.self_motion.motions import MOTION_BUDGET, RESOLUTION, find_self_motions, has_curves

FINE = 0.02  # rad or m between the points of a curve that are looked at in a world


def leaves(problem: IKProblem, base: NDArray[np.float64], step: float, most: int) -> NDArray[np.float64]:
    """Coordinates (k, n) of solutions along all self-motions of a pose, in a world in the middle of what is free there.

    Every stretch of a curve that is free has at least one.

    Args:
        problem: What the pose asks for; without one spare coordinate it has no self-motions, and there are no points.
        base: (nq,) where the joints that the chain does not move are.
        step: rad or m of joint motion from one point to the next ...
        most: ... or more, if there would be more points than so many.
    """
    exact = replace(problem.exact, world=None)
    if not has_curves(exact):
        return np.empty((0, problem.chain.n))
    curves = find_self_motions(exact, base, RESOLUTION, MOTION_BUDGET).curves
    stretches = [
        (curve, begin, end)
        for curve in curves
        for begin, end in ([(0.0, curve.length)] if problem.world is None else curve.free(problem.world, FINE))
    ]
    step = max(step, sum(end - begin for _, begin, end in stretches) / most)
    points = [np.empty((0, len(base)))]
    for curve, begin, end in stretches:
        count = max(1, round((end - begin) / step))
        points.append(curve.q(begin + (end - begin) * (np.arange(count) + 0.5) / count))
    return problem.chain.x(np.concatenate(points))
