"""Which links of a robot ever touch: found by sampling, then by going downhill in distance where samples keep apart."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.collision.approach import Approach
from pin_metaik.collision.body import Body, digest
from pin_metaik.collision.cache import Arrays, kept, where_kept
from pin_metaik.collision.solids import Level, Pairs, Solids
from pin_metaik.collision.srdf import Pair, pair_of
from pin_metaik.notice import notice
from pin_metaik.watching import Progress, Watch, tell

SEED = 20_261_125
SAMPLES = 500
ALWAYS = 0.95  # of the samples: links that touch so often count as touching by construction
CONTACT = 1e-6  # m; what is nearer touches, up to rounding
ENOUGH = 100  # samples of the meshes, for links whose hulls always touch
STARTS = 4  # of the descents in distance, where samples came nearest
MORE_STARTS, CLOSE = 24, 0.2  # at random, for what then comes closer than this, m


@dataclass(frozen=True)
class Touch:
    """How often two links touch, and how near they get.

    Attributes:
        share: Of random configurations in which their hulls touch.
        meshes: The same of the original geometry; only looked at where the hulls nearly always touch, else 0.
        gap: Least distance of their hulls inside the limits found, m; 0 when they touch.
    """

    share: float
    meshes: float
    gap: float

    @property
    def always(self) -> bool:
        """Whether they touch by construction."""
        return self.meshes >= ALWAYS


def touches(model: pin.Model, bodies: tuple[Body, ...], watch: Watch | None = None) -> dict[Pair, Touch]:
    """How the links of a robot touch each other, for every pair that moves against each other; kept on disk.

    Raises:
        Stopped: The watch says so.
    """
    pieces = [
        (i, j) for j in range(len(bodies)) for i in range(j) if bodies[i].joint != bodies[j].joint
    ]  # pairs of bodies
    links = sorted({pair_of(bodies[i].link, bodies[j].link) for i, j in pieces})
    number = {pair: k for k, pair in enumerate(links)}
    owner = np.array([number[pair_of(bodies[i].link, bodies[j].link)] for i, j in pieces], dtype=np.int64)
    arrays = kept("touch", digest(model, bodies), lambda: _sample(model, bodies, pieces, owner, len(links), watch))
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
    model: pin.Model,
    bodies: tuple[Body, ...],
    pieces: list[tuple[int, int]],
    owner: NDArray[np.int64],
    count: int,
    watch: Watch | None,
) -> Arrays:
    total = SAMPLES + len(pieces)
    rng = np.random.default_rng(SEED)
    Q = random_configurations(model, rng, SAMPLES)
    solids = Solids(model, bodies)
    levels = [(solids.levels[i], solids.levels[j]) for i, j in pieces]
    hulls, originals = [(a.hull, b.hull) for a, b in levels], [(a.fine, b.fine) for a, b in levels]
    approaches = [Approach(solids, i, j) for i, j in pieces]
    distances, by_link = np.full((SAMPLES, len(pieces)), np.inf), np.full((SAMPLES, count), np.inf)
    nearest = np.full((STARTS, len(pieces)), np.inf)  # distances of each pair: no start is farther away
    apart = np.zeros((len(bodies), 0), dtype=bool)
    asked = Pairs(np.array(pieces, dtype=np.int64).reshape(-1, 2), np.zeros(len(pieces)), apart, 0.0)
    work = f"looking for links of {model.name} that can touch, once; {where_kept()}"
    with notice(work, total) as line:
        for k, q in enumerate(Q):
            tell(watch, Progress(k, total))
            placed = solids.place(q)
            near = np.flatnonzero(placed.bounds(asked) <= np.maximum(nearest[-1], CONTACT))
            distances[k, near] = [placed.distance(*hulls[pair]) for pair in near]
            nearest = np.sort(np.concatenate([nearest, distances[None, k]]), axis=0)[:STARTS]
            line.step()
        np.minimum.at(by_link.T, owner, distances.T)
        share, gap = (by_link <= CONTACT).mean(axis=0), np.maximum(by_link.min(axis=0), 0.0)
        for k, approach in enumerate(approaches):
            tell(watch, Progress(SAMPLES + k, total))
            if gap[owner[k]] > 0.0:  # no other piece of the two links touches
                least = _nearest(approach, Q[np.argsort(distances[:, k])[:STARTS]], rng)
                gap[owner[k]] = min(gap[owner[k]], least)
            line.step()
    meshes = np.zeros(count)
    for link in np.flatnonzero(share >= ALWAYS):
        meshes[link] = _share(solids, [originals[k] for k in np.flatnonzero(owner == link)], Q[:ENOUGH])
    return {"share": share, "meshes": meshes, "gap": gap}


def _share(solids: Solids, pieces: Sequence[tuple[Level, Level]], Q: NDArray[np.float64]) -> float:
    """Of the configurations Q (k, nq) in which any of the pieces touch; 0 as soon as it is certainly not ``ALWAYS``."""
    free = 0
    for q in Q:
        placed = solids.place(q)
        free += not any(placed.overlap(a, b, CONTACT) for a, b in pieces)
        if free > (1.0 - ALWAYS) * len(Q):
            return 0.0
    return 1.0 - free / len(Q)


def _nearest(approach: Approach, starts: NDArray[np.float64], rng: np.random.Generator) -> float:
    """The least distance (m) that descents lead to, from starts (k, nq) and, if that is little, from random ones.

    Where a joint of several freedoms moves the two against each other, of which samples say nothing, it is 0.
    """
    if approach.several:
        return 0.0
    least = np.inf
    for number, q in enumerate((*starts, *random_configurations(approach.model, rng, MORE_STARTS))):
        if least <= 0.0 or (least > CLOSE and number >= len(starts)):
            break
        least = min(least, max(approach.descend(q)[0], 0.0))
    return float(least)
