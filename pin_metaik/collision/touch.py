"""Which links of a robot ever touch: found by sampling, then by going downhill in distance where sampling saw a gap."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.collision.body import Body, digest
from pin_metaik.collision.cache import Arrays, kept
from pin_metaik.collision.solids import Level, Placed, Solids
from pin_metaik.collision.srdf import Pair, pair_of

SEED = 20_261_125
SAMPLES = 500
ALWAYS = 0.95  # of the samples: links that touch so often are made so
CONTACT = 1e-6  # m; what is nearer touches, up to rounding
ENOUGH = 100  # samples of the meshes, for links whose hulls always touch
STARTS, STEPS, FIRST_STEP = 4, 50, 0.5  # of the descents in distance, the step in rad or m


@dataclass(frozen=True)
class Touch:
    """How often two links touch, and how near they get.

    Attributes:
        share: Of random configurations in which their hulls touch.
        meshes: The same of the original geometry; only looked at where the hulls nearly always touch, else 0.
        gap: Least distance of their hulls found, m; 0 when they touch.
    """

    share: float
    meshes: float
    gap: float

    @property
    def always(self) -> bool:
        """Whether they touch by construction."""
        return self.meshes >= ALWAYS


def touches(model: pin.Model, bodies: tuple[Body, ...]) -> dict[Pair, Touch]:
    """How the links of a robot touch each other, for every pair that moves against each other; kept on disk."""
    pieces = [
        (i, j) for j in range(len(bodies)) for i in range(j) if bodies[i].joint != bodies[j].joint
    ]  # pairs of bodies
    links = sorted({pair_of(bodies[i].link, bodies[j].link) for i, j in pieces})
    number = {pair: k for k, pair in enumerate(links)}
    owner = np.array([number[pair_of(bodies[i].link, bodies[j].link)] for i, j in pieces], dtype=np.int64)
    arrays = kept("touch", digest(model, bodies), lambda: _sample(model, bodies, pieces, owner, len(links)))
    return {
        pair: Touch(float(arrays["share"][k]), float(arrays["meshes"][k]), float(arrays["gap"][k]))
        for pair, k in number.items()
    }


def random_configurations(model: pin.Model, rng: np.random.Generator, count: int) -> NDArray[np.float64]:
    """Configurations (count, nq) drawn uniformly within the limits; a joint of several freedoms stays neutral."""
    Q = np.repeat(pin.neutral(model)[None], count, axis=0)
    for joint in list(model.joints)[1:]:
        i = joint.idx_q
        if joint.nq == 1:
            low, high = model.lowerPositionLimit[i], model.upperPositionLimit[i]
            low, high = (low if low > -1e3 else -np.pi), (high if high < 1e3 else np.pi)
            Q[:, i] = rng.uniform(low, high, count)
        elif joint.nq == 2 and joint.nv == 1:
            angle = rng.uniform(-np.pi, np.pi, count)
            Q[:, i], Q[:, i + 1] = np.cos(angle), np.sin(angle)
    return Q


def _sample(
    model: pin.Model, bodies: tuple[Body, ...], pieces: list[tuple[int, int]], owner: NDArray[np.int64], count: int
) -> Arrays:
    rng = np.random.default_rng(SEED)
    Q = random_configurations(model, rng, SAMPLES)
    solids = Solids(model, bodies)
    levels = [(solids.levels[i], solids.levels[j]) for i, j in pieces]
    hulls, originals = [(a.hull, b.hull) for a, b in levels], [(a.fine, b.fine) for a, b in levels]
    distances = np.array([_distances(solids.place(q), hulls) for q in Q]).reshape(SAMPLES, -1)  # (SAMPLES, pieces)
    by_link = np.full((SAMPLES, count), np.inf)
    np.minimum.at(by_link.T, owner, distances.T)
    share, gap = (by_link <= CONTACT).mean(axis=0), np.maximum(by_link.min(axis=0), 0.0)
    meshes = np.zeros(count)
    for link in np.flatnonzero(share >= ALWAYS):
        meshes[link] = _share(solids, [originals[k] for k in np.flatnonzero(owner == link)], Q[:ENOUGH])
    for piece in np.flatnonzero(gap[owner] > 0.0):
        starts = Q[np.argsort(distances[:, piece])[:STARTS]]
        i, j = pieces[piece]
        joints = bodies[i].joint, bodies[j].joint
        gap[owner[piece]] = min(gap[owner[piece]], _nearest(solids, hulls[piece], joints, starts, rng))
    return {"share": share, "meshes": meshes, "gap": gap}


def _distances(placed: Placed, pairs: Sequence[tuple[Level, Level]]) -> list[float]:
    return [placed.distance(a, b) for a, b in pairs]


def _share(solids: Solids, pieces: Sequence[tuple[Level, Level]], Q: NDArray[np.float64]) -> float:
    """Of the configurations Q (k, nq) in which any of the pieces touch; 0 as soon as it is certainly not ``ALWAYS``."""
    free = 0
    for q in Q:
        placed = solids.place(q)
        free += not any(placed.overlap(a, b, CONTACT) for a, b in pieces)
        if free > (1.0 - ALWAYS) * len(Q):
            return 0.0
    return 1.0 - free / len(Q)


def _nearest(
    solids: Solids,
    piece: tuple[Level, Level],
    joints: tuple[int, int],
    starts: NDArray[np.float64],
    rng: np.random.Generator,
) -> float:
    """The least distance that random steps downhill lead to, of those joints that move the two against each other."""
    model = solids.model
    moving = set(model.supports[joints[0]]) ^ set(model.supports[joints[1]])
    freedoms = [model.joints[joint].idx_v for joint in sorted(moving) if model.joints[joint].nv == 1]
    least = np.inf
    for q in starts:
        here, length = solids.place(q).distance(*piece), FIRST_STEP
        for _ in range(STEPS):
            step = np.zeros(model.nv)
            step[freedoms] = length * rng.standard_normal(len(freedoms))
            tried = np.clip(pin.integrate(model, q, step), model.lowerPositionLimit, model.upperPositionLimit)
            there = solids.place(tried).distance(*piece)
            if there < here:
                q, here, length = tried, there, 1.5 * length
            else:
                length *= 0.8
            if here <= 0.0:
                return 0.0
        least = min(least, here)
    return float(least)
