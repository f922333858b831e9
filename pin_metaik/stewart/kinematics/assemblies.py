"""All assemblies of a platform: every pose at which six legs have given lengths.

Complex solutions of the equations are followed from dimensions drawn at random, where all 40 are known, to those of
the platform; see ``homotopy``. Whether none is missing is then a matter of counting: a platform has at most as many
separate assemblies, real and complex, as it has for complex lengths in general, and that is 40 (Ronga and Vust 1995)
or, where joints are shared or stand symmetrically, what is found of them for such lengths.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache, lru_cache
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, DTypeLike, NDArray

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidConfiguration, InvalidGeometry, InvalidSetting
from pin_metaik.randomness import as_generator
from pin_metaik.stewart.kernels.loading import load_homotopy
from pin_metaik.stewart.kinematics.forward import ForwardStatus, as_coordinates, newton
from pin_metaik.stewart.platform.geometry import MOST_LEGS, Geometry

Complexes = NDArray[np.complex128]

MOST = 40  # separate assemblies six legs can have
SEED = 20260101  # of the dimensions that paths begin at
STEADY, STEADIER = 1e-3, 1e-5  # first corrections of a path that is followed quickly, and with more care
LOOPS = 100  # at most until all 40 are known there; a dozen are usual
BARREN = 3  # loops that must bring nothing new before the solutions for a geometry count as all
DETOURS = 6  # further ways, where a path was lost
APART = 1e-10  # squared sine between two solutions that are two
INFINITE = 1e-9  # q'q of a unit quaternion pair at infinity
REAL = 1e-4  # imaginary part of a solution that may be a pose: Newton says whether it is
MIRROR = np.array([1.0, -1.0, -1.0, 1.0, -1.0, 1.0, 1.0, -1.0])  # (q, g) seen in a mirror at z = 0
BATCH = 256  # random starts at a time, where paths do not tell everything
PATIENCE = 4  # batches that must bring nothing new
SAME = 1e-6  # two poses nearer than this, in rad and in platform radii, are one


@dataclass(frozen=True, eq=False)
class Assemblies:
    """The assemblies for one set of leg lengths; can be used like the array of their poses (s, 4, 4).

    Attributes:
        poses: (s, 4, 4), highest first.
        complete: Whether these are all assemblies: as many real and complex solutions were found as there can be. False
            where solutions coincide (a leg length at which two assemblies become one), where the platform is singular,
            or where paths of the continuation were lost.
        solutions: How many solutions were found, real and complex.
        bound: Largest number of solutions for this geometry with any lengths; 0 for a singular mechanism.
    """

    poses: Array
    complete: bool
    solutions: int
    bound: int

    def __len__(self) -> int:
        return len(self.poses)

    def __iter__(self) -> Iterator[Array]:
        return iter(self.poses)

    def __getitem__(self, index: Any) -> Any:
        return self.poses[index]

    def __array__(self, dtype: DTypeLike | None = None, copy: bool | None = None) -> Array:
        return np.array(self.poses, dtype=dtype) if copy or copy is None else np.asarray(self.poses, dtype=dtype)

    def __str__(self) -> str:
        known = "all of them" if self.complete else "there may be more"
        return f"{len(self)} assemblies, {known}: {self.solutions} of {self.bound} solutions, real and complex"


@dataclass(frozen=True, eq=False)
class Start:
    """Where paths begin: legs (6, 7) as ``homotopy`` takes them, and all their solutions (s, 8)."""

    legs: Complexes
    points: Complexes


@checked
def all_forward(geometry: Geometry, coordinates: ArrayLike, rng: int | np.random.Generator | None = 0) -> Assemblies:
    """All assemblies: the poses at which six legs have these lengths, or their servos these angles; 0 to 40 of them.

    The highest comes first. A platform with linear actuators and planar base and platform joints has, for every
    assembly above the base, its mirror image below. With servos these are the assemblies of the rods from the tips of
    the horns, on either branch.

    Args:
        geometry: A platform with six legs.
        coordinates: (6,), lengths in m or angles in rad.
        rng: Seed or generator of the detours and random starts that are tried where the first paths do not find all
            solutions; the same seed gives the same poses.

    Returns:
        The poses; ``complete`` says whether none is missing.

    Raises:
        InvalidConfiguration: Coordinates of the wrong shape or not finite, or lengths that are not above zero.
        InvalidSetting: Fewer than six legs: their poses form a continuum.
        InvalidGeometry: A singular mechanism: its platform can move while the legs are held.
    """
    if geometry.n < MOST_LEGS:
        raise InvalidSetting(
            f"{geometry.n} legs leave {MOST_LEGS - geometry.n} degrees of freedom: assemblies need six legs"
        )
    d = as_coordinates(geometry, coordinates)
    if len(d) != 1:
        raise InvalidConfiguration(f"all assemblies are found for one set of coordinates, got {len(d)}")
    if geometry.servos is not None:
        geometry, d = _held(geometry, d)
    generator = as_generator(rng)
    points, bound = _solutions(geometry, (d[0] / _size(geometry)) ** 2, generator)
    poses, certain = _real(geometry, d, points)
    complete = certain and len(points) == bound > 0
    if not complete:
        poses = _by_chance(geometry, d, poses, generator)
    highest = np.lexsort((poses[:, 0, 3], poses[:, 1, 3], -poses[:, 2, 3].round(9)))
    return Assemblies(poses[highest], complete, len(points), bound)


def _held(geometry: Geometry, q: Array) -> tuple[Geometry, Array]:
    """A platform whose servos are held at angles (1, 6): slides from the tips of its horns, and their lengths."""
    (tips,), rods = geometry.actuation.held(geometry.b, q)
    legs = tuple((i, platform) for i, (_, platform) in enumerate(geometry.legs))
    parts: dict[str, Any] = {"base_radius": 0.0, "base_angles": (), "base": tuple(map(tuple, tips.tolist()))}
    return replace(geometry, legs=legs, servos=None, **parts), np.array(rods)


def _solutions(geometry: Geometry, squares: Array, rng: np.random.Generator) -> tuple[Complexes, int]:
    """Solutions (s, 8) for squared lengths (6,) in units of the geometry's size, and how many there can be."""
    target = _legs(geometry, squares)

    def with_images(points: Complexes) -> Complexes:
        """The equations are real, so that solutions come in conjugate pairs."""
        return _with_mirror_images(geometry, _distinct(np.concatenate((points, points.conj()))))

    points = with_images(_followed(_general_start(), target, STEADY))
    if len(points) == MOST:
        return points, MOST
    start = _geometry_start(geometry)
    bound = len(start.points)
    points = with_images(np.concatenate((points, _followed(start, target, STEADY))))
    for detour in range(DETOURS):
        if len(points) >= bound:
            break
        ways = (start, _legs(geometry, _complex(rng, MOST_LEGS))), (_general_start(), _anywhere(rng))
        by_way = _moved(*ways[detour % 2])
        points = with_images(np.concatenate((points, _followed(by_way, target, STEADIER))))
    return points, bound


@cache
def _general_start() -> Start:
    """Dimensions drawn at random and their 40 solutions, found by going round loops: each permutes the solutions."""
    rng = as_generator(SEED)
    q, p, ends = _complex(rng, 4), _complex(rng, 3), _ends(rng)
    g = 0.5 * np.concatenate(([-p @ q[1:]], q[0] * p + np.cross(p, q[1:])))  # 2 g = p q
    v: Complexes = p + ends[:, 3:] @ _homogeneous(q).T / (q @ q) - ends[:, :3]
    legs: Complexes = np.column_stack((ends, (v * v).sum(axis=1)))
    points: Complexes = np.concatenate((q, g))[None].astype(complex)
    for _ in range(LOOPS):
        if len(points) == MOST:
            break
        points = _round(Start(legs, points), _anywhere(rng), _anywhere(rng))
    return Start(legs, points)


@lru_cache(maxsize=64)
def _geometry_start(geometry: Geometry) -> Start:
    """All solutions of a geometry for complex lengths in general.

    They are the ends of 40 paths from any start, and a loop through other lengths permutes them: both until neither
    brings anything new.
    """
    rng = as_generator(SEED)
    legs = _legs(geometry, _complex(rng, MOST_LEGS))
    points = _with_mirror_images(geometry, _followed(_general_start(), legs, STEADY))
    barren = 0
    while len(points) < MOST and barren < BARREN:
        again = _followed(_moved(_general_start(), _anywhere(rng)), legs, STEADIER)
        ways = (_legs(geometry, _complex(rng, MOST_LEGS)) for _ in range(2))
        more = np.concatenate((again, _round(Start(legs, points), *ways)))
        more = _with_mirror_images(geometry, _distinct(more))
        barren = barren + 1 if len(more) == len(points) else 0
        points = more
    return Start(legs, points)


def _round(start: Start, first: Complexes, second: Complexes) -> Complexes:
    """The solutions at a start, and those that a loop by two other places leads to."""
    there = _moved(_moved(start, first), second)
    return _distinct(np.concatenate((start.points, _followed(there, start.legs, STEADY))))


def _moved(start: Start, legs: Complexes) -> Start:
    """A start at another place, with the solutions that the paths there lead to."""
    return Start(legs, _followed(start, legs, STEADIER))


def _followed(start: Start, target: Complexes, steady: float) -> Complexes:
    """The separate solutions (s, 8) at the target that the paths from a start lead to."""
    points = np.array(start.points)
    states, times = np.empty(len(points), dtype=np.int64), np.empty(len(points))
    kernel = load_homotopy()
    kernel.follow(start.legs, target, steady, points, times, states)
    q = points[:, :4]
    finite = np.abs((q * q).sum(axis=1)) > INFINITE * (np.abs(q) ** 2).sum(axis=1)
    return _distinct(points[(states == kernel.ARRIVED) & finite])


def _with_mirror_images(geometry: Geometry, points: Complexes) -> Complexes:
    """Points (s, 8) and, where both sides of the platform are level planes, their mirror images in the base's."""
    if np.ptp(geometry.b[:, 2]) > 0.0 or np.ptp(geometry.m[:, 2]) > 0.0:
        return points
    return _distinct(np.concatenate((points, points * MIRROR)))


def _distinct(points: Complexes) -> Complexes:
    """Points (s, 8) without those that are another one's multiple."""
    unit: Complexes = points / np.linalg.norm(points, axis=1, keepdims=True)
    alike = 1.0 - np.abs(unit.conj() @ unit.T) ** 2 < APART
    separate: Complexes = unit[~np.tril(alike, -1).any(axis=1)]
    return separate


def _real(geometry: Geometry, d: Array, points: Complexes) -> tuple[Array, bool]:
    """The poses (s, 4, 4) among the solutions, and whether it is certain for each whether it is one."""
    largest = points[np.arange(len(points)), np.abs(points).argmax(axis=1)]
    turned = points * (np.abs(largest) / largest)[:, None]
    near = turned[np.abs(turned.imag).max(axis=1) < REAL].real
    T = np.tile(np.eye(4), (len(near), 1, 1))
    for pose, (q, g) in zip(T, near.reshape(-1, 2, 4), strict=True):
        pose[:3, :3] = pin.Quaternion(*(q / np.linalg.norm(q))).matrix()
        first = 2.0 * _size(geometry) / (q @ q) * (q[0] * g[1:] - g[0] * q[1:] + np.cross(q[1:], g[1:]))
        pose[:3, 3] = first + geometry.b[0] - pose[:3, :3] @ geometry.m[0]
    result = newton(geometry, np.repeat(d, len(T), axis=0), T.copy())
    found = np.empty((0, 4, 4))
    for pose in result.poses[result.solved]:
        if not _known(pose, found, geometry.platform_radius):
            found = np.concatenate((found, pose[None]))
    return found, len(found) == len(near)


def _by_chance(geometry: Geometry, d: Array, found: Array, rng: np.random.Generator) -> Array:
    """These poses and those that Newton finds from random starts, until four batches in a row bring nothing new.

    Raises:
        InvalidGeometry: There are more than can be separate, or every start is singular.
    """
    barren = 0
    while barren < PATIENCE:
        result = newton(geometry, np.repeat(d, BATCH, axis=0), _random(geometry, d, rng))
        fresh = [found]
        for pose in result.poses[result.solved]:
            if not _known(pose, np.concatenate(fresh), geometry.platform_radius):
                fresh.append(pose[None])
        if sum(map(len, fresh)) > MOST or (result.states == ForwardStatus.SINGULAR).all():
            raise InvalidGeometry("this mechanism is singular: its platform moves while these legs are held")
        barren = barren + 1 if len(fresh) == 1 else 0
        found = np.concatenate(fresh)
    return found


def _size(geometry: Geometry) -> float:
    """The length in m that counts as 1 along paths."""
    return float(np.sqrt(geometry.b.var(axis=0).sum() + geometry.m.var(axis=0).sum()))


def _legs(geometry: Geometry, squares: NDArray[Any]) -> Complexes:
    """b, m and d^2 of each leg (6, 7), from the ends of the first and in units of the geometry's size."""
    ends = np.column_stack((geometry.b - geometry.b[0], geometry.m - geometry.m[0])) / _size(geometry)
    return np.column_stack((ends, squares)).astype(complex)


def _complex(rng: np.random.Generator, shape: int | tuple[int, ...]) -> Complexes:
    """Complex numbers of modulus 1 on average."""
    numbers: Complexes = (rng.standard_normal(shape) + 1j * rng.standard_normal(shape)) / np.sqrt(2.0)
    return numbers


def _anywhere(rng: np.random.Generator) -> Complexes:
    """Legs (6, 7) of no particular platform."""
    return np.column_stack((_ends(rng), _complex(rng, MOST_LEGS)))


def _ends(rng: np.random.Generator) -> Complexes:
    """Ends b and m (6, 6) of legs, zero for the first."""
    ends = _complex(rng, (MOST_LEGS, 6))
    ends[0] = 0.0
    return ends


def _homogeneous(q: Complexes) -> Complexes:
    """q'q times the rotation matrix (3, 3) of a quaternion."""
    w, v = q[0], q[1:]
    cross = np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])
    turned: Complexes = (w * w - v @ v) * np.eye(3) + 2.0 * np.outer(v, v) + 2.0 * w * cross
    return turned


def _random(geometry: Geometry, d: Array, rng: np.random.Generator) -> Array:
    """Random poses (BATCH, 4, 4) in the ball that the longest leg sweeps, in any orientation."""
    T = np.tile(np.eye(4), (BATCH, 1, 1))
    quaternions = rng.standard_normal((BATCH, 4))
    for k, quaternion in enumerate(quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)):
        T[k, :3, :3] = pin.Quaternion(quaternion).matrix()
    reach = d.max() + np.linalg.norm(geometry.m, axis=1).max()
    T[:, :3, 3] = geometry.b.mean(axis=0) + rng.uniform(-reach, reach, (BATCH, 3))
    return T


def _known(pose: Array, poses: Array, size: float) -> bool:
    """Whether a pose is among these (s, 4, 4): matrix entries differ by the angle at most."""
    near = (np.abs(poses[:, :3, :3] - pose[:3, :3]) < SAME).all(axis=(1, 2))
    near &= (np.abs(poses[:, :3, 3] - pose[:3, 3]) < SAME * size).all(axis=1)
    return bool(near.any())
