"""A chain in one block of memory: every array that a compiled loop takes costs a call from Python another 40 ns."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from pin_metaik.compiled import Floats, Ints, inline
from pin_metaik.kinematics.atlas import LEAF
from pin_metaik.kinematics.kernel.descent import Arm, Bounds
from pin_metaik.kinematics.kernel.warm_starts import Atlas

Entries: TypeAlias = tuple[Floats, Floats, Ints]

SIZES = 6  # whole numbers at the beginning of a block: five lengths, and where the atlas begins


def pack(arm: Arm, bounds: Bounds, atlas: Atlas, entries: Entries, reach: Floats, form: Floats) -> Floats:
    """A block of eight-byte numbers, some of them integers or pairs of four-byte numbers.

    Of these arguments ``search`` does not have ``entries``: limits (nq,) of every entry of q, and (n, 2), where in q a
    coordinate is and whether it is a pair (cos, sin); ``reach`` (8,), what bounds the distance of the tip's point from
    a world point; and ``form`` (f, 3), the arm's closed form, if it has one.
    """
    (joints, wiring, ends, tips), (lower, upper, winds), (leaves, samples, gains, scale) = arm, bounds, atlas
    least, most, places = entries
    parts = joints, tips, lower, upper, least, most, reach, form, wiring, ends, winds, places
    tables = SIZES + sum(part.size for part in parts)
    sizes = np.array([len(joints), len(lower), len(least), len(form), len(leaves), tables])
    atlas_parts = np.array([scale]), leaves, samples, gains
    return np.concatenate([part.ravel().view(np.float64) for part in (sizes, *parts, *atlas_parts)])


@inline
def sizes_of(block: Floats) -> tuple[int, int]:
    """Joints and coordinates of the chain in a block."""
    sizes = block[:SIZES].view(np.int64)
    return sizes[0], sizes[1]


@inline
def unpack(block: Floats) -> tuple[Arm, Bounds, Entries, Floats, Floats]:
    """What ``pack`` took, but for the atlas."""
    sizes = block[:SIZES].view(np.int64)
    S, n, nq, f = sizes[0], sizes[1], sizes[2], sizes[3]
    tips = SIZES + 14 * S
    limits = tips + 12
    reach = limits + 2 * n + 2 * nq
    form = reach + 8
    rest = form + 3 * f
    whole = block[rest : rest + 2 * S + 2 + 3 * n].view(np.int64)
    ends = 2 * S
    winds = ends + 2
    least = limits + 2 * n
    return (
        (
            block[SIZES:tips].reshape(S, 14),
            whole[:ends].reshape(S, 2),
            whole[ends:winds],
            block[tips:limits].reshape(1, 12),
        ),
        (block[limits : limits + n], block[limits + n : least], whole[winds : winds + n]),
        (block[least : least + nq], block[least + nq : reach], whole[winds + n :].reshape(n, 2)),
        block[reach:form],
        block[form:rest].reshape(f, 3),
    )


@inline
def unpack_atlas(block: Floats) -> Atlas:
    """The atlas that ``pack`` took."""
    sizes = block[:SIZES].view(np.int64)
    n, L, scale = sizes[1], sizes[4], sizes[5]
    k = LEAF * (L - 1)
    tables = block[scale + 1 :].view(np.float32)
    samples = 9 * LEAF * L
    gains = samples + k * n
    return (
        tables[:samples].reshape(L, 9, LEAF),
        tables[samples:gains].reshape(k, n),
        tables[gains:].reshape(k, n, 6),
        block[scale],
    )
