"""The report on a mechanism as plain values in m, s and rad, for JSON."""

from __future__ import annotations

from typing import Any

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.stewart.kinematics.conditioning import conditioning
from pin_metaik.stewart.kinematics.interference import leg_distances
from pin_metaik.stewart.kinematics.inverse import inverse
from pin_metaik.stewart.kinematics.jacobian import jacobian, transmission
from pin_metaik.stewart.kinematics.judging import judge_poses
from pin_metaik.stewart.kinematics.trajectory import Trajectory, follow
from pin_metaik.stewart.mechanism.mechanism import Mechanism
from pin_metaik.stewart.platform.geometry import Geometry
from pin_metaik.stewart.platform.poses import PoseLike, as_poses
from pin_metaik.stewart.platform.states import PoseState
from pin_metaik.stewart.show.notes import notes
from pin_metaik.stewart.workspace.singularity import crossings, singularities
from pin_metaik.stewart.workspace.workspace import Workspace


def values(mechanism: Mechanism, workspace: Workspace) -> dict[str, Any]:
    """A workspace as plain values; ``gdi`` is null for a singular mechanism."""
    found = singularities(workspace)
    return {
        "name": mechanism.name,
        "type": mechanism.geometry.type,
        "notes": notes(mechanism, workspace),
        **workspace.as_dict(),
        "lowest_nu": found.nu,
        "singular_poses": len(found.poses),
        "sign_changes": len(found.crossings),
    }


def pose_values(mechanism: Mechanism, pose: PoseLike) -> dict[str, Any]:
    """One pose as plain values in m and rad: its legs, its state, its dexterity and Jacobian."""
    geometry = mechanism.geometry
    T = as_poses(pose)
    state = PoseState(int(judge_poses(geometry, mechanism.limits, T)[0]))
    distances = leg_distances(geometry, T)[0]
    known = len(distances) > 0 and not np.isnan(distances).any()
    nearest = (geometry.pairs[distances.argmin()] + 1).tolist() if known else None
    return {
        "pose": T[0].tolist(),
        **_plain_legs(geometry, inverse(geometry, T).coordinates[0]),
        "state": state.name.lower(),
        "reached": state.reached,
        "nu": float(conditioning(geometry, T[0], mechanism.dexterity)),
        "jacobian": _plain(jacobian(geometry, T[0])),
        **({} if geometry.servos is None else {"transmission": _plain(transmission(geometry, T[0]))}),
        "nearest_legs": nearest,
        "leg_distance": float(distances.min()) if known else None,
    }


def way_values(mechanism: Mechanism, way: Trajectory) -> dict[str, Any]:
    """A trajectory as plain values in m, s and rad: the legs over time, limits, dexterity, and singular poses."""
    motion = follow(mechanism.geometry, way, mechanism.limits, mechanism.dexterity)
    met = crossings(mechanism.geometry, way)
    return {
        "times": way.times.tolist(),
        "poses": way.poses.tolist(),
        **_plain_legs(mechanism.geometry, motion.coordinates),
        "leg_rates": _plain(motion.rates),
        "nu": motion.nu.tolist(),
        "states": [PoseState(int(state)).name.lower() for state in motion.states],
        "reached": bool(motion.reached.all()),
        "too_fast": bool(motion.too_fast.any()),
        "least_seconds": motion.least_seconds,
        "singular": [{"time": c.time, "pose": c.pose.tolist(), "sign_changes": c.crosses} for c in met],
    }


def _plain_legs(geometry: Geometry, coordinates: Array) -> dict[str, Any]:
    """Coordinates of legs by their name; None where a rod does not reach."""
    return {geometry.actuation.words.coordinates.replace(" ", "_"): _plain(coordinates)}


def _plain(values: Array) -> Any:
    """Numbers as lists; None for those that are not finite, which JSON does not have."""
    return np.where(np.isfinite(values), values.astype(object), np.array(None)).tolist()
