"""Speeds and angles to learn the turn from, and those to judge it by (section 3 of the Nomad 200 paper, cleaned).

The paper prints the coarse speeds 0.0254, 0.0762, 0.1524 ... 0.9398, 1.016, which are no progression; as many that are
evenly spaced are taken. Angles are in rad here and in degrees in the paper.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.interrupts import wrapped
from pin_metaik.learn import Clusters, fuzzy_c_means
from pin_metaik.mobile.motion.vehicle import SynchroDrive
from pin_metaik.randomness import as_generator
from pin_metaik.watching import Watch

LARGEST = np.radians(150)
FINE_SPEEDS, FINE_ANGLES = 79, 301
COARSE_SPEEDS, COARSE_ANGLES = 14, 76
SLOWEST = 1 / 40  # of the largest speed: half an inch per second times two of 40 in/s


def fine_grid(vehicle: SynchroDrive) -> Array:
    """The paper's test set (23779, 2): v in m/s, theta in rad; 0.5 in/s by 0.5 degrees for the Nomad 200."""
    return _grid(vehicle, FINE_SPEEDS, FINE_ANGLES)


def coarse_grid(vehicle: SynchroDrive) -> Array:
    """The paper's training set (1064, 2) on a grid: every sixth speed, every fourth angle."""
    return _grid(vehicle, COARSE_SPEEDS, COARSE_ANGLES)


def judging_points(vehicle: SynchroDrive) -> Array:
    """The test set from 1 degree on (23621, 2): at angle 0 the tangent length is 0, its relative error undefined."""
    grid = fine_grid(vehicle)
    return np.asarray(grid[grid[:, 1] >= np.radians(1) - 1e-12])


def clustered_points(
    vehicle: SynchroDrive,
    rng: int | np.random.Generator | None = 0,
    iterations: int = 150,
    watch: Watch | None = None,
    clusters: int = COARSE_SPEEDS * COARSE_ANGLES,
    start: Array | None = None,
) -> Clusters:
    """The paper's other training set: fuzzy c-means centres (clusters, 2) of the test set, its columns scaled alike.

    Args:
        vehicle: The robot.
        rng: Seed or generator; ``None`` is a fixed seed.
        iterations: At most; after 150 the centres still move a little, and take half a minute.
        watch: Called after every iteration with their number and the error; True ends it.
        clusters: How many.
        start: Centres of an earlier call, to go on from there.
    """
    grid = fine_grid(vehicle)
    lower, width = grid.min(axis=0), np.ptp(grid, axis=0)
    begin = None if start is None else (start - lower) / width
    scaled = (grid - lower) / width
    return wrapped(
        lambda: fuzzy_c_means(scaled, clusters, iterations=iterations, rng=rng, start=begin, watch=watch),
        lambda found: replace(found, centres=lower + width * found.centres),
    )


def random_points(
    vehicle: SynchroDrive, rng: int | np.random.Generator | None = 0, count: int = COARSE_SPEEDS * COARSE_ANGLES
) -> Array:
    """A control (count, 2): as many points of the test set drawn at random."""
    grid = fine_grid(vehicle)
    return np.asarray(grid[as_generator(rng).choice(len(grid), count, replace=False)])


def chebyshev_points(vehicle: SynchroDrive) -> Array:
    """Another control (1064, 2): a grid that is denser at its borders (Chebyshev-Lobatto)."""
    grid = _grid(vehicle, COARSE_SPEEDS, COARSE_ANGLES)
    lower, width = grid.min(axis=0), np.ptp(grid, axis=0)
    v, theta = ((1 - np.cos(np.pi * np.linspace(0, 1, n))) / 2 for n in (COARSE_SPEEDS, COARSE_ANGLES))
    return np.asarray(lower + width * np.array(np.meshgrid(v, theta, indexing="ij")).reshape(2, -1).T)


def _grid(vehicle: SynchroDrive, speeds: int, angles: int) -> Array:
    v = np.linspace(SLOWEST * vehicle.v_max, vehicle.v_max, speeds)
    theta = np.linspace(0, LARGEST, angles)
    return np.array(np.meshgrid(v, theta, indexing="ij")).reshape(2, -1).T
