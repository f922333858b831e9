"""Distances between legs: how near their axes come to each other."""

from __future__ import annotations

import numpy as np

from pin_metaik.arguments import checked
from pin_metaik.optimize.space import Array
from pin_metaik.stewart.kernels.loading import load_judging
from pin_metaik.stewart.kinematics.inverse import inverse
from pin_metaik.stewart.platform.geometry import Geometry
from pin_metaik.stewart.platform.poses import PoseLike, as_poses, is_many


@checked
def leg_distances(geometry: Geometry, poses: PoseLike) -> Array:
    """Distance in m between the axes of each pair of legs in ``geometry.pairs``: (k, p), or (p,) for a single pose.

    Legs that share a joint touch there and are no pair. Two legs of diameter D are clear of each other at more than D.
    Legs that are moved by servos are represented by their rods; their horns are not looked at.

    Raises:
        InvalidTarget: Not poses.
    """
    T = as_poses(poses)
    links, (_, _, pairs) = inverse(geometry, T), geometry.arrays
    distances = np.empty((len(T), len(pairs)))
    starts, vectors = (np.require(part, requirements=("C", "W")) for part in (links.starts, links.vectors))
    load_judging().distances(starts, vectors, pairs, distances)
    return distances if is_many(poses) else distances[0]
