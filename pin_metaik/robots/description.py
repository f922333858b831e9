"""The source of a model, and Pinocchio's models of it; errors in reading are raised as ours."""

from __future__ import annotations

import os
import re
import tempfile
import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal
from weakref import WeakKeyDictionary

import pinocchio as pin

from pin_metaik.arguments import checked, checked_as
from pin_metaik.errors import InvalidModel
from pin_metaik.mesh_files import check_mesh
from pin_metaik.optimize.settings import one_of
from pin_metaik.robots import plausible
from pin_metaik.robots.couplings import NO_COUPLINGS, coupled, make_ready, read_couplings, with_own_names
from pin_metaik.robots.loops import Loops, equalities_not_read, read_loops
from pin_metaik.robots.macros import sign_of_xacro
from pin_metaik.robots.prints import caught_prints, explain
from pin_metaik.robots.spelling import misspelt
from pin_metaik.robots.text import mjcf_meshes, outermost, parsed
from pin_metaik.robots.wording import Shapes, motion_of, negative_sizes, shapes_of

Base = Literal["fixed", "free flyer", "planar"]
ROOTS = {"free flyer": pin.JointModelFreeFlyer, "planar": pin.JointModelPlanar}
KINDS: dict[Shapes, pin.GeometryType] = {
    "collision": pin.GeometryType.COLLISION,
    "visual": pin.GeometryType.VISUAL,
}


@checked_as(InvalidModel)
@dataclass(frozen=True)
class Description:
    """The source of a model as plain values, from which another process can build the same model.

    Attributes:
        text: The URDF, or the MJCF.
        source: The file it was read from, relative to which meshes are looked for; None if it was given as text.
        base: The joint between the world and the base.
        mimic: Whether joints with a mimic tag follow their joint instead of being free.
    """

    text: str = field(repr=False)
    source: Path | None
    base: Base = "fixed"
    mimic: bool = True

    def __post_init__(self) -> None:
        """Raises InvalidSetting for an unknown base."""
        one_of("base", self.base, Base)

    @property
    def what(self) -> str:
        """Its name in messages."""
        return str(self.source or f"the {'MJCF' if self.is_mjcf else 'URDF'} text")

    @property
    def is_mjcf(self) -> bool:
        """Whether it is MJCF, MuJoCo's format."""
        return outermost(self.text) == "mujoco"

    def model(self) -> pin.Model:
        """The model, built anew, and remembered with its source (``description_of``).

        Raises:
            InvalidModel: If the text is not a robot; the message has the parser's own reason.
        """
        return self.read()[0]

    def read(self) -> tuple[pin.Model, list[str]]:
        """The model, and remarks on what was assumed, repaired or ignored.

        Raises:
            InvalidModel: If the text is not a robot; the message has the parser's own reason.
        """
        model, remarks = self._read_mjcf() if self.is_mjcf else self._read_urdf()
        _MADE_FROM[model] = self
        return model, remarks

    @checked
    def geometry(self, model: pin.Model, shapes: Shapes) -> tuple[pin.GeometryModel, list[str]]:
        """Geometry of the model, meshes included, and remarks on what was assumed, repaired or ignored.

        ``package://`` and relative paths are looked up in the folders above ``source``, the nearest first, then in
        ROS_PACKAGE_PATH.

        Raises:
            InvalidModel: If a mesh is missing or unreadable, or a shape cannot be read; the message names it.
            InvalidSetting: If ``shapes`` is not one of the two kinds of geometry.
        """
        one_of("shapes", shapes, Shapes)
        geometry = self._mjcf_geometry(model, shapes) if self.is_mjcf else self._urdf_geometry(model, shapes)
        return geometry, plausible.meshes(geometry)

    def tree(self) -> ET.Element:
        """The elements of a URDF.

        Raises:
            InvalidModel: If it is not a URDF: other XML, not well-formed, or xacro that was not expanded.
        """
        if outermost(self.text) == "sdf":
            raise InvalidModel(f"{self.what} is SDF, which Pinocchio's wheels cannot read: convert it to URDF or MJCF")
        tree = parsed(self.text, self.what)
        if sign := sign_of_xacro(tree):
            raise InvalidModel(f"{self.what} is xacro that was not expanded: it has {sign}; run xacro on it first")
        return tree

    def free_mimics(self) -> tuple[str, ...]:
        """Joints with a mimic tag that are free in the model: those whose tag is invalid or, without ``mimic``, all."""
        if self.is_mjcf:
            return ()
        motion, _ = motion_of(self.tree(), self.what)
        if self.mimic:
            return tuple(read_couplings(motion, self.what).broken)
        return tuple(j.get("name", "") for j in motion.iterfind("joint[mimic]") if j.get("type") != "fixed")

    def loops(self) -> Loops:
        """The closed loops of an MJCF, as Pinocchio's constraints; a URDF is a tree."""
        if not self.is_mjcf:
            return ()
        with self._file() as path, caught_prints():
            return read_loops(path, self.text)

    def _root(self) -> tuple[pin.JointModel, ...]:
        return () if self.base == "fixed" else (ROOTS[self.base](),)

    def _read_urdf(self) -> tuple[pin.Model, list[str]]:
        tree = self.tree()
        motion, mended = motion_of(tree, self.what)
        couplings = read_couplings(motion, self.what) if self.mimic else NO_COUPLINGS
        renamed = make_ready(motion, couplings)
        with caught_prints() as prints:
            try:
                model = pin.buildModelFromXML(ET.tostring(motion, encoding="unicode"), *self._root())
            except (ValueError, RuntimeError) as error:
                raise InvalidModel(f"{self.what} is not a valid URDF: {prints() or explain(error)}") from None
            printed = list(filter(None, [prints()]))
        children = {joint.get("name", ""): child.get("link", "") for joint in motion.iterfind("joint")
                    if (child := joint.find("child")) is not None}  # fmt: skip
        if lost := [link for name, link in children.items() if not model.existFrame(name)]:
            raise InvalidModel(f"{self.what} has links that are joined in a circle, without a root: {', '.join(lost)}")
        if renamed:
            with_own_names(model)
        model, contradictions = coupled(model, couplings)
        free = [f"{wrong}: it is free" for wrong in couplings.broken.values()]
        remarks = [*misspelt(tree), *mended, *printed, *plausible.numbers(tree), *free, *contradictions]
        return model, remarks

    def _urdf_geometry(self, model: pin.Model, shapes: Shapes) -> pin.GeometryModel:
        tree = self.tree()
        if wrong := negative_sizes(tree, shapes):
            raise InvalidModel(
                f"the {shapes} geometry of {self.what} has a size that is infinite or below zero: {'; '.join(wrong)}"
            )
        shaped, counts = shapes_of(tree, shapes)
        text = ET.tostring(shaped, encoding="unicode")
        folders = [str(folder) for folder in (self.source or Path("here")).absolute().parents]
        _check_meshes((mesh.get("filename", "") for mesh in tree.iter("mesh")), folders)
        with caught_prints() as prints:
            try:
                geometry = pin.buildGeomFromUrdfString(model, text, KINDS[shapes], package_dirs=folders)
            except (ValueError, RuntimeError) as error:
                looked = "meshes are looked for in the folders above the file, then in ROS_PACKAGE_PATH"
                why = "; ".join(filter(None, (prints(), explain(error))))
                raise InvalidModel(f"the geometry of {self.what} cannot be loaded: {why} ({looked})") from None
            why = prints()
        read = Counter(model.frames[shape.parentFrame].name for shape in geometry.geometryObjects)
        lost = [link for link, count in counts.items() if read[link] != count]
        if lost:
            named = ", ".join(map(repr, lost))
            raise InvalidModel(f"the {shapes} geometry of {self.what} cannot be read, of link {named}: {why}")
        return geometry

    def _read_mjcf(self) -> tuple[pin.Model, list[str]]:
        if self.base != "fixed":
            raise InvalidModel(f"{self.what} is MJCF, which defines the joint of its base itself, e.g. by <freejoint/>")
        with self._file() as path, caught_prints() as prints:
            try:
                model = pin.buildModelFromMJCF(path)
                _ = model.name, list(model.names), [frame.name for frame in model.frames]  # ValueError: not text
            except (ValueError, RuntimeError, LookupError) as error:
                why = (prints() or explain(error)).replace(path, self.what)
                raise InvalidModel(f"{self.what} is not MJCF that can be read: {why}") from None
            printed = list(filter(None, [prints()]))
        names = [f"equality><{kind}" for kind in equalities_not_read(self.text)] + ["include"] * (
            "<include" in self.text
        )
        left = [f"{self.what} has <{name}>, which is not read" for name in names]
        return model, [*left, *printed]

    def _mjcf_geometry(self, model: pin.Model, shapes: Shapes) -> pin.GeometryModel:
        _check_meshes(mjcf_meshes(self.text), [str((self.source or Path("here")).absolute().parent)])
        with self._file() as path, caught_prints():
            try:
                return pin.buildGeomFromMJCF(model, path, KINDS[shapes])
            except (ValueError, RuntimeError, LookupError) as error:
                raise InvalidModel(f"the geometry of {self.what} cannot be loaded: {explain(error)}") from None

    @contextmanager
    def _file(self) -> Iterator[str]:
        """A file with the text, for the parser that takes nothing else."""
        if self.source is not None:
            yield str(self.source)
            return
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "robot.xml")
            path.write_text(self.text, encoding="utf-8")
            yield str(path)


_MADE_FROM: WeakKeyDictionary[pin.Model, Description] = WeakKeyDictionary()


@checked
def description_of(model: pin.Model) -> Description | None:
    """The source of a model, or None if it is not one of ``Description.model``."""
    return _MADE_FROM.get(model)


def _check_meshes(names: Iterable[str], folders: list[str]) -> None:
    """Look at files of meshes, where they may be, before Pinocchio reads them.

    Raises:
        InvalidModel: One is damaged such that reading it would end the process, or never end.
    """
    folders = [*folders, *os.environ.get("ROS_PACKAGE_PATH", "").split(os.pathsep)]
    for tail in {re.sub(r"^\w+://", "", name) for name in names}:
        for folder in folders:
            check_mesh(Path(folder, tail), InvalidModel)
