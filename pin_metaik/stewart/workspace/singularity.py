"""Singularity analysis: where the legs no longer hold the platform, over a workspace and along a trajectory."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.stewart.kinematics.conditioning import measure
from pin_metaik.stewart.kinematics.golden import golden_section
from pin_metaik.stewart.kinematics.jacobian import transmission
from pin_metaik.stewart.kinematics.trajectory import Trajectory, between
from pin_metaik.stewart.platform.geometry import Geometry
from pin_metaik.stewart.platform.states import PoseState
from pin_metaik.stewart.workspace.workspace import Verdict, Workspace

HALVINGS = 50
TOUCHES = 1e-7  # nu at which a trajectory touches a singular surface: what a minimum can be found to


@dataclass(frozen=True, eq=False)
class Singularities:
    """The singular poses of a workspace, and how near it comes to singularities of the first kind.

    Attributes:
        verdict: Whether the mechanism holds its platform throughout.
        poses: Poses of the grid that are singular (s, 4, 4).
        crossings: Poses half-way between neighbours of the grid with opposite signs of det J (c, 4, 4): the singular
            surface passes within half a cell of each.
        nearest: The pose (4, 4) reached that has the lowest nu.
        nu: The nu of ``nearest``; 0 if it is singular.
        transmission: The least transmission of a servo at the poses reached: 0 in a singularity of the first kind,
            where a rod is in line with its horn and its two branches meet; 1 for linear actuators, which have none.
        weakest: The pose (4, 4) with that transmission; None for linear actuators.
    """

    verdict: Verdict
    poses: Array
    crossings: Array
    nearest: Array
    nu: float
    transmission: float = 1.0
    weakest: Array | None = None


@checked
def singularities(workspace: Workspace) -> Singularities:
    """Look for singular poses in a workspace; with fewer than six legs det J does not exist, nor ``crossings``."""
    steps = workspace.cells.steps
    states = workspace.states.reshape(*workspace.states.shape[:3], *steps)
    crossings = [np.empty((0, 4, 4))]
    for axis in range(states.ndim):
        sides = np.moveaxis(states, axis, 0)
        met = sides[:-1] * sides[1:] == PoseState.POSITIVE * PoseState.NEGATIVE  # only these two make 2
        here = np.argwhere(np.moveaxis(met, 0, axis))
        there = here + (np.arange(states.ndim) == axis)
        ends = (workspace.poses_of(_flat(index, steps)) for index in (here, there))
        crossings += [between(first, last, 0.5)[None] for first, last in zip(*ends, strict=True)]
    found = Singularities(
        workspace.verdict,
        workspace.poses(workspace.states == PoseState.SINGULAR),
        np.concatenate(crossings),
        workspace.worst,
        float(workspace.nu[workspace.reached].min()),
    )
    if workspace.geometry.servos is None:
        return found
    poses = workspace.poses(workspace.reached)
    least = transmission(workspace.geometry, poses).min(axis=1)
    return replace(found, transmission=float(least.min()), weakest=poses[least.argmin()])


def _flat(index: NDArray[np.int64], steps: tuple[int, int, int]) -> NDArray[np.int64]:
    """Indices (r, 4) of a workspace's arrays from those (r, 6) with roll, pitch and yaw apart."""
    return np.column_stack((index[:, :3], np.ravel_multi_index(tuple(index[:, 3:].T), steps)))


@dataclass(frozen=True, eq=False)
class Crossing:
    """A singular pose on a trajectory, in which the platform can move while its legs are held.

    Attributes:
        time: When, s.
        pose: Where (4, 4).
        crosses: Whether det J changes sign there; otherwise the singular surface is touched or followed.
    """

    time: float
    pose: Array
    crosses: bool


@checked
def crossings(geometry: Geometry, trajectory: Trajectory) -> list[Crossing]:
    """The singular poses of a trajectory, in order of time.

    Between two samples, one change of the sign of det J, or one minimum of nu at which it is zero, is found: sample
    finely enough that there is at most one.
    """
    times = trajectory.times
    nu, states = _at(geometry, trajectory, times)
    regular = states == PoseState.POSITIVE
    holds = nu > 0.0
    found = []
    for k in np.flatnonzero(states == PoseState.SINGULAR):
        ends = (*regular[:k][holds[:k]][-1:], *regular[k:][holds[k:]][:1])  # the signs before and after, if there are
        found.append(Crossing(float(times[k]), trajectory.poses[k], len(ends) == 2 and bool(ends[0] != ends[1])))
    for k in np.flatnonzero((regular[:-1] != regular[1:]) & holds[:-1] & holds[1:]):
        found.append(_bisect(geometry, trajectory, times[k], times[k + 1], bool(regular[k])))
    for k in np.flatnonzero((nu[1:-1] <= nu[:-2]) & (nu[1:-1] < nu[2:]) & holds[1:-1]) + 1:
        if regular[k - 1] == regular[k] == regular[k + 1]:
            found += _touch(geometry, trajectory, times[k - 1], times[k + 1])
    return sorted(found, key=lambda crossing: crossing.time)


def _at(geometry: Geometry, trajectory: Trajectory, times: Array) -> tuple[Array, NDArray[np.int8]]:
    return measure(geometry, trajectory.at(times), geometry.platform_radius, "frobenius")


def _bisect(geometry: Geometry, trajectory: Trajectory, low: float, high: float, regular: bool) -> Crossing:
    """Halve the interval in which the sign changes, from regular (or not) at its beginning."""
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        state = _at(geometry, trajectory, np.array([middle]))[1][0]
        if (state == PoseState.POSITIVE) == regular:
            low = middle
        else:
            high = middle
    time = 0.5 * (low + high)
    return Crossing(time, trajectory.at(time)[0], True)


def _touch(geometry: Geometry, trajectory: Trajectory, low: float, high: float) -> list[Crossing]:
    """The minimum of nu in an interval, if it is a singular pose."""

    def nu(time: float) -> float:
        return float(_at(geometry, trajectory, np.array([time]))[0][0])

    time = golden_section(nu, low, high)
    return [Crossing(time, trajectory.at(time)[0], False)] if nu(time) < TOUCHES else []
