"""A robot to solve for, by name or by file: its Pinocchio model now, its geometry when it is asked for."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, fields
from functools import cached_property
from pathlib import Path
from types import ModuleType

import pinocchio as pin

from pin_metaik.arguments import checked_as
from pin_metaik.errors import InvalidModel, InvalidTable, UnknownName
from pin_metaik.robots.description import Base, Description
from pin_metaik.robots.library import LEFT_OUT, TIPS, catalogue, example_robots
from pin_metaik.robots.loops import Loops
from pin_metaik.robots.macros import expanded, is_xacro
from pin_metaik.robots.plausible import angles_in_radians
from pin_metaik.robots.table import read_table
from pin_metaik.robots.text import read_text
from pin_metaik.robots.tips import default_tip
from pin_metaik.robots.urdf import to_urdf
from pin_metaik.robots.wording import Shapes
from pin_metaik.said import warn

SUFFIXES = (".urdf", ".xml", ".mjcf", ".xacro", ".sdf", ".toml")


@dataclass(frozen=True, eq=False)
class Robot:
    """A robot: model, default tip frame and, when first asked for, geometry.

    Attributes:
        name: Name it was asked for by, or the one its file gives.
        model: Its ``pin.Model``.
        frame: Default tip frame: one that at least one joint moves, under a name no other link has.
        description: The source of the model: plain values that pickle, where a model with mimic joints does not.
        srdf: File with reference configurations and disabled collisions, or None.
        remarks: What was assumed, repaired or ignored while reading it; ``load_robot`` warns of each.
    """

    name: str
    model: pin.Model = field(repr=False)
    frame: str
    description: Description = field(repr=False)
    srdf: Path | None = None
    remarks: tuple[str, ...] = field(default=(), repr=False)

    @property
    def urdf(self) -> str:
        """Its URDF text, or MJCF text if it was one; for a DH table the URDF made from it."""
        return self.description.text

    @property
    def source(self) -> Path | None:
        """The file it comes from; None, if it was given as text."""
        return self.description.source

    @cached_property
    def collision_model(self) -> pin.GeometryModel:
        """Collision geometry, read on first use; it comes without collision pairs.

        Raises:
            InvalidModel: If a mesh or a shape is missing or unreadable; the message names it.
        """
        return self._geometry("collision")

    @cached_property
    def visual_model(self) -> pin.GeometryModel:
        """Visual geometry, read on first use.

        Raises:
            InvalidModel: If a mesh or a shape is missing or unreadable; the message names it.
        """
        return self._geometry("visual")

    def __getstate__(self) -> dict[str, object]:
        """Pickle without the geometry: megabytes, read again on first use."""
        return {one.name: getattr(self, one.name) for one in fields(self)}

    @property
    def free_mimics(self) -> tuple[str, ...]:
        """Joints with a mimic tag in the URDF that are free in the model."""
        return self.description.free_mimics()

    @cached_property
    def loops(self) -> Loops:
        """Closed loops of its MJCF, which are open in the model, a tree; the goal ``goals.Loop`` closes one."""
        return self.description.loops()

    def _geometry(self, shapes: Shapes) -> pin.GeometryModel:
        geometry, remarks = self.description.geometry(self.model, shapes)
        _say(self.name, remarks)
        return geometry


class RobotName(str):
    """The name of a robot that can be loaded: a string with a few facts about the robot.

    Attributes:
        name: The string itself.
        source: "catalogue" or "example-robot-data".
        dof: Degrees of freedom, fingers and all (``model.nv``).
        frame: Default tip frame.
    """

    source: str
    dof: int
    frame: str

    def __new__(cls, name: str, source: str, dof: int, frame: str) -> RobotName:
        """The string ``name`` with its attributes."""
        self = super().__new__(cls, name)
        self.source, self.dof, self.frame = source, dof, frame
        return self

    def __reduce__(self) -> tuple[type[RobotName], tuple[str, str, int, str]]:
        return RobotName, (self.name, self.source, self.dof, self.frame)

    @property
    def name(self) -> str:
        """The name as a plain string."""
        return str.__str__(self)


def robot_names() -> list[RobotName]:
    """Every robot that ``load_robot`` knows by name, the catalogue first; builds all models, in a second."""
    return [name for name, _ in named_robots()]


def named_robots() -> Iterator[tuple[RobotName, Robot]]:
    """Every robot that ``load_robot`` knows by name, the catalogue first, and what is known of its name."""
    sources = (("catalogue", [*catalogue()]), ("example-robot-data", [*example_robots()]))
    for source, names in sources:
        for name in names:
            robot = _loaded(name, None, "fixed", True)
            yield RobotName(robot.name, source, robot.model.nv, robot.frame), robot


@checked_as(InvalidModel)
def load_robot(
    name: str | Path | RobotName | ModuleType,
    *,
    parameters: Mapping[str, float | str | bool] | None = None,
    free_flyer: bool = False,
    planar: bool = False,
    mimic: bool = True,
) -> Robot:
    """Load a robot.

    Whatever was assumed, repaired or ignored while reading it is a ``UserWarning`` of one line that names the joint or
    link; these lines are also in ``robot.remarks``.

    Args:
        name: Name in the catalogue or in example-robot-data (also as ``robot_names`` gives it), path of a URDF, of an
            MJCF or of a DH table's ``.toml``, the text of a URDF or an MJCF, or a module that has its path as
            ``URDF_PATH`` or ``MJCF_PATH``, as those of the package robot_descriptions. A URDF may be xacro, which the
            extra ``xacro`` expands: its expressions are run as Python, so take none from strangers.
        parameters: Values that replace those of a DH table's ``[parameters]``, in the table's units, or of the
            ``<xacro:arg>`` of a xacro file.
        free_flyer: Let the base move freely: six more coordinates. A chain needs limits for ``root_joint.x``, ``.y``
            and ``.z`` (m). Otherwise the base is fixed.
        planar: Let the base move in a plane: three more coordinates. A chain needs limits for ``root_joint.x`` and
            ``.y`` (m).
        mimic: Make joints with a mimic tag scaled copies of the joint they follow instead of coordinates of their own
            (Pinocchio's ``aba`` refuses such models); their limits then bound the joint they follow. Joints whose tag
            is invalid stay free; ``robot.free_mimics`` names them.

    Raises:
        UnknownName: If there is no robot of that name, or the table has no such parameter.
        InvalidTable: If the DH table makes no sense.
        InvalidModel: If the file is missing or does not describe a robot, if no joint of it moves a frame, or if both
            ``free_flyer`` and ``planar`` are set.
        MissingExtra: If it is a xacro file and xacro is not installed.
    """
    if free_flyer and planar:
        raise InvalidModel("a base is on a free-flyer or on a plane: give free_flyer or planar, not both")
    robot = _loaded(name, parameters, "free flyer" if free_flyer else "planar" if planar else "fixed", mimic)
    _say(robot.name, robot.remarks)
    return robot


def _loaded(
    name: str | Path | ModuleType, parameters: Mapping[str, float | str | bool] | None, base: Base, mimic: bool
) -> Robot:
    label, content, srdf = _located(name)
    source, remarks = content if isinstance(content, Path) else None, list[str]()
    if source is not None and source.suffix.lower() == ".toml":
        table = read_table(source, parameters)
        label, text, remarks = label or table.name, to_urdf(table), angles_in_radians(table)
    else:
        text = str(content) if source is None else read_text(source)
        what = str(source or "the text")
        if is_xacro(text, what):
            text = expanded(text, source, what, parameters or {})
        elif parameters:
            raise InvalidTable(f"{label or what} has no parameters: only DH tables and xacro files have")
    description = Description(text, source, base, mimic)
    model, said = description.read()
    label = label or model.name
    frame = TIPS.get(label, "")
    frame = frame if model.existFrame(frame) else default_tip(model)
    if not frame:
        raise InvalidModel(f"{description.what} has no frame that a joint moves")
    return Robot(label, model, frame, description, srdf, (*remarks, *said))


def _located(name: str | Path | ModuleType) -> tuple[str, str | Path, Path | None]:
    """Label (empty if the content has it), file or text, and SRDF of a robot."""
    if isinstance(name, ModuleType):
        paths = [getattr(name, kind, None) for kind in ("URDF_PATH", "MJCF_PATH")]
        found = next((Path(path) for path in paths if isinstance(path, (str, Path))), None)
        if found is None:
            raise InvalidModel(f"module {name.__name__!r} describes no robot: it has neither URDF_PATH nor MJCF_PATH")
        return "", found, None
    if not isinstance(name, (str, Path)):
        raise InvalidModel(f"a robot is a name or a path, got {name!r}")
    if isinstance(name, str):
        name = str.__str__(name)
        if name in catalogue():
            return name, catalogue()[name], None
        if name in example_robots():
            return name, *example_robots()[name]
        if name in LEFT_OUT:
            raise InvalidModel(f"{name!r} of example-robot-data cannot be loaded: {LEFT_OUT[name]}")
        if "<" in name:
            return "", name, None
        path = Path(name).expanduser()
        if not (len(path.parts) > 1 or path.suffix.lower() in SUFFIXES or _is_file(path)):
            raise UnknownName("robot", name, {*catalogue(), *example_robots()})
        return "", path, None
    return "", name.expanduser(), None


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except OSError:  # longer than a file's name can be
        return False


def _say(name: str, remarks: Iterable[str]) -> None:
    for remark in remarks:
        warn(f"{name}: {remark}")
