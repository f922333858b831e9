"""Distances between legs: how near their axes come to each other."""

from __future__ import annotations

import numpy as np

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.stewart.kernels.loading import load_judging
from pin_metaik.stewart.kinematics.judging import arguments_of
from pin_metaik.stewart.platform.geometry import Geometry
from pin_metaik.stewart.platform.poses import PoseLike, as_poses, is_many


@checked
def leg_distances(geometry: Geometry, poses: PoseLike) -> Array:
    """Distance in m between the axes of each pair of legs in ``geometry.pairs``: (k, p), or (p,) for a single pose.

    Legs that share a joint touch there and are not a pair. Two legs of diameter D are clear of each other at more than
    D. With servos the distances are those of the rods, not of the horns; NaN at a pose that one of them does not reach.

    Raises:
        InvalidTarget: Not poses.
    """
    T = as_poses(poses)
    distances = np.empty((len(T), len(geometry.pairs)))
    load_judging().distances(*arguments_of(geometry, None), T, distances)
    return distances if is_many(poses) else distances[0]
