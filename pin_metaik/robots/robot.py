"""A robot to solve for, by name or by file: its Pinocchio model now, its geometry when somebody asks."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import pinocchio as pin

from pin_metaik.arguments import checked_as
from pin_metaik.errors import InvalidModel, InvalidTable, UnknownName
from pin_metaik.robots.description import Description, build_geometry, mimic_joints, read_urdf
from pin_metaik.robots.library import LEFT_OUT, TIPS, catalogue, example_robots
from pin_metaik.robots.table import read_table
from pin_metaik.robots.urdf import to_urdf


@dataclass(frozen=True, eq=False)
class Robot:
    """A robot: model, default tip frame and, when first asked for, geometry.

    Attributes:
        name: Name it was asked for by, or the one its file gives.
        model: Its ``pin.Model``.
        frame: Default tip frame: one that at least one joint moves, under a name no other frame has.
        description: What the model is made from: plain values that pickle, where a model with mimic joints does not.
        srdf: File with reference configurations and disabled collisions, or None.
    """

    name: str
    model: pin.Model = field(repr=False)
    frame: str
    description: Description = field(repr=False)
    srdf: Path | None = None

    @property
    def urdf(self) -> str:
        """Its URDF text; that of a DH table is written from it."""
        return self.description.urdf

    @property
    def source(self) -> Path:
        """The file it comes from."""
        return self.description.source

    @cached_property
    def collision_model(self) -> pin.GeometryModel:
        """Collision geometry, read on first use; it comes without collision pairs.

        Raises:
            InvalidModel: If a mesh is missing or unreadable; the message names it.
        """
        return self._geometry(pin.GeometryType.COLLISION)

    @cached_property
    def visual_model(self) -> pin.GeometryModel:
        """Visual geometry, read on first use.

        Raises:
            InvalidModel: If a mesh is missing or unreadable; the message names it.
        """
        return self._geometry(pin.GeometryType.VISUAL)

    def __getstate__(self) -> dict[str, object]:
        """Pickle without the geometry: megabytes, read again on first use."""
        return {one.name: getattr(self, one.name) for one in fields(self)}

    @property
    def free_mimics(self) -> tuple[str, ...]:
        """Joints that should follow another one by the URDF, but are free in the model."""
        held = {self.model.names[i] for i in self.model.mimicking_joints}
        return tuple(name for name in mimic_joints(self.urdf) if name not in held)

    def _geometry(self, kind: pin.GeometryType) -> pin.GeometryModel:
        return build_geometry(self.model, self.urdf, self.source, kind)


class RobotName(NamedTuple):
    """A robot that can be loaded by name.

    Attributes:
        name: What ``load_robot`` takes.
        source: "catalogue" or "example-robot-data".
        dof: Degrees of freedom, fingers and all (``model.nv``).
        frame: Default tip frame.
    """

    name: str
    source: str
    dof: int
    frame: str


def robot_names() -> list[RobotName]:
    """Every robot that ``load_robot`` knows by name, the catalogue first; builds all models, in half a second."""
    sources = {"catalogue": list(catalogue()), "example-robot-data": list(example_robots())}
    loaded = ((load_robot(name), source) for source, names in sources.items() for name in names)
    return [RobotName(robot.name, source, robot.model.nv, robot.frame) for robot, source in loaded]


@checked_as(InvalidModel)
def load_robot(
    name: str | Path | RobotName,
    *,
    parameters: Mapping[str, float] | None = None,
    free_flyer: bool = False,
    mimic: bool = True,
) -> Robot:
    """Load a robot.

    Args:
        name: Name in the catalogue or in example-robot-data (also as ``robot_names`` gives it), or path of a ``.urdf``
            or of a DH table's ``.toml``.
        parameters: Values that replace those of a DH table's ``[parameters]``, in the table's units.
        free_flyer: Put the base on a free-flyer (six more coordinates); otherwise it is fixed.
        mimic: Make joints with a mimic tag scaled copies of the joint they follow instead of coordinates of their own
            (Pinocchio's ``aba`` refuses such models). Where Pinocchio cannot hold the tags, all joints are free and
            ``robot.free_mimics`` names them.

    Raises:
        UnknownName: If nothing is so named, or the table has no such parameter.
        InvalidTable: If the DH table makes no sense.
        InvalidModel: If the file is missing, is not a URDF, or no joint of it moves anything.
        InvalidBounds: If a joint's lower limit is above its upper one.
    """
    label, path, srdf = _locate(name.name if isinstance(name, RobotName) else name)
    if path.suffix.lower() == ".toml":
        table = read_table(path, parameters)
        label, urdf = label or table.name, to_urdf(table)
    elif parameters:
        raise InvalidTable(f"{name} has no parameters: only DH tables have")
    else:
        urdf = read_urdf(path)
    description = Description(urdf, path, "free flyer" if free_flyer else "fixed", mimic)
    model = description.model()
    label = label or model.name
    return Robot(label, model, _tip(model, TIPS.get(label, "tool0"), path), description, srdf)


def _locate(name: str | Path) -> tuple[str, Path, Path | None]:
    """Label (empty for a path), file and SRDF of a robot."""
    if not isinstance(name, (str, Path)):
        raise InvalidModel(f"a robot is a name or a path, got {name!r}")
    path = Path(name).expanduser()
    if isinstance(name, Path) or len(path.parts) > 1 or path.suffix.lower() in (".urdf", ".toml"):
        if path.suffix.lower() not in (".urdf", ".toml"):
            raise InvalidModel(f"cannot load {path}: a robot is a .urdf file, a DH table (.toml) or a name")
        return "", path, None
    if name in catalogue():
        return name, catalogue()[name], None
    if name in LEFT_OUT:
        raise InvalidModel(f"{name!r} of example-robot-data cannot be loaded: {LEFT_OUT[name]}")
    if name not in example_robots():
        raise UnknownName("robot", name, {*catalogue(), *example_robots()})
    return name, *example_robots()[name]


def _tip(model: pin.Model, usual: str, path: Path) -> str:
    """The usual tip if the model has it, else the leaf that most joints move (of equals, the first by name)."""
    frames = list(model.frames)
    count = Counter(f.name for f in frames)
    inner = {f.parentFrame for f in frames}
    depth = {
        f.name: (i not in inner, len(model.supports[f.parentJoint]))
        for i, f in enumerate(frames)
        if f.parentJoint > 0 and count[f.name] == 1
    }
    if not depth:
        raise InvalidModel(f"{path} has no frame that a joint moves")
    return usual if usual in depth else min(depth, key=lambda name: (*(-d for d in depth[name]), name))
