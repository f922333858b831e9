"""Random models: one to forty joints of every kind, axes at any angle, odd limits, followers, several trees, bodies.

A model is drawn from a ``random.Random``, as hypothesis has one too (``st.randoms``): what it finds, it makes smaller.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from random import Random
from typing import Any

import coal
import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

import pin_metaik as mik

Floats = NDArray[np.float64]

MOST = 40  # joints of a model
FEW = 9  # joints of most models
ENDLESS = 1e308  # how a model writes "no limit"


@dataclass(frozen=True)
class RandomModel:
    """A model, the frames to place, and its bodies: what ``mik.Chain`` and ``mik.CollisionWorld`` take.

    Attributes:
        model: The model.
        frames: Names of one to three frames, each at the end of a branch.
        collision_model: A body on some joints, and one that stands.
        name: Its name.
        srdf: None: no pairs are left out by hand.
    """

    model: pin.Model
    frames: tuple[str, ...]
    collision_model: pin.GeometryModel
    name: str = "random"
    srdf: None = None

    def chain(self, **changes: Any) -> mik.Chain:
        """Its chain to all frames."""
        return mik.Chain(self.model, self.frames, **changes)

    def moved(self, base: pin.SE3) -> RandomModel:
        """The same with all that stands in the world, the roots of its trees and bodies, put elsewhere."""
        model, bodies = pin.Model(self.model), self.collision_model.copy()
        for joint in range(1, model.njoints):
            if model.parents[joint] == 0:
                model.jointPlacements[joint] = base * model.jointPlacements[joint]
        for body in bodies.geometryObjects:
            if body.parentJoint == 0:
                body.placement = base * body.placement
        return RandomModel(model, self.frames, bodies)


def random_model(rnd: Random, most: int = MOST) -> RandomModel:
    """A model of one to ``most`` joints that has a chain; others, whose limits contradict each other, are left out."""
    while True:
        drawn = _drawn(rnd, most)
        try:
            _ = drawn.chain().box
        except mik.MetaIKError:  # a follower's limits leave its leader no room, or its leader has none
            continue
        return drawn


def _drawn(rnd: Random, most: int) -> RandomModel:
    count = rnd.randint(1, min(FEW, most)) if rnd.random() < 0.8 else rnd.randint(1, most)
    several = rnd.random() < 0.3  # trees, and branches
    model, ends = pin.Model(), list[int]()
    parent = 0
    for i in range(count):
        if several and rnd.random() < 0.2:
            ends.append(parent)
            parent = rnd.randint(0, model.njoints - 1)
        parent = _add_joint(model, parent, f"joint_{i}", rnd)
    ends = list(dict.fromkeys(j for j in [parent, *reversed(ends)] if j))[: rnd.randint(1, 3)]
    model = _with_followers(model, rnd)
    for i, joint in enumerate(ends):
        model.addFrame(pin.Frame(f"tip_{i}", joint, 0, placement(rnd), pin.FrameType.OP_FRAME))
    return RandomModel(model, tuple(f"tip_{i}" for i in range(len(ends))), _bodies(model, rnd))


def _add_joint(model: pin.Model, parent: int, name: str, rnd: Random) -> int:
    """Add a joint of any kind and return its id; half of them turn about an axis of their frame, as most robots' do."""
    kind = rnd.choice(COMMON if rnd.random() < 0.7 else KINDS)(rnd)
    joint = model.addJoint(parent, kind, placement(rnd), name)
    added = model.joints[joint]
    turns = added.nq == 1 and added.shortname().startswith("JointModelR")
    for i in range(added.nq):
        lower, upper = limits(rnd, turns)
        model.lowerPositionLimit[added.idx_q + i] = lower
        model.upperPositionLimit[added.idx_q + i] = upper
    return joint


def limits(rnd: Random, turns: bool) -> tuple[float, float]:
    """A range, rad or m: mostly one like a robot's; else tiny, of many turns, without zero, or, for a turn, none."""
    size = 1.0 if turns else 0.3
    kind = rnd.random()
    if kind < 0.7:
        return -size * rnd.uniform(0.1, 3.2), size * rnd.uniform(0.1, 3.2)
    if kind < 0.8:
        start = rnd.uniform(-3.0, 3.0)
        return start, start + size * rnd.uniform(0.1, 2.0)
    if kind < 0.87:
        start = rnd.choice([0.0, 0.5, -2.0])
        return start, start + rnd.choice([1e-9, 1e-6, 1e-3])
    if turns and kind < 0.92:
        return -ENDLESS, ENDLESS
    if turns:
        return -rnd.uniform(6.0, 30.0), rnd.uniform(6.0, 30.0)
    return -rnd.uniform(0.5, 5.0), rnd.uniform(0.5, 5.0)


def placement(rnd: Random) -> pin.SE3:
    """From one joint to the next: right angles and any; lengths none, a millimetre, a robot's, metres."""
    kind = rnd.random()
    if kind < 0.3:
        turn = np.eye(3)
    elif kind < 0.7:
        turn = pin.utils.rotate(rnd.choice("xyz"), rnd.choice([-1.0, 1.0]) * math.pi / 2.0)
    else:
        turn = pin.exp3(rnd.uniform(0.0, math.pi) * unit(rnd))
    if rnd.random() < 0.1:
        turn = turn @ pin.exp3(1e-3 * unit(rnd))  # nearly parallel, nearly meeting
    length = rnd.choice([0.0, 0.1, 0.3, 0.3, 0.3, 1e-3, 3.0])
    way = length * (np.eye(3)[rnd.randint(0, 2)] if rnd.random() < 0.5 else unit(rnd))
    return pin.SE3(np.array(turn), way)


def unit(rnd: Random) -> Floats:
    """A unit vector (3,)."""
    z, angle = rnd.uniform(-1.0, 1.0), rnd.uniform(-math.pi, math.pi)
    r = math.sqrt(1.0 - z * z)
    v = np.array([r * math.cos(angle), r * math.sin(angle), z])
    return v / np.linalg.norm(v)


def _composite(rnd: Random) -> pin.JointModel:
    joint = pin.JointModelComposite()
    for _ in range(rnd.randint(1, 3)):
        joint.addJoint(rnd.choice(COMMON)(rnd), placement(rnd))
    return joint


def _universal(rnd: Random) -> pin.JointModel:
    a = unit(rnd)
    b = np.cross(a, np.eye(3)[int(np.argmin(np.abs(a)))])
    return pin.JointModelUniversal(a, b / np.linalg.norm(b))


Kind = Callable[[Random], pin.JointModel]
COMMON: list[Kind] = [
    lambda rnd: pin.JointModelRX(),
    lambda rnd: pin.JointModelRY(),
    lambda rnd: pin.JointModelRZ(),
    lambda rnd: pin.JointModelRZ(),
    lambda rnd: pin.JointModelRevoluteUnaligned(unit(rnd)),
    lambda rnd: pin.JointModelPZ(),
]
KINDS: list[Kind] = [
    *COMMON,
    lambda rnd: pin.JointModelPX(),
    lambda rnd: pin.JointModelPrismaticUnaligned(unit(rnd)),
    lambda rnd: pin.JointModelRUBX(),
    lambda rnd: pin.JointModelRUBZ(),
    lambda rnd: pin.JointModelHY(rnd.choice([0.02, -0.1])),
    lambda rnd: pin.JointModelHelicalUnaligned(unit(rnd), rnd.choice([0.05, -0.3])),
    lambda rnd: pin.JointModelSpherical(),
    lambda rnd: pin.JointModelSphericalZYX(),
    lambda rnd: pin.JointModelTranslation(),
    lambda rnd: pin.JointModelPlanar(),
    lambda rnd: pin.JointModelFreeFlyer(),
    _universal,
    _composite,
]


def _with_followers(model: pin.Model, rnd: Random) -> pin.Model:
    """The model with some joints that follow another of their kind."""
    chosen: list[tuple[int, int]] = []
    for joint in range(2, model.njoints):
        kind = model.joints[joint]
        alike = [j for j in range(1, joint) if kind.nq == 1 and model.joints[j].shortname() == kind.shortname()]
        drawn = alike and "Helical" not in kind.shortname() and rnd.random() < 0.1
        if drawn and "Composite" not in kind.shortname():  # Pinocchio makes no follower of these
            chosen.append((joint, rnd.choice(alike)))
    leaders = {leader for _, leader in chosen}
    for joint, leader in reversed(chosen):  # from the last to the first, so that numbers stay what they are
        if joint not in leaders:
            scale, offset = rnd.choice([1.0, -1.0, 0.5, 2.0]), rnd.choice([0.0, 0.0, 0.3])
            model = pin.transformJointIntoMimic(model, leader, joint, scale, offset)
    return model


def _bodies(model: pin.Model, rnd: Random) -> pin.GeometryModel:
    """A body on every third joint or so, away from its axis, and one that stands."""
    bodies = pin.GeometryModel()
    joints = [0, *(j for j in range(1, model.njoints) if rnd.random() < 0.4)]
    for joint in joints:
        size = rnd.uniform(0.02, 0.1)
        shape = rnd.choice(
            [
                lambda size: coal.Sphere(size),
                lambda size: coal.Box(size, 2.0 * size, 0.5 * size),
                lambda size: coal.Cylinder(size, 2.0 * size),
                lambda size: coal.Capsule(0.5 * size, size),
            ]
        )(size)
        at = pin.SE3(np.array(pin.exp3(unit(rnd))), 0.1 * unit(rnd))
        if joint == 0:
            at.translation = at.translation * 5.0
        frame = model.addFrame(pin.Frame(f"link_{joint}", joint, 0, pin.SE3.Identity(), pin.FrameType.BODY))
        bodies.addGeometryObject(pin.GeometryObject(f"link_{joint}_0", joint, frame, at, shape))
    return bodies
