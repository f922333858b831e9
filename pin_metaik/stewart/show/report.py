"""The report on a mechanism, as labelled lines in its own units."""

from __future__ import annotations

from math import degrees, pi
from typing import TypeAlias

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from pin_metaik.stewart.kinematics.inverse import inverse
from pin_metaik.stewart.kinematics.trajectory import Trajectory, follow
from pin_metaik.stewart.mechanism.mechanism import Mechanism
from pin_metaik.stewart.platform.limits import LegLimits, ServoLimits
from pin_metaik.stewart.platform.poses import PoseLike, one_pose
from pin_metaik.stewart.platform.servos import each
from pin_metaik.stewart.platform.states import PoseState
from pin_metaik.stewart.show.notes import in_unit, notes
from pin_metaik.stewart.show.values import pose_values
from pin_metaik.stewart.synthesis.design import Designed
from pin_metaik.stewart.workspace.singularity import crossings, singularities
from pin_metaik.stewart.workspace.workspace import Workspace

Lines: TypeAlias = list[tuple[str, str]]


def of_legs(mechanism: Mechanism, coordinates: ArrayLike, per: str = "") -> str:
    """Coordinates of legs in m or rad, or their rates ``per`` s, in the unit they are shown in; - for none."""
    shown = mechanism.coordinate
    values = ("-" if np.isnan(value) else f"{value / shown.one:.6g}" for value in np.ravel(coordinates))
    return f"{', '.join(values)} {shown.unit}{per}"


def describe(mechanism: Mechanism) -> Lines:
    """Its dimensions and limits."""
    geometry, limits = mechanism.geometry, mechanism.limits
    lines = [("type", str(geometry))]
    for side, letter in (("base", "B"), ("platform", "M")):
        if (joints := getattr(geometry, side)) is not None:
            places = (in_unit(mechanism, joint) for joint in joints)
            lines += [(side, f"{letter}{k} at {place}") for k, place in enumerate(places, start=1)]
            continue
        shown = ", ".join(f"{degrees(angle):.6g}" for angle in getattr(geometry, f"{side}_angles"))
        lines.append((side, f"radius {in_unit(mechanism, getattr(geometry, f'{side}_radius'))}, joints at {shown} deg"))
    if any(geometry.reference):
        origin = "the centre of the platform" if geometry.platform is None else "where its joints are counted from"
        lines.append(("reference", f"{in_unit(mechanism, geometry.reference)} from {origin}"))
    lines.append(("joint gap", in_unit(mechanism, geometry.joint_gap)))
    if isinstance(limits, ServoLimits):
        lines += _servos(mechanism)
    else:
        lines.append(("legs", of_legs(mechanism, limits.span)))
    for name, angle in (
        (geometry.actuation.words.first_joints, limits.base_angle),
        ("platform joints", limits.platform_angle),
    ):
        if angle < pi:
            lines.append((name, f"up to {degrees(angle):.6g} deg"))
    if limits.distance > 0.0:
        lines.append(("legs apart", f"at least {in_unit(mechanism, limits.distance)}"))
    if isinstance(limits, LegLimits) and limits.dead_length is not None:
        lines.append(("dead length", in_unit(mechanism, limits.dead_length)))
    if limits.speed is not None:
        lines.append(("speed of legs", f"up to {of_legs(mechanism, limits.speed, '/s')}"))
    return lines


def _servos(mechanism: Mechanism) -> Lines:
    """Horns, rods and axes of servos."""
    servos = mechanism.geometry.servos
    assert servos is not None
    lines = [("horns", in_unit(mechanism, servos.horn)), ("rods", in_unit(mechanism, servos.rod))]
    lines.append(("servos", f"from {' to '.join(of_legs(mechanism, end) for end in mechanism.limits.span)}"))
    if servos.axes is None:
        lines.append(("horns at 0 point to", f"{', '.join(f'{degrees(a):.6g}' for a in servos.directions)} deg"))
    else:
        for k, (u, _, a) in enumerate(servos.frames, start=1):
            axis, zero = (", ".join(f"{x:.6g}" for x in way.round(12) + 0.0) for way in (a, u))
            lines.append((f"axis {k}", f"{axis}; at 0 the horn points along {zero}"))
    if servos.branches != 1:
        lines.append(("branches", ", ".join(f"{branch:+d}" for branch in np.ravel(servos.branches))))
    return lines


def assess(mechanism: Mechanism, workspace: Workspace) -> Lines:
    """Its workspace: volume, dexterity, singularities, and what limits it."""
    found = singularities(workspace)
    lines = [("verdict", str(workspace.verdict))]
    lines += [("PARTIAL" if not workspace.complete else "note", text) for text in notes(mechanism, workspace)]
    cells = workspace.cells
    if workspace.at_one_position:
        share = f"{100 * workspace.reached.mean():.4g} % of {len(cells.rpy)}"
        lines.append(("orientations", f"{share} at {in_unit(mechanism, workspace.positions[0])} are reached"))
    else:
        lines.append(("volume", f"{1e6 * workspace.volume:.5g} cm3, of {workspace.cells_reached} cells"))
        if len(cells.rpy) > 1:
            lines.append(("in every orientation", f"{1e6 * workspace.volume_of_all:.5g} cm3"))
    gdi = "none: every pose reached is singular" if workspace.gdi is None else f"{workspace.gdi:.4f}"
    norm = f"{mechanism.dexterity.norm} norm, L = {in_unit(mechanism, workspace.length)}"
    lines.append(("GDI", f"{gdi}, the mean dexterity nu = 1 / condition number ({norm})"))
    lines.append(("lowest nu", f"{found.nu:.4g} at {in_unit(mechanism, found.nearest[:3, 3])}"))
    if len(found.poses) or len(found.crossings):
        lines.append(("singular poses", f"{len(found.poses)}, left out of the GDI"))
        lines.append(("det J changes sign", f"between {len(found.crossings)} pairs of neighbouring poses"))
    if found.weakest is not None:
        place = in_unit(mechanism, found.weakest[:3, 3])
        lines.append(
            ("least transmission", f"{found.transmission:.4g} at {place}; at 0 a rod is in line with its horn")
        )
    total = workspace.states.size
    for state, count in workspace.counts.items():
        lines.append(("poses", f"{100 * count / total:6.2f} %  {state.words}"))
    return lines


def at_pose(mechanism: Mechanism, pose: PoseLike) -> Lines:
    """The legs at one pose."""
    found, links = pose_values(mechanism, pose), inverse(mechanism.geometry, pose)
    lines = [
        (mechanism.geometry.actuation.words.coordinates, of_legs(mechanism, links.coordinates)),
        ("pose is", PoseState[found["state"].upper()].words),
        ("dexterity nu", f"{found['nu']:.6f}"),
    ]
    lines += [("out of reach", links.why)] if links.why else []
    if mechanism.geometry.servos is not None:
        shares = ("-" if share is None else f"{share:.4f}" for share in found["transmission"])
        lines.append(("transmission", ", ".join(shares)))
        other = tuple((-each(mechanism.geometry.servos, "branches").astype(int)).tolist())
        angles = inverse(mechanism.geometry, pose, other).coordinates
        lines.append(("on the other branch", of_legs(mechanism, angles)))
    rows = (", ".join("-" if value is None else f"{value:9.6f}" for value in row) for row in found["jacobian"])
    lines += [("Jacobian" if i == 1 else "", f"leg {i}: {row}") for i, row in enumerate(rows, start=1)]
    if found["nearest_legs"] is not None:
        i, j = found["nearest_legs"]
        lines.append(("nearest legs", f"{i} and {j}, {in_unit(mechanism, found['leg_distance'])} apart"))
    return lines


def along(mechanism: Mechanism, way: Trajectory) -> Lines:
    """The legs along a trajectory: their ranges and speeds, conditioning, and singular poses on the way."""
    motion = follow(mechanism.geometry, way, mechanism.limits, mechanism.dexterity)
    q, extremes = motion.coordinates, mechanism.geometry.actuation.words.extremes
    lines = [
        ("time", f"{way.times[-1] - way.times[0]:.6g} s"),
        (extremes, of_legs(mechanism, (np.nanmin(q), np.nanmax(q)) if np.isfinite(q).any() else np.nan)),
        ("fastest leg", of_legs(mechanism, motion.fastest, "/s")),
        ("lowest nu", f"{motion.nu.min():.4g}"),
    ]
    if (least := motion.least_seconds) is not None:
        enough = "slow enough" if not motion.too_fast.any() else "too fast for the legs"
        lines.append(("speed", f"{enough}: this way takes them {least:.6g} s at least"))
    for state in PoseState:
        if (share := float((motion.states == state).mean())) > 0.0:
            lines.append(("way", f"{100 * share:6.2f} %  {state.words}"))
    for crossing in crossings(mechanism.geometry, way):
        what = "det J changes sign" if crossing.crosses else "singular"
        lines.append((what, f"at {crossing.time:.6g} s, {in_unit(mechanism, crossing.pose[:3, 3])}"))
    return lines


def pose_words(mechanism: Mechanism, pose: PoseLike) -> str:
    """A pose in words: x, y, z in the mechanism's unit, and roll, pitch, yaw in degrees."""
    T = one_pose(pose)
    turn = ", ".join(f"{degrees(angle.round(9)) + 0.0:.6g}" for angle in pin.rpy.matrixToRpy(T[:3, :3]))
    return f"{in_unit(mechanism, T[:3, 3].round(9) + 0.0)}; roll, pitch, yaw {turn} deg"


def outcome(designed: Designed) -> Lines:
    """The lines about a design."""
    lines = [("ended", designed.search.status.value), ("designs looked at", str(designed.search.evaluations))]
    lines.append(("time", f"{designed.search.seconds:.3g} s"))
    if designed.score is None:
        return [
            *lines,
            ("design", "none found: all lack room for joints, or a workspace that is large enough and regular"),
        ]
    score = designed.score
    parts = f"dexterity {score.dexterity:.4f}, workspace {score.workspace:.4f}"
    return [*lines, ("fitness", f"{score.fitness:.4f}: {parts}")]
