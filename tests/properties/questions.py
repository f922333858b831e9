"""Questions that can be met: random models, poses of configurations, tolerances, starts and budgets."""

from __future__ import annotations

from dataclasses import dataclass
from random import Random
from typing import Any

import numpy as np
import pinocchio as pin
from feasible import FAMILIES, coordinates, direction
from hypothesis import strategies as st
from judge import ROUNDING, Floats, Judge
from random_models import RandomModel, random_model

import pin_metaik as mik

MOST = 12  # joints of a model
EVALUATIONS = 3_000  # a search that is not met by then is given up


@dataclass(frozen=True)
class Question:
    """A question that a configuration answers.

    Attributes:
        robot: The model.
        chain: Its chain.
        x: (n,) coordinates that answer it.
        poses: (T, 4, 4) what is asked of the frames.
        near: Tolerance of positions, m.
        aligned: Tolerance of orientations, rad.
        start: (nq,) configuration to start from, or None.
    """

    robot: RandomModel
    chain: mik.Chain
    x: Floats
    poses: Floats
    near: float
    aligned: float
    start: Floats | None

    def targets(self, base: pin.SE3 | None = None) -> list[mik.Target]:
        """What to ask, in a world that stands elsewhere."""
        moved = pin.SE3.Identity() if base is None else base
        return [
            mik.Target(moved * pin.SE3(pose), frame, position_tolerance=self.near, orientation_tolerance=self.aligned)
            for frame, pose in zip(self.chain.frames, self.poses, strict=True)
        ]

    def solve(self, **changes: Any) -> mik.IKResult:
        """Ask it."""
        given = {"solver": mik.IKSolver(budget=mik.Budget(evaluations=EVALUATIONS)), "rng": 0, **changes}
        return mik.solve_ik(self.chain, self.targets(), self.start, **given)

    def met(self, q: Floats) -> bool:
        """Whether q (nq,) answers it, by Pinocchio."""
        errors = Judge(self.chain.model, self.chain.frame_ids).errors(q, self.poses)
        return all(d <= self.near + ROUNDING and a <= self.aligned + ROUNDING for d, a in errors)

    def inside(self, q: Floats) -> bool:
        """Whether q (nq,) keeps all limits of the model."""
        return not Judge(self.chain.model, self.chain.frame_ids).outside(q)


@st.composite
def questions(draw: st.DrawFn, most: int = MOST) -> Question:
    """Questions about models of at most so many joints; all is drawn from hypothesis, which makes it smaller."""
    rnd: Random = draw(st.randoms(use_true_random=False))
    robot = random_model(rnd, most)
    chain = robot.chain()
    rng = np.random.default_rng(rnd.randrange(2**32))
    x = coordinates(chain, rnd.choice(FAMILIES[:-1]), rng)
    poses = chain.poses(x)[0].copy()
    near, aligned = (10.0 ** rnd.uniform(-7.0, -2.0) for _ in range(2))
    if rnd.random() < 0.5:
        for pose in poses:
            pose[:3, :3] = pose[:3, :3] @ pin.exp3((aligned - ROUNDING) * direction(rng))
            pose[:3, 3] += (near - ROUNDING) * direction(rng)
    start = chain.q(chain.box.sample(rng, 1)[0]) if rnd.random() < 0.5 else None
    return Question(robot, chain, x, poses, near, aligned, start)
