"""Pictures of a mechanism: at a pose, from above, and beside its workspace coloured by dexterity."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np
import pinocchio as pin

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.figures import need_figure, new_figure
from pin_metaik.stewart.kinematics.forward import level
from pin_metaik.stewart.kinematics.inverse import inverse
from pin_metaik.stewart.mechanism.mechanism import Mechanism
from pin_metaik.stewart.platform.actuation import directions
from pin_metaik.stewart.platform.geometry import Geometry, on_circle
from pin_metaik.stewart.platform.limits import LegLimits
from pin_metaik.stewart.platform.poses import PoseLike, one_pose, pose_at
from pin_metaik.stewart.show.body import body_of, draw_body, polygons
from pin_metaik.stewart.show.colours import PLATE, ROD, STEEL
from pin_metaik.stewart.workspace.singularity import singularities
from pin_metaik.stewart.workspace.workspace import Workspace

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TAG = {"boxstyle": "circle,pad=0.15", "facecolor": "white", "edgecolor": STEEL, "linewidth": 0.6}
RED, THROUGH = "#c02020", 0.25  # poses where det J changes sign, and how opaque the workspace round them is
FLATTEST, THINNEST = 0.2, 0.4  # of the longest side: below, and across, there is no room for the numbers
VIEW = {"elev": 18.0, "azim": -60.0}


@checked
def draw(mechanism: Mechanism, workspace: Workspace | None = None, pose: PoseLike | None = None) -> Figure:
    """A picture of a mechanism, and beside it of its workspace; see ``draw_into``.

    Raises:
        InvalidTarget: Not a pose.
        MissingExtra: matplotlib is not installed.
    """
    figure = new_figure((11.0, 4.8) if workspace is not None else (6.8, 5.6))
    draw_into(figure, mechanism, workspace, pose)
    return figure


@checked
def draw_into(
    figure: Figure, mechanism: Mechanism, workspace: Workspace | None = None, pose: PoseLike | None = None
) -> None:
    """Draw into an empty figure.

    Args:
        figure: Where to draw.
        mechanism: What to draw.
        workspace: Its workspace, to be drawn as cells coloured by nu, with red points where det J changes sign between
            them; or None.
        pose: Pose of the platform; default: in the middle of the workspace, or level at half stroke.

    Raises:
        InvalidTarget: Not a pose.
    """
    need_figure(figure)
    unit = mechanism.unit
    scale = 1.0 / mechanism.metres
    T = one_pose(_middle(mechanism, workspace) if pose is None else pose)
    axes = figure.add_subplot(1, 2 if workspace is not None else 1, 1, projection="3d")
    _mechanism(axes, mechanism, T, scale)
    axes.set_title(f"{mechanism.name} ({mechanism.geometry.type})", fontsize=11)
    _dress(axes, tuple(f"{name} ({unit})" for name in "xyz"))
    if workspace is not None:
        axes = figure.add_subplot(1, 2, 2, projection="3d")
        body, crossed = body_of(workspace, scale, unit), _crossed(workspace, scale)
        draw_body(figure, axes, body, THROUGH if len(crossed) else 1.0)
        axes.scatter(*crossed.T, color=RED, s=5, depthshade=False)
        gdi = "no GDI: singular" if workspace.gdi is None else f"GDI {workspace.gdi:.3f}"
        gdi += "; red: det J changes sign" if len(crossed) else ""
        axes.set_title(f"{body.title}, {gdi}", fontsize=11)
        _dress(axes, body.labels)


@checked
def draw_above(mechanism: Mechanism, pose: PoseLike | None = None) -> Figure:
    """A picture of a mechanism from above: the joints of base and platform, and the legs between them.

    Args:
        mechanism: What to draw.
        pose: Pose of the platform; default: level over the base at half stroke.

    Raises:
        InvalidTarget: Not a pose.
        MissingExtra: matplotlib is not installed.
    """
    T = one_pose(_middle(mechanism, None) if pose is None else pose)
    geometry, scale = mechanism.geometry, 1.0 / mechanism.metres
    figure = new_figure((6.4, 6.0))
    axes: Any = figure.add_subplot(aspect="equal")
    moved = T[:3, 3] + geometry.platform_joints @ T[:3, :3].T
    for i, (b, knee, end) in enumerate(legs_at(mechanism, T), start=1):
        if geometry.servos is not None:
            axes.plot(*(scale * np.array([b, knee])[:, :2]).T, color=STEEL, lw=4, solid_capstyle="round")
        begin = b if geometry.servos is None else knee
        axes.plot(*(scale * np.array([begin, end])[:, :2]).T, color=ROD, lw=1.6)
        middle = scale * 0.5 * (begin + end)[:2]
        axes.text(*middle, f"{i}", fontsize=8, color=STEEL, ha="center", va="center", bbox=TAG)
    base_ring, moving_ring = _rings(geometry)
    aside = 0.07 * (geometry.base_radius + geometry.platform_radius)
    sides = ((geometry.base_joints, base_ring, "B", STEEL), (moved, T[:3, 3] + moving_ring @ T[:3, :3].T, "M", PLATE))
    for joints, ring, letter, colour in sides:
        axes.plot(*(scale * ring[:, :2]).T, color=colour, lw=1, alpha=0.6)
        axes.scatter(*(scale * joints[:, :2]).T, color=colour, s=36, zorder=3)
        for k, place in enumerate(_beside(joints, aside), start=1):
            label = axes.text(
                *(scale * place[:2]), f"{letter}{k}", color=colour, fontsize=10, fontweight="bold", zorder=4
            )
            label.set(ha="center", va="center", path_effects=_halo())
    axes.set_xlabel(f"x ({mechanism.unit})")
    axes.set_ylabel(f"y ({mechanism.unit})")
    axes.set_title(f"{mechanism.name} ({geometry.type}) from above", fontsize=11)
    axes.margins(0.12)
    axes.grid(alpha=0.3)
    return figure


def _crossed(workspace: Workspace, scale: float) -> Array:
    """Where det J changes sign between neighbouring poses, in the coordinates that the workspace is drawn in (c, 3)."""
    poses = singularities(workspace).crossings
    if not workspace.at_one_position:
        return np.asarray(scale * poses[:, :3, 3])
    return np.degrees([pin.rpy.matrixToRpy(pose[:3, :3]) for pose in poses]).reshape(-1, 3)


def _middle(mechanism: Mechanism, workspace: Workspace | None) -> Array:
    if workspace is not None:
        return pose_at(np.median(workspace.positions, axis=0))
    halfway = np.full((1, mechanism.geometry.n), 0.5 * sum(mechanism.limits.span))
    return np.asarray(level(mechanism.geometry, halfway)[0])


def legs_at(mechanism: Mechanism, T: Array) -> Array:
    """Of each leg the base joint, the knee and the platform joint (n, 3, 3): a horn or a cylinder, then a rod."""
    geometry = mechanism.geometry
    links = inverse(geometry, T)
    starts, vectors = links.starts[0], links.vectors[0]
    knees = starts
    if isinstance(mechanism.limits, LegLimits):
        lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
        knees = starts + np.minimum(1.0, 0.9 * mechanism.limits.shortest / np.maximum(lengths, 1e-12)) * vectors
    return np.stack((geometry.b, knees, starts + vectors), axis=1)


def _mechanism(axes: Any, mechanism: Mechanism, T: Array, scale: float) -> None:
    """Plates as polygons of their joints on their circles, legs as cylinder or horn and rod, joints as dots."""
    geometry = mechanism.geometry
    R, P = T[:3, :3], T[:3, 3]
    platform_joints = P + geometry.platform_joints @ R.T
    rings = _rings(geometry)
    for ring, joints, colour, at in zip(
        rings, (geometry.base_joints, platform_joints), (STEEL, PLATE), (np.eye(4), T), strict=True
    ):
        axes.plot(*(scale * (at[:3, 3] + ring @ at[:3, :3].T)).T, color=colour, lw=1, alpha=0.6)
        _plate(axes, scale * joints, colour)
    for i, (b, knee, end) in enumerate(legs_at(mechanism, T), start=1):
        axes.plot(*(scale * np.array([b, knee])).T, color=STEEL, lw=4, solid_capstyle="round")
        axes.plot(*(scale * np.array([knee, end])).T, color=ROD, lw=2.2, solid_capstyle="round")
        place = scale * (b + 0.45 * (end - b) if geometry.servos is None else 0.5 * (knee + end))
        axes.text(*place, f"{i}", fontsize=8, color=STEEL, ha="center", va="center", bbox=TAG, zorder=20)
    aside = 0.09 * (geometry.base_radius + geometry.platform_radius)
    for joints, name, colour in ((geometry.base_joints, "B", STEEL), (platform_joints, "M", PLATE)):
        axes.scatter(*(scale * joints).T, color=colour, s=26, depthshade=False)
        for k, beside in enumerate(_beside(joints, aside), start=1):
            place = beside + np.array([0.0, 0.0, 0.6 * aside if name == "M" else -0.6 * aside])
            label = axes.text(*(scale * place), f"{name}{k}", fontsize=9, color=colour, fontweight="bold", zorder=30)
            label.set(ha="center", va="center", path_effects=_halo())


def _rings(geometry: Geometry) -> tuple[Array, Array]:
    """Points (k, 3) of the circles of both sides in their frames; none for joints anywhere."""
    round_about = np.linspace(0.0, 2 * np.pi, 73)
    base = on_circle(geometry.base_radius, round_about)
    moving = on_circle(geometry.platform_radius, round_about) + geometry.platform_centre
    return base[: 0 if geometry.base else None], moving[: 0 if geometry.platform else None]


def _beside(joints: Array, aside: float) -> Array:
    """Where the names of joints (k, 3) stand: outside, and away from the nearest other joint where that is close."""
    apart = joints[:, None] - joints[None]
    d = np.linalg.norm(apart, axis=-1) + np.where(np.eye(len(joints)), np.inf, 0.0)
    nearest = d.argmin(axis=1)
    closeness = np.maximum(1.0 - d.min(axis=1) / (3.0 * aside), 0.0)[:, None]
    away = apart[np.arange(len(joints)), nearest] / d.min(axis=1)[:, None]
    outward = directions(joints - joints.mean(axis=0), (0.0, 0.0, 1.0))
    return np.asarray(joints + aside * (outward + closeness * away))


def _halo() -> list[Any]:
    """A white edge round letters, so that the drawing behind does not hide them."""
    effects = import_module("matplotlib.patheffects")
    return [effects.withStroke(linewidth=2.5, foreground="white")]


def _plate(axes: Any, corners: Array, colour: str) -> None:
    """A plate through its joints, taken round their middle."""
    out = corners - corners.mean(axis=0)
    corners = corners[np.argsort(np.arctan2(out[:, 1], out[:, 0]))]
    axes.add_collection3d(polygons([corners], facecolor=colour, alpha=0.22, edgecolor=colour))


def _dress(axes: Any, labels: tuple[str, ...]) -> None:
    extents = np.array([np.ptp(getattr(axes, f"get_{name}lim")()) for name in "xyz"])
    for name, label, extent in zip("xyz", labels, extents, strict=True):
        getattr(axes, f"set_{name}label")(label, fontsize=9)
        axes.locator_params(axis=name, nbins=5 if extent > 0.4 * extents.max() else 3)
    axes.tick_params(labelsize=8)
    tall = extents[2] == extents.max()
    least = np.array([THINNEST, THINNEST, FLATTEST]) * extents.max()
    axes.set_box_aspect(np.maximum(extents, least), zoom=0.8 if tall else 0.9)  # below what is tall stand two labels
    axes.view_init(**VIEW)
