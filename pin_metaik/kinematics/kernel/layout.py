"""Where every number lies that the compiled loops take: the only file that knows.

Arrays and blocks of numbers are what a call from Python can hand over cheaply (40 ns an array; a tuple of arrays takes
microseconds); names inside the loops cost nothing, as they are constants there. Nothing here needs numba: what reads a
block is written as plain Python, and compiled by the loops that use it.

S joints on all paths, T tips, n coordinates, nq entries of a configuration. ``x`` is (n,), a population ``X`` (k, n).
A *pose* is 12 numbers: its rotation row by row, then its translation.

| array | shape | of each row |
|---|---|---|
| ``joints`` | (S, JOINT) | pose of the joint frame, turned so that its axis is z, in the one before; SCALE, SHIFT |
| ``wiring`` | (S, 2) | COLUMN of x that the joint follows: angle or travel = scale x + shift; ROTATES: 1, slides: 0 |
| ``ends`` | (T + 1,) | joints ``ends[t]:ends[t + 1]`` lead from the world to tip t; paths may share columns |
| ``tips`` | (T, 12) | pose of the tip in its last joint frame |
| ``goals`` | (T, GOAL) | pose of the world in the target frame; SLACK and WEIGHT an axis; NEAR (m), ALIGNED (rad) |
| ``rows`` | (m, 2) | TIP and AXIS of what counts: slack finite |
| ``form`` | (16, 3) | the closed form of an arm: see ``closed_form.closed_form`` |
| ``reach`` | (8,) | ANCHOR in the world, END in the tip frame; LEAST and MOST, m, between them |
| ``places`` | (n, 2) | ENTRY of q of a coordinate; PAIR: whether that is a cosine and its sine |

Where the slack of position or of orientation is below 0, it is minus the radius of a ball for the three axes at once.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

Floats: TypeAlias = NDArray[np.float64]
Singles: TypeAlias = NDArray[np.float32]
Ints: TypeAlias = NDArray[np.int64]

# A row of joints, of wiring, of rows and of places.
SCALE, SHIFT, JOINT = 12, 13, 14
COLUMN, ROTATES = 0, 1
TIP, AXIS = 0, 1
ENTRY, PAIR = 0, 1

# A goal: a pose, slack and weight of six axes, of position and from TURN on of orientation, and two tolerances.
POSE, GOAL = 12, 26
SLACK, TURN_SLACK, WEIGHT, TURN_WEIGHT, NEAR, ALIGNED = 12, 15, 18, 21, 24, 25
TURN = 3

# Rows of a closed form, and the numbers in its last one.
H1, H2, H3, H4, H5, H6, O1, O1_O2, UPPER, FORE, O4_O5, O5_TIP, AHEAD, ACROSS, ACROSS_WORLD = range(15)
LEVEL, SIDE_2, SIDE_3 = (15, 0), (15, 1), (15, 2)

# The reach of one tip.
ANCHOR, END, LEAST, MOST, REACH = 0, 3, 6, 7, 8

# Settings of a descent, the first four; all of them: of the pose solver.
DAMPING, PROGRESS, PER_START, EVALUATIONS = 0, 1, 2, 3
DISTANCE, ANGLE, WITHOUT_BRANCH, FEW, FAR = 4, 5, 6, 7, 8

LEAF = 64  # entries a leaf of a table of samples, and leaves a table
DONE, DESCEND, SEARCH = 0, 1, 2  # what is left to do: nothing, from a branch that is nearly there, or from anywhere
REFUSED = -1  # evaluations of what is no pose, or no configuration to start from
ROUNDING = 1e-9  # m, of a target and of what is compared with it
ORTHONORMAL = 1e-6  # how far R'R may be from the identity, and det R from 1, of what is taken for a rotation


class Arm(NamedTuple):
    """The joints on the way to the tips."""

    joints: Floats
    wiring: Ints
    ends: Ints
    tips: Floats


class Bounds(NamedTuple):
    """Limits (n,) of the coordinates, and whether whole turns of each fit inside."""

    lower: Floats
    upper: Floats
    multi_turn: Ints


class Entries(NamedTuple):
    """Limits (nq,) of the entries of a configuration, and where in it the coordinates are."""

    least: Floats
    most: Floats
    places: Ints


class Samples(NamedTuple):
    """Sampled configurations; see ``SampleTable``. ``x`` is (c LEAF, n), without rows where there is no table."""

    leaves: Singles
    x: Singles
    gains: Singles
    scale: float


class Packed(NamedTuple):
    """What a block holds but for the samples."""

    arm: Arm
    bounds: Bounds
    entries: Entries
    reach: Floats
    form: Floats


SIZES = 7  # whole numbers at the beginning of a block: six lengths, and where the samples begin


def pack(packed: Packed, samples: Samples) -> Floats:
    """A chain in one block of eight-byte numbers, some of them integers or pairs of four-byte numbers."""
    (joints, wiring, ends, tips), (lower, upper, multi_turn), (least, most, places), reach, form = packed
    parts = joints, tips, lower, upper, least, most, reach, form, wiring, ends, multi_turn, places
    begin = SIZES + sum(part.size for part in parts)
    sizes = np.array([len(joints), len(lower), len(least), len(form), len(samples.leaves), begin, len(tips)])
    tables = np.array([samples.scale]), samples.leaves, samples.x, samples.gains
    return np.concatenate([part.ravel().view(np.float64) for part in (sizes, *parts, *tables)])


def sizes_in(block: Floats) -> tuple[int, int, int]:
    """Joints, coordinates and tips of the chain in a block."""
    sizes = block[:SIZES].view(np.int64)
    return sizes[0], sizes[1], sizes[6]


def chain_in(block: Floats) -> Packed:
    """What ``pack`` took, but for the samples: views of the block."""
    sizes = block[:SIZES].view(np.int64)
    S, n, nq, f, T = sizes[0], sizes[1], sizes[2], sizes[3], sizes[6]
    tips = SIZES + JOINT * S
    lower = tips + POSE * T
    upper, least = lower + n, lower + 2 * n
    most, reach = least + nq, least + 2 * nq
    form = reach + REACH
    rest = form + 3 * f
    whole = block[rest : rest + 2 * S + T + 1 + 3 * n].view(np.int64)
    ends = 2 * S
    multi_turn = ends + T + 1
    places = multi_turn + n
    return Packed(
        Arm(
            block[SIZES:tips].reshape(S, JOINT),
            whole[:ends].reshape(S, 2),
            whole[ends:multi_turn],
            block[tips:lower].reshape(T, POSE),
        ),
        Bounds(block[lower:upper], block[upper:least], whole[multi_turn:places]),
        Entries(block[least:most], block[most:reach], whole[places:].reshape(n, 2)),
        block[reach:form],
        block[form:rest].reshape(f, 3),
    )


def samples_in(block: Floats) -> Samples:
    """The samples that ``pack`` took: views of the block."""
    sizes = block[:SIZES].view(np.int64)
    n, L, scale, T = sizes[1], sizes[4], sizes[5], sizes[6]
    k = LEAF * max(L - 1, 0)
    tables = block[scale + 1 :].view(np.float32)
    x = 9 * T * LEAF * L
    gains = x + k * n
    return Samples(
        tables[:x].reshape(L, 9 * T, LEAF),
        tables[x:gains].reshape(k, n),
        tables[gains:].reshape(k, n, 6),
        block[scale],
    )


class PoseScratch(NamedTuple):
    """Where the pose solver works on one target: the goal, coordinates (n,), and what ``forward`` writes."""

    goal: Floats
    guess: Floats
    start: Floats
    best: Floats
    pose: Floats
    error: Floats
    axes: Floats
    origins: Floats


def pose_scratch_shapes(n: int, S: int) -> tuple[int, tuple[int, int]]:
    """Shapes of the two arrays that ``pose_scratch_in`` reads: two are made in less time than eight."""
    return GOAL + 3 * n + POSE + 6, (2 * S, 3)


def pose_scratch_in(numbers: Floats, lines: Floats, n: int) -> PoseScratch:
    """The parts of the two arrays: views of them."""
    S = lines.shape[0] // 2
    a, b, c = GOAL + n, GOAL + 2 * n, GOAL + 3 * n
    return PoseScratch(
        numbers[:GOAL], numbers[GOAL:a], numbers[a:b], numbers[b:c], numbers[c : c + POSE], numbers[c + POSE :],
        lines[:S], lines[S:],
    )  # fmt: skip
