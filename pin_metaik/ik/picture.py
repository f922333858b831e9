"""A picture of an arm at a configuration: its joints and links as lines, the target, and the obstacles of a world.

Nothing here imports matplotlib: make a ``matplotlib.figure.Figure`` (the extra ``plots``), or let ``save_arm`` do it.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import array, checked
from pin_metaik.collision import CollisionWorld
from pin_metaik.collision.extent import box_of, is_flat
from pin_metaik.errors import InvalidConfiguration
from pin_metaik.figures import picture_file
from pin_metaik.kinematics import Chain

BLUE, RED, GREEN, GREY = "#0072b2", "#d55e00", "#009e73", "#999999"
AXES = 0.12  # of the picture's width, length of the axes of frames
DPI = 130


@checked
def save_arm(
    path: str | Path, chain: Chain, q: ArrayLike, target: Any = None, world: CollisionWorld | None = None
) -> None:
    """Draw an arm and write the picture: ``.png``, ``.svg`` or ``.pdf``; see ``draw_arm``.

    Raises:
        MissingExtra: matplotlib is not installed.
        InvalidSetting: The suffix is not one of a picture.
        CannotWrite: The file cannot be written.
        InvalidConfiguration: A configuration of the wrong length.
    """
    file = picture_file(path)
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.0, 6.0), layout="constrained")
    draw_arm(figure, chain, q, target, world)
    figure.savefig(file, dpi=DPI)


@checked
def draw_arm(figure: Any, chain: Chain, q: ArrayLike, target: Any = None, world: CollisionWorld | None = None) -> None:
    """Draw an arm at a configuration into a figure, in three dimensions.

    Args:
        figure: An empty ``matplotlib.figure.Figure``.
        chain: The chain; its links are drawn thick and blue, the others of the model grey.
        q: (nq,) the configuration.
        target: A position (3,) in m, or a pose as a ``pin.SE3`` or (4, 4), drawn beside the frame; or None.
        world: World whose obstacles are drawn as their bounding boxes; planes and half spaces are left out.

    Raises:
        InvalidConfiguration: A configuration of the wrong length.
        InvalidSetting: The target is neither a pose nor a position.
    """
    model, data = chain.model, chain.model.createData()
    pin.framesForwardKinematics(model, data, array("q", q, model.nq, error=InvalidConfiguration))
    ax = figure.add_subplot(projection="3d")
    on_path = {j for f in chain.frame_ids for j in list(model.supports[model.frames[f].parentJoint])[1:]}
    places = np.array([data.oMi[j].translation for j in range(model.njoints)])
    tips = [data.oMf[f] for f in chain.frame_ids]
    for j in range(1, model.njoints):
        drives = model.parents[j] == 0 and model.joints[j].nv > 1  # a base that drives or floats hangs on nothing
        ends = places[[j if drives else model.parents[j], j]]
        on = j in on_path
        ax.plot(*ends.T, color=BLUE if on else GREY, linewidth=4 if on else 1, solid_capstyle="round")
        if on:
            ax.plot(*places[j], "o", color="black", markersize=5)
    for f, tip in zip(chain.frame_ids, tips, strict=True):
        ends = np.array([places[model.frames[f].parentJoint], tip.translation])
        ax.plot(*ends.T, color=BLUE, linewidth=4, solid_capstyle="round")
    wanted, orientation = _target(target)
    seen = [places, *[tip.translation[None] for tip in tips], *([] if wanted is None else [wanted[None]])]
    boxes = [] if world is None else _boxes(world)
    everything = np.vstack([*seen, *boxes])
    middle = (everything.min(axis=0) + everything.max(axis=0)) / 2
    half = max(0.55 * float(np.ptp(everything, axis=0).max()), 1e-3)
    for corners in boxes:
        _draw_box(ax, corners)
    for tip in tips:
        _draw_axes(ax, tip.translation, tip.rotation, 2 * half * AXES)
    if wanted is not None:
        ax.plot(*wanted, "*", color=RED, markersize=14, label="target")
        if orientation is not None:
            _draw_axes(ax, wanted, orientation, 2 * half * AXES, "--")
    ax.plot([], [], [], color=BLUE, linewidth=4, label=", ".join(chain.frames))
    ax.set(**{f"{axis}lim": (m - half, m + half) for axis, m in zip("xyz", middle, strict=True)})
    ax.set(xlabel="x, m", ylabel="y, m", zlabel="z, m")
    ax.set_box_aspect((1, 1, 1), zoom=0.87)  # or the label of z is cut off
    ax.legend(loc="upper left", fontsize="small")


def _target(target: Any) -> tuple[NDArray[np.float64] | None, NDArray[np.float64] | None]:
    """Position (3,) and rotation (3, 3) of a target, None for what it does not say."""
    if target is None:
        return None, None
    if isinstance(target, pin.SE3):
        return target.translation.copy(), target.rotation.copy()
    given = np.asarray(target, dtype=float) if np.ndim(target) in (1, 2) else np.empty(0)
    if given.shape == (3,):
        return array("target", given, 3), None
    pose = array("target is a position (3,) or a pose (4, 4)", given, 4, 4)
    return pose[:3, 3], pose[:3, :3]


def _boxes(world: CollisionWorld) -> list[NDArray[np.float64]]:
    """Corners (8, 3) of the boxes around a world's obstacles; what is endless has none."""
    signs = np.array([[a, b, c] for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)])
    found = []
    for obstacle in world.obstacles:
        geometry = obstacle.shape.geometry()
        if not is_flat(geometry):
            box, pose = box_of(geometry), obstacle.pose
            found.append((box[:3] + signs * box[3:6]) @ pose.rotation.T + pose.translation)
    return found


def _draw_box(ax: Any, corners: NDArray[np.float64]) -> None:
    for a in range(8):
        for b in (1, 2, 4):  # corners that differ in one sign
            if not a & b:
                ax.plot(*corners[[a, a | b]].T, color=GREY, linewidth=1)


def _draw_axes(
    ax: Any, at: NDArray[np.float64], rotation: NDArray[np.float64], length: float, style: str = "-"
) -> None:
    for axis, colour in zip(rotation.T, (RED, GREEN, BLUE), strict=True):
        ax.plot(*np.array([at, at + length * axis]).T, style, color=colour, linewidth=1.5)
