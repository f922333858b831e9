"""Laying out the checks of a world: which pairs of bodies are checked, at which margin, and in which order.

Pairs of moving bodies are sampled once:

1. Pairs that collide in most samples are checked first.
2. Two links of the robot that are nearer than the margin in most samples are adjacent by construction: for them the
   margin is 0.
3. Where the coarse solids of a pair overlap in most samples, and the original geometry does not, the coarse solids
   cannot decide, and the original geometry is checked directly.

Pairs of a moving and a fixed body are not sampled:

4. They are checked if their boxes are near.
5. An obstacle that is added or moved therefore costs its own pairs only.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple, TypeAlias

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.collision.body import Body
from pin_metaik.collision.checker import Checker
from pin_metaik.collision.contact import Contact
from pin_metaik.collision.solids import Level, Pairs, Solids
from pin_metaik.collision.srdf import Pair, pair_of
from pin_metaik.collision.touch import SEED, random_configurations

RESTS = 5e-7  # m; what is less deep stands on the other: coal's depths are good to a tenth of a micrometre or two
SAMPLES = 50
MOSTLY = 0.5  # of the samples


class Sampled(NamedTuple):
    """What samples say of two bodies that move against each other.

    Attributes:
        margin: Distance at or below which they collide, m.
        share: Of the samples in which their coarse solids overlap.
        direct: Whether the coarse solids decide nothing.
    """

    margin: float
    share: float
    direct: bool


Samples: TypeAlias = Mapping[tuple[Body, Body], Sampled]


def sample(solids: Solids, disabled: Mapping[Pair, str], known: Samples) -> Samples:
    """What samples say of the pairs of bodies that move against each other and are not disabled.

    Args:
        solids: The bodies.
        disabled: Names of the pairs of bodies that may touch.
        known: What is known already, of these or other pairs.
    """
    bodies = solids.moving
    pairs = [
        (a, b)
        for j, b in enumerate(bodies)
        for a in bodies[:j]
        if a.joint != b.joint and pair_of(a.link, b.link) not in disabled
    ]
    new = [pair for pair in pairs if pair not in known]
    if new:
        known = {**known, **dict(zip(new, _sample(solids, new), strict=True))}
    return {pair: known[pair] for pair in pairs}


def lay_out(solids: Solids, samples: Samples, disabled: Mapping[Pair, str], exact: bool) -> Checker:
    """The checks of the sampled pairs, and of all that moves against all that stands.

    Args:
        solids: The bodies.
        samples: The pairs of bodies that move against each other, and what samples say of them.
        disabled: Names of the pairs of bodies that may touch.
        exact: Whether the original geometry has the last word.
    """
    number = {body: k for k, body in enumerate(solids.moving)}
    ordered = sorted(samples.items(), key=lambda one: -one[1].share)
    own = np.array([(number[a], number[b]) for (a, b), _ in ordered], dtype=np.int64).reshape(-1, 2)
    margins = np.array([sampled.margin for _, sampled in ordered])
    may = _may_meet(solids, disabled)
    moves = np.array([body.joint > 0 for body in solids.moving], dtype=bool)
    against = np.ascontiguousarray(may & moves[:, None])
    held = np.array([body.part for body in solids.moving], dtype=bool) & ~moves
    return Checker(
        solids,
        Pairs(own, margins, against, solids.padding.margin),
        solids.padding,
        tuple(sampled.direct for _, sampled in ordered),
        _fixed(solids, np.ascontiguousarray(may & held[:, None])),
        exact,
    )


def _may_meet(solids: Solids, disabled: Mapping[Pair, str]) -> NDArray[np.bool_]:
    """Which bodies that move (m, s) are not allowed to touch which that stand."""
    may = np.ones((len(solids.moving), len(solids.standing)), dtype=bool)
    columns = {body.link: j for j, body in enumerate(solids.standing)}
    rows: dict[str, list[int]] = {}
    for i, body in enumerate(solids.moving):
        rows.setdefault(body.link, []).append(i)
    for pair in disabled:
        for first, second in (pair, pair[::-1]):
            if first in rows and second in columns:
                may[rows[first], columns[second]] = False
    return may


def _fixed(solids: Solids, against: NDArray[np.bool_]) -> tuple[Contact, ...]:
    """Overlaps of the robot's base with what stands in the world.

    They need no margin, as neither can come nearer, unless it was asked for the pair by name. A base that stands on
    something touches it, and does not overlap.
    """
    asked = Pairs(np.empty((0, 2), dtype=np.int64), np.empty(0), against, solids.padding.margin)
    found = Checker(solids, asked, solids.padding.pairs, (), (), exact=True).contacts(pin.neutral(solids.model))
    return tuple(contact for contact in found if contact.depth > RESTS)


def _sample(solids: Solids, pairs: Sequence[tuple[Body, Body]]) -> list[Sampled]:
    number = {body: k for k, body in enumerate(solids.moving)}
    own = np.array([(number[a], number[b]) for a, b in pairs], dtype=np.int64)
    levels = [(solids.levels[i], solids.levels[j]) for i, j in own.tolist()]
    Q = random_configurations(solids.model, np.random.default_rng(SEED), SAMPLES)
    padding = solids.padding
    margins = np.array([padding.between(a.link, b.link) for a, b in pairs])
    built = [a.part and b.part and not padding.names(a.link, b.link) for a, b in pairs]
    if margins.any():
        near = _shares(solids, own, margins, [(a.hull, b.hull) for a, b in levels], Q) >= MOSTLY
        margins[near & built] = 0.0
    coarse = _shares(solids, own, margins, [(a.first[b.flat], b.first[a.flat]) for a, b in levels], Q)
    often = np.flatnonzero(coarse >= MOSTLY)
    fine = [(a.last[b.flat], b.last[a.flat]) for a, b in levels]
    vain = np.zeros(len(pairs))
    vain[often] = coarse[often] - _shares(solids, own[often], margins[often], [fine[k] for k in often], Q)
    rows = zip(margins.tolist(), coarse.tolist(), (vain >= MOSTLY).tolist(), strict=True)
    return [Sampled(*row) for row in rows]


def _shares(
    solids: Solids,
    own: NDArray[np.int64],
    margins: NDArray[np.float64],
    levels: Sequence[tuple[Level, Level]],
    Q: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Of configurations Q (k, nq), in which share (p,) the two levels of each pair of bodies overlap."""
    hits = np.zeros(len(own))
    asked = Pairs(own, margins, np.zeros((len(solids.moving), len(solids.standing)), dtype=bool), 0.0)
    for q in Q:
        placed = solids.place(q)
        for _, _, k in placed.near(asked):
            hits[k] += placed.overlap(*levels[k], float(margins[k]))
    return hits / len(Q)
