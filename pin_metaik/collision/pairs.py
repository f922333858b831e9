"""Which pairs of a robot's links are not checked, and why."""

from __future__ import annotations

from pathlib import Path
from typing import TypeAlias

import pinocchio as pin

from pin_metaik.collision.body import Body, Geometry
from pin_metaik.collision.padding import Padding
from pin_metaik.collision.srdf import Pair, pair_of, read_srdf
from pin_metaik.collision.touch import touches
from pin_metaik.watching import Watch

Srdf: TypeAlias = str | Path | bool | None

CLEAR = 0.01  # m beyond what is asked that links must always keep before they need not be checked


def disabled_pairs(
    robot: Geometry, bodies: tuple[Body, ...], srdf: Srdf, padding: Padding, watch: Watch | None = None
) -> dict[Pair, str]:
    """The pairs that are not checked, with the reason: what an SRDF says, else Adjacent, Always or Never.

    Args:
        robot: The robot.
        bodies: Its geometry.
        srdf: A file; None for the robot's own, if it has one; False for none.
        padding: What distances collide.
        watch: Called with configurations looked at and in all; True ends the work.

    Raises:
        Stopped: The watch says so.
        InvalidModel: If the SRDF cannot be read.
        UnknownName: If an SRDF that was given names a link that the robot lacks.
    """
    links = {frame.name for frame in robot.model.frames if frame.type == pin.FrameType.BODY}
    path = robot.srdf if srdf is None or srdf is True else None if srdf is False else Path(srdf).expanduser()
    disabled = {} if path is None else read_srdf(path, links, strict=path != robot.srdf)
    for pair in neighbours(robot.model, {body.link for body in bodies}):
        disabled.setdefault(pair, "Adjacent")
    for pair, touch in touches(robot.model, bodies, watch).items():
        if touch.always:
            disabled.setdefault(pair, "Always")
        elif touch.gap > padding.between(*pair) + CLEAR:
            disabled.setdefault(pair, "Never")
    return disabled


def neighbours(model: pin.Model, links: set[str]) -> set[Pair]:
    """The pairs of links with one joint between them, by the names of their frames."""
    pairs = set()
    for frame in model.frames:
        if frame.type == pin.FrameType.BODY and frame.name in links:
            joint = model.frames[frame.parentFrame]  # of a link's frame the joint's, whose parent is the link before
            before = model.frames[joint.parentFrame]
            if before.name in links and before.name != frame.name:
                pairs.add(pair_of(frame.name, before.name))
    return pairs
