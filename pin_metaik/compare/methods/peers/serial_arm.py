"""A chain as plain numbers and as a serial URDF: what every inverse-kinematics solver can be given.

Needs numpy alone, so that solvers in environments of their own can read it.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from pin_metaik.kinematics import Chain

BASE, TIP = "base", "tip"  # first and last link of the URDF
FASTEST = 1e3  # rad/s or m/s: URDF wants a velocity limit, the solvers shall not be held by one


@dataclass(frozen=True)
class SerialArm:
    """n joints in a row, each turning about or sliding along the z axis of its own frame.

    Attributes:
        robot: Name that ``pin_metaik.load_robot`` takes.
        names: Of the joints.
        kinds: "revolute", "prismatic" or "continuous".
        origins: (n, 4, 4) each joint frame in the one before it, the first in the world.
        tip: (4, 4) the tip in the last joint frame.
        lower: (n,) rad or m; one turn for a continuous joint, from -pi.
        upper: (n,) rad or m.
    """

    robot: str
    names: tuple[str, ...]
    kinds: tuple[str, ...]
    origins: NDArray[np.float64]
    tip: NDArray[np.float64]
    lower: NDArray[np.float64]
    upper: NDArray[np.float64]

    @classmethod
    def of_chain(cls, robot: str, chain: Chain) -> SerialArm:
        """The arm of a chain with one frame, in which every joint has a coordinate of its own."""
        paths = chain.paths
        if len(chain.frames) != 1 or len(paths.joints) != chain.n or (paths.joints[:, 12:] != (1.0, 0.0)).any():
            raise ValueError(f"{chain} is not a serial arm: it branches, or a joint mimics another")
        rotates = paths.wiring[:, 1].astype(bool)
        free = chain.limits.periodic
        kinds = np.where(free, "continuous", np.where(rotates, "revolute", "prismatic"))
        origins = np.array([_matrix(row) for row in paths.joints])
        box = chain.box
        return cls(robot, chain.names, tuple(kinds.tolist()), origins, _matrix(paths.tips[0]), box.lower, box.upper)

    @classmethod
    def from_json(cls, fields: dict[str, Any]) -> SerialArm:
        """What ``to_json`` wrote."""
        arrays = {name: np.array(fields[name]) for name in ("origins", "tip", "lower", "upper")}
        return cls(fields["robot"], tuple(fields["names"]), tuple(fields["kinds"]), **arrays)

    def to_json(self) -> dict[str, Any]:
        """Lists and strings; floats come back bit for bit."""
        return {name: v.tolist() if isinstance(v, np.ndarray) else v for name, v in asdict(self).items()}

    @property
    def n(self) -> int:
        """Number of joints."""
        return len(self.names)

    @property
    def frames(self) -> NDArray[np.float64]:
        """(n + 1, 4, 4) world placements of the joint frames, then of the tip, with every joint at zero."""
        placements, placement = [], np.eye(4)
        for origin in (*self.origins, self.tip):
            placement = placement @ origin
            placements.append(placement)
        return np.array(placements)

    @property
    def circular(self) -> NDArray[np.bool_]:
        """(n,) True for continuous joints."""
        return np.array([kind == "continuous" for kind in self.kinds])

    def q(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Configuration (nq,) of the URDF's Pinocchio model at coordinates x (n,)."""
        entries: list[float] = []
        for value, circular in zip(x.tolist(), self.circular, strict=True):
            entries += [np.cos(value), np.sin(value)] if circular else [value]
        return np.array(entries)

    def x(self, q: NDArray[np.float64]) -> NDArray[np.float64]:
        """Coordinates (n,) of a configuration (nq,) of the URDF's Pinocchio model."""
        entries = iter(q.tolist())
        cosine_first = ((next(entries), next(entries)) if circular else (next(entries),) for circular in self.circular)
        return np.array([np.arctan2(*e[::-1]) if len(e) == 2 else e[0] for e in cosine_first])

    def urdf(self) -> str:
        """A URDF of bare links from ``base`` to ``tip``."""
        root = ElementTree.Element("robot", name=self.robot)
        links = [BASE, *(f"link{i + 1}" for i in range(self.n)), TIP]
        for link in links:
            ElementTree.SubElement(root, "link", name=link)
        for i, (name, kind) in enumerate(zip(self.names, self.kinds, strict=True)):
            joint = _joint(root, name, kind, links[i], links[i + 1], self.origins[i])
            ElementTree.SubElement(joint, "axis", xyz="0 0 1")
            limit = ElementTree.SubElement(joint, "limit", effort=repr(FASTEST), velocity=repr(FASTEST))
            if kind != "continuous":
                limit.set("lower", repr(float(self.lower[i])))
                limit.set("upper", repr(float(self.upper[i])))
        _joint(root, "at_tip", "fixed", links[-2], TIP, self.tip)
        return ElementTree.tostring(root, encoding="unicode")


def _joint(
    root: ElementTree.Element, name: str, kind: str, parent: str, child: str, origin: NDArray[np.float64]
) -> ElementTree.Element:
    joint = ElementTree.SubElement(root, "joint", name=name, type=kind)
    ElementTree.SubElement(joint, "parent", link=parent)
    ElementTree.SubElement(joint, "child", link=child)
    ElementTree.SubElement(joint, "origin", xyz=_numbers(origin[:3, 3]), rpy=_numbers(_rpy(origin[:3, :3])))
    return joint


def _rpy(R: NDArray[np.float64]) -> tuple[float, float, float]:
    """Angles with R = Rz(yaw) Ry(pitch) Rx(roll), to the last digits at a pitch of 90 degrees too."""
    yaw = np.arctan2(R[1, 0], R[0, 0])
    pitch = np.arctan2(-R[2, 0], np.hypot(R[0, 0], R[1, 0]))
    side = np.array([-np.sin(yaw), np.cos(yaw), 0.0])  # what Rz(yaw) makes of y: roll turns within (side, side x ...)
    return float(np.arctan2(-side @ R[:, 2], side @ R[:, 1])), float(pitch), float(yaw)


def _numbers(values: Any) -> str:
    return " ".join(repr(float(v)) for v in values)


def _matrix(flat: NDArray[np.float64]) -> NDArray[np.float64]:
    matrix = np.eye(4)
    matrix[:3, :3] = flat[:9].reshape(3, 3)
    matrix[:3, 3] = flat[9:12]
    return matrix
