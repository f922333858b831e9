"""Goals that a configuration meets by construction, each with a test in Pinocchio and NumPy that knows no goal."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

import pin_metaik as mik
from pin_metaik import goals

Floats: TypeAlias = NDArray[np.float64]
NEAR = 1.01e-5  # m and rad: the default tolerance and a rounding


class Truth:
    """A robot at q (nq,), by scratch of its own."""

    def __init__(self, model: pin.Model, q: Floats) -> None:
        self.model, self.q, self.data = model, q, model.createData()
        pin.framesForwardKinematics(model, self.data, q)

    def pose(self, frame: str, reference: str | None = None) -> pin.SE3:
        """Pose of a frame, a link where a joint has its name, too."""
        ids = [i for i, one in enumerate(self.model.frames) if one.name == frame]
        links = [i for i in ids if self.model.frames[i].type == pin.FrameType.BODY]
        pose = self.data.oMf[(links or ids)[0]]
        return pose if reference is None else self.pose(reference).inverse() * pose

    def joint(self, name: str) -> Floats:
        """Entries of a joint in q."""
        joint = self.model.joints[self.model.getJointId(name)]
        return self.q[joint.idx_q : joint.idx_q + joint.nq]

    @property
    def mass(self) -> Floats:
        """(3,) centre of mass."""
        return np.array(pin.centerOfMass(self.model, self.data, self.q))


@dataclass(frozen=True)
class Case:
    """A goal, and whether a robot meets it.

    Attributes:
        goal: The goal.
        holds: By Pinocchio and NumPy alone.
    """

    goal: Any
    holds: Callable[[Truth], bool]


@dataclass(frozen=True)
class Robot:
    """A robot that goals are made for.

    Attributes:
        chain: Its chain.
        tip: The chain's frame, or one of two.
        other: A frame that the chain moves, but not as the tip.
    """

    chain: mik.Chain
    tip: str
    other: str


def angle(a: Floats, b: Floats) -> float:
    """Between two vectors (3,)."""
    return float(np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b))


def unit(rng: np.random.Generator, n: int = 3) -> Floats:
    """A direction (n,)."""
    v = rng.normal(size=n)
    return v / np.linalg.norm(v)


def position(robot: Robot, at: Truth, rng: np.random.Generator) -> Case:
    """The tip is where it is."""
    p = at.pose(robot.tip).translation.copy()
    return Case(mik.Target.at(p, frame=robot.tip), lambda t: np.linalg.norm(t.pose(robot.tip).translation - p) <= NEAR)


def pose(robot: Robot, at: Truth, rng: np.random.Generator) -> Case:
    """The tip has the pose that it has."""
    P = at.pose(robot.tip).copy()
    return Case(mik.Target(P, robot.tip), lambda t: _same(P, t.pose(robot.tip)))


def relative_pose(robot: Robot, at: Truth, rng: np.random.Generator) -> Case:
    """The tip as another frame sees it."""
    P = at.pose(robot.tip, robot.other).copy()
    goal = goals.FramePose(robot.tip, P, reference=robot.other)
    return Case(goal, lambda t: _same(P, t.pose(robot.tip, robot.other)))


def other_position(robot: Robot, at: Truth, rng: np.random.Generator) -> Case:
    """A frame that is no tip of the chain."""
    p = at.pose(robot.other).translation.copy()
    goal = goals.FramePose.at(robot.other, p)
    return Case(goal, lambda t: np.linalg.norm(t.pose(robot.other).translation - p) <= NEAR)


def on_line(robot: Robot, at: Truth, rng: np.random.Generator) -> Case:
    """The tip on a line through where it is."""
    p, d = at.pose(robot.tip).translation.copy(), unit(rng)
    goal = goals.OnLine(robot.tip, p + d, d)
    return Case(goal, lambda t: np.linalg.norm(np.cross(t.pose(robot.tip).translation - p, d)) <= NEAR)


def on_segment(robot: Robot, at: Truth, rng: np.random.Generator) -> Case:
    """The tip on a part of a line that begins where it is."""
    p, d = at.pose(robot.tip).translation.copy(), unit(rng)
    goal = goals.OnLine(robot.tip, p, d, least=0.0, most=0.05)

    def holds(t: Truth) -> bool:
        away = t.pose(robot.tip).translation - p
        return bool(np.linalg.norm(np.cross(away, d)) <= NEAR and -NEAR <= away @ d <= 0.05 + NEAR)

    return Case(goal, holds)


def on_plane(robot: Robot, at: Truth, rng: np.random.Generator) -> Case:
    """The tip on a plane through where it is."""
    p, n = at.pose(robot.tip).translation.copy(), unit(rng)
    goal = goals.OnPlane(robot.tip, p, n)
    return Case(goal, lambda t: abs(n @ (t.pose(robot.tip).translation - p)) <= NEAR)


def in_box(robot: Robot, at: Truth, rng: np.random.Generator) -> Case:
    """The tip in a box of 2 cm, at a corner of which it is."""
    turn = pin.Quaternion(unit(rng, 4)).toRotationMatrix()
    box = pin.SE3(turn, at.pose(robot.tip).translation)
    goal = goals.InBox(robot.tip, (0, 0, 0), (0.02, 0.02, 0.02), pose=box)

    def holds(t: Truth) -> bool:
        p = turn.T @ (t.pose(robot.tip).translation - box.translation)
        return bool((p >= -NEAR).all() and (p <= 0.02 + NEAR).all())

    return Case(goal, holds)


def distance(robot: Robot, at: Truth, rng: np.random.Generator) -> Case:
    """The tip as far from a point as it is."""
    p = at.pose(robot.tip).translation + rng.uniform(0.1, 0.5) * unit(rng)
    d = float(np.linalg.norm(at.pose(robot.tip).translation - p))
    goal = goals.Distance(robot.tip, p, least=d, most=d)
    return Case(goal, lambda t: abs(np.linalg.norm(t.pose(robot.tip).translation - p) - d) <= NEAR)


def apart(robot: Robot, at: Truth, rng: np.random.Generator) -> Case:
    """Two frames at least as far from each other as they are."""
    d = float(np.linalg.norm(at.pose(robot.tip, robot.other).translation))
    goal = goals.Distance(robot.tip, (0, 0, 0), reference=robot.other, least=d)
    return Case(goal, lambda t: np.linalg.norm(t.pose(robot.tip, robot.other).translation) >= d - NEAR)


def pointing(robot: Robot, at: Truth, rng: np.random.Generator) -> Case:
    """An axis of the tip along, or against, a direction."""
    against = bool(rng.integers(2))
    d = at.pose(robot.tip).rotation[:, 2] * (-1.0 if against else 1.0)
    goal = goals.Pointing(robot.tip, "-z" if against else "z", d)
    return Case(goal, lambda t: angle(t.pose(robot.tip).rotation[:, 2] * (-1.0 if against else 1.0), d) <= NEAR)


def in_cone(robot: Robot, at: Truth, rng: np.random.Generator) -> Case:
    """An axis of the tip at 0.95 of the angle of a cone."""
    axis = at.pose(robot.tip).rotation[:, 0]
    side = np.cross(axis, unit(rng))
    d = pin.exp3(0.95 * 0.1 * side / np.linalg.norm(side)) @ axis
    goal = goals.Pointing(robot.tip, "x", d, tolerance=0.1)
    return Case(goal, lambda t: angle(t.pose(robot.tip).rotation[:, 0], d) <= 0.1 + NEAR)


def relative_axis(robot: Robot, at: Truth, rng: np.random.Generator) -> Case:
    """An axis of the tip as another frame sees it."""
    d = at.pose(robot.tip, robot.other).rotation[:, 1].copy()
    goal = goals.Pointing(robot.tip, "y", d, reference=robot.other)
    return Case(goal, lambda t: angle(t.pose(robot.tip, robot.other).rotation[:, 1], d) <= NEAR)


def look_at(robot: Robot, at: Truth, rng: np.random.Generator) -> Case:
    """The tip looks at a point."""
    P = at.pose(robot.tip)
    c = P.translation + rng.uniform(0.2, 1.0) * P.rotation[:, 2]
    goal = goals.LookAt(robot.tip, c)
    return Case(goal, lambda t: angle(t.pose(robot.tip).rotation[:, 2], c - t.pose(robot.tip).translation) <= NEAR)


def look_at_frame(robot: Robot, at: Truth, rng: np.random.Generator) -> Case:
    """The tip looks at another frame, within a cone."""
    P = at.pose(robot.tip, robot.other)
    axis = P.rotation.T @ -P.translation
    goal = goals.LookAt(robot.tip, (0, 0, 0), axis, reference=robot.other, tolerance=0.01)

    def holds(t: Truth) -> bool:
        Q = t.pose(robot.tip, robot.other)
        return angle(Q.rotation @ axis, -Q.translation) <= 0.01 + NEAR

    return Case(goal, holds)


def joint(robot: Robot, at: Truth, rng: np.random.Generator) -> Case:
    """One joint where it is."""
    c = int(rng.integers(robot.chain.n))
    name, value = robot.chain.names[c], float(robot.chain.x(at.q)[c])
    goal = goals.Posture({name: value})
    there = at.joint(name).copy()
    return Case(goal, lambda t: np.linalg.norm(t.joint(name) - there) <= NEAR)


def posture(robot: Robot, at: Truth, rng: np.random.Generator) -> Case:
    """All joints within 0.2 rad or m of a configuration, in all."""
    x = robot.chain.x(at.q)
    step = unit(rng, robot.chain.n) * 0.19
    near = robot.chain.q(robot.chain.limits.clip(x + step))
    goal = goals.Posture(near, tolerance=0.2)

    def holds(t: Truth) -> bool:
        way = pin.difference(t.model, near, t.q)
        return bool(
            np.linalg.norm([way[t.model.joints[t.model.getJointId(n)].idx_v] for n in robot.chain.names]) <= 0.2 + NEAR
        )

    return Case(goal, holds)


def mid_range(robot: Robot, at: Truth, rng: np.random.Generator) -> Case:
    """All joints at least as far from their limits as the worst one is."""
    lower, upper = robot.chain.limits.lower, robot.chain.limits.upper
    some = np.isfinite(lower) & np.isfinite(upper)
    names = [name for name, counts in zip(robot.chain.names, some, strict=True) if counts]
    middle, half = 0.5 * (lower + upper)[some], 0.5 * (upper - lower)[some]

    def share(t: Truth) -> float:
        return float(np.abs((np.array([t.joint(name)[0] for name in names]) - middle) / half).max())

    most = share(at)
    return Case(goals.MidRange(most), lambda t: share(t) <= most + NEAR)


def manipulability(robot: Robot, at: Truth, rng: np.random.Generator) -> Case:
    """As manipulable as it is."""

    def measure(t: Truth) -> float:
        number = next(
            i for i, one in enumerate(t.model.frames) if one.name == robot.tip and one.type == pin.FrameType.BODY
        )
        J = pin.computeFrameJacobian(t.model, t.data, t.q, number, pin.LOCAL)
        J = J[:3, [t.model.joints[t.model.getJointId(n)].idx_v for n in robot.chain.names]]
        return float(np.sqrt(max(np.linalg.det(J @ J.T), 0.0)))

    least = measure(at)
    return Case(goals.Manipulability(robot.tip, least, "position"), lambda t: measure(t) >= least - NEAR)


def mass_over(robot: Robot, at: Truth, rng: np.random.Generator) -> Case:
    """The centre of mass over a square of 2 cm, near a corner of which it is."""
    c = at.mass[:2]
    square = c + np.array([[0.0, 0.0], [0.02, 0.0], [0.02, 0.02], [0.0, 0.02]]) - 0.001
    goal = goals.CentreOfMass(square)
    return Case(goal, lambda t: bool((np.abs(t.mass[:2] - square.mean(axis=0)) <= 0.01 + NEAR).all()))


def mass_height(robot: Robot, at: Truth, rng: np.random.Generator) -> Case:
    """The centre of mass at the height where it is."""
    z = float(at.mass[2])
    return Case(goals.CentreOfMass(least=z, most=z), lambda t: abs(t.mass[2] - z) <= NEAR)


def custom(robot: Robot, at: Truth, rng: np.random.Generator) -> Case:
    """A weighted sum of sines of q is what it is."""
    w = rng.normal(size=robot.chain.model.nq)
    there = float(w @ np.sin(at.q))
    return Case(goals.Custom(lambda q: w @ np.sin(q) - there), lambda t: abs(w @ np.sin(t.q) - there) <= NEAR)


Make: TypeAlias = Callable[[Robot, Truth, np.random.Generator], Case]
ALONE: dict[str, tuple[Make, ...]] = {
    make.__name__.replace("_", " "): (make,)
    for make in (
        pose, position, relative_pose, other_position, on_line, on_segment, on_plane, in_box, distance, apart, pointing,
        in_cone, relative_axis, look_at, look_at_frame, joint, posture, mid_range, manipulability, mass_over,
        mass_height, custom,
    )
}  # fmt: skip
TOGETHER: dict[str, tuple[Make, ...]] = {
    "cup upright at a place": (position, in_cone),
    "along a line, pointing": (on_line, pointing),
    "on a plane, looking at a point": (on_plane, look_at),
    "in a box, looking, a joint held": (in_box, look_at, joint),
    "at a distance, pointing, away from limits": (distance, pointing, mid_range),
    "pose, centre of mass over a polygon": (pose, mass_over),
    "pose, another frame apart": (pose, apart),
    "place, posture": (position, posture),
    "relative axis, plane, a function of q": (relative_axis, on_plane, custom),
    "looking from a distance, manipulable": (look_at, distance, manipulability),
}


def _same(a: pin.SE3, b: pin.SE3) -> bool:
    error = a.actInv(b)
    return bool(np.linalg.norm(error.translation) <= NEAR and np.linalg.norm(pin.log3(error.rotation)) <= NEAR)
