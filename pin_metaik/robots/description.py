"""URDF text to Pinocchio's models: what can go wrong in reading is told by our errors, not by the parsers' prints."""

from __future__ import annotations

import os
import sys
import tempfile
import threading
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal
from weakref import WeakKeyDictionary

import numpy as np
import pinocchio as pin

from pin_metaik.arguments import checked, checked_as
from pin_metaik.errors import InvalidBounds, InvalidModel

Base = Literal["fixed", "free flyer", "planar"]
ROOTS = {"free flyer": pin.JointModelFreeFlyer, "planar": pin.JointModelPlanar}

_STDERR = threading.Lock()


@checked_as(InvalidModel)
@dataclass(frozen=True)
class Description:
    """What a model is made from: plain values, so that a process that gets them makes the same model again.

    Attributes:
        urdf: URDF text.
        source: The file it comes from; meshes are looked for from there.
        base: What joins the base to the world.
        mimic: Couple joints with a mimic tag to the joint they follow.
    """

    urdf: str = field(repr=False)
    source: Path
    base: Base = "fixed"
    mimic: bool = True

    def model(self) -> pin.Model:
        """The model, built anew, and remembered with what it was made from (``description_of``).

        Raises:
            InvalidModel: If the text is not a URDF; the message has the parser's own reason.
            InvalidBounds: If a joint's lower limit is above its upper one.
        """
        model = build_model(self.urdf, self.source, base=self.base, mimic=self.mimic)
        _MADE_FROM[model] = self
        return model


_MADE_FROM: WeakKeyDictionary[pin.Model, Description] = WeakKeyDictionary()


@checked
def description_of(model: pin.Model) -> Description | None:
    """What a model was made from, or None if it is not one of ``Description.model``."""
    return _MADE_FROM.get(model)


def read_urdf(path: Path) -> str:
    """Text of a URDF file.

    Raises:
        InvalidModel: If there is no such file, or it is not text.
    """
    try:
        return path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise InvalidModel(f"cannot read {path}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise InvalidModel(f"{path} is not a URDF: it is not UTF-8 text") from None


def build_model(urdf: str, source: Path, *, base: Base = "fixed", mimic: bool = True) -> pin.Model:
    """Model of a URDF text that comes from the file ``source``.

    Joints with a mimic tag become ``JointModelMimic``, scaled copies of the joint they follow, if Pinocchio can hold
    them all: the followed joint must come earlier in its tree, and be continuous if, and only if, the follower is.
    Otherwise all joints are free.

    Raises:
        InvalidModel: If the text is not a URDF; the message has the parser's own reason.
        InvalidBounds: If a joint's lower limit is above its upper one.
    """
    try:
        if ET.fromstring(urdf).tag != "robot":
            raise InvalidModel(f"{source} is not a URDF: its outermost element is not <robot>")
    except ET.ParseError as error:
        raise InvalidModel(f"{source} is not well-formed XML: {error}") from None
    root = () if base == "fixed" else (ROOTS[base](),)
    with _parser_prints() as prints:
        try:
            model = pin.buildModelFromXML(urdf, *root, mimic=False)  # also says what is wrong if something is
        except (ValueError, RuntimeError) as error:
            raise InvalidModel(f"{source} is not a valid URDF: {prints() or explain(error)}") from None
        if mimic and "<mimic" in urdf:
            with suppress(ValueError, RuntimeError):
                model = pin.buildModelFromXML(urdf, *root, mimic=True)
    _check_limits(model, source)
    return model


def build_geometry(model: pin.Model, urdf: str, source: Path, kind: pin.GeometryType) -> pin.GeometryModel:
    """Geometry of a URDF text, meshes included.

    ``package://`` and relative paths are looked up in the folders above ``source``, the nearest first, then in
    ROS_PACKAGE_PATH.

    Raises:
        InvalidModel: If a mesh is missing or unreadable; the message names it.
    """
    folders = [str(folder) for folder in source.absolute().parents]
    try:
        return pin.buildGeomFromUrdfString(model, urdf, kind, package_dirs=folders)
    except (ValueError, RuntimeError) as error:
        looked = "meshes are looked for in the folders above the file, then in ROS_PACKAGE_PATH"
        raise InvalidModel(f"the geometry of {source} cannot be loaded: {explain(error)} ({looked})") from None


def mimic_joints(urdf: str) -> list[str]:
    """Names of the moving joints that carry a mimic tag, in the order of the text."""
    joints = ET.fromstring(urdf).findall("joint")
    return [j.get("name", "") for j in joints if j.find("mimic") is not None and j.get("type") != "fixed"]


def explain(error: Exception) -> str:
    """The sentence in an exception of Pinocchio or coal, without the C++ file and function it comes from."""
    return " ".join(str(error).rpartition("message: ")[2].split())


def _check_limits(model: pin.Model, source: Path) -> None:
    for k in np.flatnonzero(model.lowerPositionLimit > model.upperPositionLimit):
        name = next(n for n, j in zip(model.names, model.joints, strict=True) if 0 <= k - j.idx_q < j.nq and j.id > 0)
        lower, upper = model.lowerPositionLimit[k], model.upperPositionLimit[k]
        raise InvalidBounds(f"{source}: joint {name!r} has its lower limit {lower:g} above its upper {upper:g}")


@contextmanager
def _parser_prints() -> Iterator[Callable[[], str]]:
    """urdfdom explains itself on file descriptor 2 only: keep that from the terminal, and give it as one line."""

    def text() -> str:
        caught.seek(0)
        lines = (line.strip() for line in caught.read().decode(errors="replace").splitlines())
        return "; ".join(line.removeprefix("Error:").strip() for line in lines if not line.startswith("at line"))

    with _STDERR, tempfile.TemporaryFile() as caught:
        sys.stderr.flush()
        saved = os.dup(2)
        os.dup2(caught.fileno(), 2)
        try:
            yield text
        finally:
            os.dup2(saved, 2)
            os.close(saved)
