"""Feasible targets at their worst: arms of all kinds, corners and singularities, poses at the edge of the tolerance.

What is called a proof has to hold for all of them, so this is what proofs are tried against.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

import pin_metaik as mik
from pin_metaik.compare.cases.case import NoTask
from pin_metaik.compare.cases.singular import singular

Floats = NDArray[np.float64]

TURNS = (np.eye(3), *(pin.utils.rotate(axis, sign * np.pi / 2) for axis in "xy" for sign in (1.0, -1.0)))
TURNING = pin.JointModelRX, pin.JointModelRY, pin.JointModelRZ
SLIDING = pin.JointModelPX, pin.JointModelPY, pin.JointModelPZ
FAMILIES = (
    "random",
    "some at limits",
    "all at limits",
    "one at a limit",
    "right angles",
    "half right angles",
    "some at zero",
    "singular",
)
MEETING = {  # where the axis before is met, joints counted from either end
    "wrist at the tip": (-2, -1),
    "wrist at the base": (1, 2),
    "shoulder and wrist": (2, -2, -1),
    "wrist and shoulder": (1, 2, -2),
}
SINGULAR = 8  # singular configurations of an arm, found once


@dataclass(frozen=True)
class Feasible:
    """A pose that a configuration reaches within the tolerances.

    Attributes:
        x: (n,) that configuration's coordinates.
        pose: (4, 4).
        near: Tolerance of the position, m.
        aligned: Tolerance of the orientation, rad.
    """

    x: Floats
    pose: Floats
    near: float
    aligned: float


def random_chain(rng: np.random.Generator) -> mik.Chain:
    """An arm of one to nine joints: turning, sliding, following others; axes parallel, meeting, at any angle."""
    while True:
        model, followers = _random_model(rng)
        for joint, leader in followers:  # from the last to the first, so that numbers stay what they are
            scale, offset = float(rng.choice([-1.0, 0.5, 2.0])), 0.3 * float(rng.normal())
            model = pin.transformJointIntoMimic(model, leader, joint, scale, offset)
        try:
            return mik.Chain(model, "tip")
        except mik.MetaIKError:  # limits of a follower that its leader cannot keep
            continue


def _random_model(rng: np.random.Generator) -> tuple[pin.Model, list[tuple[int, int]]]:
    kind = rng.choice(["any", "wrist at the tip", "wrist at the base", "shoulder and wrist", "wrist and shoulder"])
    model, n, parent, followers = pin.Model(), int(rng.integers(1, 10)), 0, []
    meeting = MEETING.get(str(kind), ())
    if "shoulder" in kind:
        n = 7
    for i in range(n):
        turn = TURNS[rng.integers(len(TURNS))] if rng.random() < 0.6 else pin.exp3(rng.normal(size=3))
        if rng.random() < 0.2:
            turn = turn @ pin.exp3(1e-3 * rng.normal(size=3))
        way = 0.3 * rng.normal(size=3) * (rng.random(3) < 0.5)
        if i in meeting or i - n in meeting:
            way = np.zeros(3) if rng.random() < 0.9 else 2e-6 * rng.normal(size=3)  # nearly
        slides = rng.random() < (0.02 if "shoulder" in kind else 0.15)
        span = (0.2 if slides else 1.0) * rng.uniform(0.1, 3.2, 2)
        lower, upper = (-6.5, 6.5) if not slides and rng.random() < 0.2 else (-span[0], span[1])
        joint = (SLIDING if slides else TURNING)[rng.integers(3)]()
        bounds = (np.array([bound]) for bound in (10.0, 10.0, lower, upper))
        parent = model.addJoint(parent, joint, pin.SE3(np.array(turn), way), f"joint_{i}", *bounds)
        alike = [j for j in range(1, parent) if model.joints[j].shortname()[:12] == joint.shortname()[:12]]
        if alike and rng.random() < (0.02 if "shoulder" in kind else 0.15):
            followers.append((parent, alike[0]))
    tip = pin.SE3(pin.exp3(rng.normal(size=3)), 0.2 * rng.normal(size=3))
    model.addFrame(pin.Frame("tip", parent, 0, tip, pin.FrameType.OP_FRAME))
    leaders = {leader for _, leader in followers}
    return model, [pair for pair in reversed(followers) if pair[0] not in leaders]


def random_closed_form(rng: np.random.Generator) -> mik.Chain:
    """An arm of six joints that has a closed form: a wrist behind two parallel axes, or three parallel axes and two."""
    while True:
        model, parent, three = pin.Model(), 0, rng.random() < 0.5
        turns = [np.eye(3) if i in ((2, 3) if three else (2,)) else _turn(rng) for i in range(6)]
        for i, turn in enumerate(turns):
            way = 0.3 * rng.normal(size=3) * (rng.random(3) < 0.6)
            if i == 5 or (i == 4 and not three):
                way = np.array([0.0, 0.0, way[2] if i == 4 else 0.0])  # along the axis before: the axes meet
            span = rng.uniform(0.3, 3.2, 2) if rng.random() < 0.7 else (6.3, 6.3)
            bounds = (np.array([bound]) for bound in (10.0, 10.0, -span[0], span[1]))
            parent = model.addJoint(parent, pin.JointModelRZ(), pin.SE3(turn, way), f"joint_{i}", *bounds)
        tip = pin.SE3(pin.exp3(rng.normal(size=3)), 0.2 * rng.normal(size=3))
        model.addFrame(pin.Frame("tip", parent, 0, tip, pin.FrameType.OP_FRAME))
        chain = mik.Chain(model, "tip")
        if len(chain.form):
            return chain


def _turn(rng: np.random.Generator) -> Floats:
    """From one axis to the next: mostly a right angle."""
    return np.array(TURNS[rng.integers(1, len(TURNS))] if rng.random() < 0.6 else pin.exp3(rng.normal(size=3)))


@lru_cache(maxsize=64)
def singular_ones(chain: mik.Chain) -> Floats:
    """Singular coordinates (k, n) of an arm; none, if it has none."""
    try:
        return singular(chain, SINGULAR, np.random.default_rng(0))
    except NoTask:
        return np.empty((0, chain.n))


def coordinates(chain: mik.Chain, family: str, rng: np.random.Generator) -> Floats:
    """Coordinates (n,) of a family inside the limits, angles within one turn."""
    box = chain.limits.one_turn().box()
    lower, upper = box.lower, box.upper
    x = rng.uniform(lower, upper)
    if family == "some at limits":
        x = np.where(rng.random(chain.n) < 0.5, np.where(rng.random(chain.n) < 0.5, lower, upper), x)
    elif family == "all at limits":
        x = np.where(rng.random(chain.n) < 0.5, lower, upper)
    elif family == "one at a limit":
        c = rng.integers(chain.n)
        x[c] = rng.choice([lower[c], upper[c]])
    elif family in ("right angles", "half right angles"):
        step = np.pi / (2 if family == "right angles" else 4)
        x = np.clip(step * np.round(x / step), lower, upper)
    elif family == "some at zero":
        x = np.where(rng.random(chain.n) < 0.3, np.clip(0.0, lower, upper), x)
    elif family == "singular" and len(singular_ones(chain)):
        x = np.clip(rng.choice(singular_ones(chain)), lower, upper)
    return x


def feasible(chain: mik.Chain, rng: np.random.Generator, tolerances: tuple[float, float] = (1e-7, 1e-1)) -> Feasible:
    """A target of any family, exact or moved by the whole tolerance, which lies anywhere between ``tolerances``."""
    x = coordinates(chain, str(rng.choice(FAMILIES)), rng)
    pose = chain.poses(x)[0, 0].copy()
    near, aligned = 10.0 ** rng.uniform(*np.log10(tolerances), 2)
    if rng.random() < 0.7:
        pose[:3, :3] = pose[:3, :3] @ pin.exp3(aligned * direction(rng))
        pose[:3, 3] += near * (outward(chain, pose, rng) if rng.random() < 0.5 else direction(rng))
    return Feasible(x, pose, float(near), float(aligned))


def outward(chain: mik.Chain, pose: Floats, rng: np.random.Generator) -> Floats:
    """The direction (3,) in which a pose is soonest out of reach: its wrist away from what is fixed, or towards it."""
    reach = chain.reach(0, oriented=True)
    way = pose[:3, :3] @ reach.end + pose[:3, 3] - reach.anchor
    length = np.linalg.norm(way)
    return np.asarray(rng.choice([-1.0, 1.0]) * way / length) if length > 0.0 else direction(rng)


def direction(rng: np.random.Generator) -> Floats:
    """A random unit vector (3,)."""
    v = rng.normal(size=3)
    return v / np.linalg.norm(v)
