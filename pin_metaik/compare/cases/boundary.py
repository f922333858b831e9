"""Workspace boundary: the tip is as far in some direction as the joints let it go."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.compare.cases.case import Case, Task
from pin_metaik.kinematics import Chain

SWEEPS, GAIN = 200, 1e-13  # m gained by one sweep over the joints that are not worth another


def farthest(chain: Chain, x: NDArray[np.float64], direction: NDArray[np.float64]) -> NDArray[np.float64]:
    """Coordinates (n,), from x on, at which the tip is farthest in a direction (3,), a local maximum.

    One joint after the other is set to its best, in closed form: turning a joint by t moves the tip in that direction
    by g sin t + c (1 - cos t), where g = d (z x v), c = d (z x (z x v)), z is the axis and v leads from it to the tip.
    """
    model, data, frame = chain.model, chain.data, chain.frame_ids[0]
    lower, upper, rotates = chain.box.lower, chain.box.upper, chain.limits.rotates
    x = x.copy()
    before = -np.inf
    for _ in range(SWEEPS):
        for i in range(chain.n):
            J = (
                pin.computeFrameJacobian(model, data, chain.q(x), frame, pin.LOCAL_WORLD_ALIGNED)
                @ chain.tangent(x)[:, i]
            )
            g, c = float(direction @ J[:3]), float(direction @ np.cross(J[3:], J[:3]))
            if not rotates[i]:
                x[i] = upper[i] if g > 0.0 else lower[i]
                continue
            turn = np.arctan2(g, -c)
            candidates = x[i] + np.array([turn, turn - 2.0 * np.pi, turn + 2.0 * np.pi])
            candidates = np.append(
                candidates[(candidates >= lower[i]) & (candidates <= upper[i])], [lower[i], upper[i]]
            )
            t = candidates - x[i]
            x[i] = candidates[np.argmax(g * np.sin(t) + c * (1.0 - np.cos(t)))]
        far = float(direction @ chain.placements(chain.q(x))[0].translation)
        if far - before < GAIN:
            break
        before = far
    return x


def draw(chain: Chain, rng: np.random.Generator) -> Task:
    """The pose where the tip is farthest in a random direction, from a random configuration."""
    direction = rng.normal(size=3)
    x = chain.box.sample(rng, 1)[0]
    return Task.at(chain, farthest(chain, x, direction / np.linalg.norm(direction))[None])


BOUNDARY = Case(
    "boundary",
    "Poses at which the tip can go no farther in a random direction: arms stretched out, joints at their limits.",
    draw,
)
