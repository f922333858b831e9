"""Forward kinematics: where joints and tips are, as compiled loops have it.

Compiling a single forward kinematics gains nothing over Pinocchio (0.8 us); compiling whole loops does, because the
call from Python (1-3 us) is then paid once.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from pin_metaik.compiled import Floats, Ints, exact, inline, jit, separate
from pin_metaik.kinematics.kernel.layout import COLUMN, ROTATES, SCALE, SHIFT, chain_in, sizes_in

FULL_TURN = 2.0 * np.pi
IDENTITY = np.array([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0])

sizes_of, unpack = inline(sizes_in), separate(chain_in)


@inline
def copy(source: NDArray[Any], target: NDArray[Any]) -> None:
    """Copy (n,) numbers; an assignment of slices compiles for two seconds longer, for the message it might raise."""
    for i in range(target.shape[0]):
        target[i] = source[i]


@inline
def nearest_turn(x: float, x0: float, lower: float, upper: float) -> float:
    """The angle moved by the whole turns that bring it nearest to x0 between the bounds; below them if none does."""
    turns = np.round((x0 - x) / FULL_TURN)
    turns = min(max(turns, np.ceil((lower - x) / FULL_TURN)), np.floor((upper - x) / FULL_TURN))
    return float(x + FULL_TURN * turns)


@exact
def cos_sin(x: float) -> tuple[float, float]:
    """Cosine and sine to 2e-16 for |x| < 1e5: Cody-Waite reduction, minimax polynomials; half the time of libm's."""
    k = np.floor(x * 0.63661977236758134308 + 0.5)
    r = (x - k * 1.5707963267341256) - k * 6.0771005065061922e-11
    z = r * r
    s = z * (2.75573136213857245213e-6 + z * (-2.50507477628578072866e-8 + z * 1.58962301576546568060e-10))
    s = r + r * z * (
        -1.66666666666666307295e-1 + z * (8.33333333332211858878e-3 + z * (-1.98412698295895385996e-4 + s))
    )
    c = z * (-2.75573141792967388112e-7 + z * (2.08757008419747316778e-9 + z * -1.13585365213876817300e-11))
    c = z * (-1.38888888888730564116e-3 + z * (2.48015872888517045348e-5 + c))
    c = 1.0 - 0.5 * z + z * z * (4.16666666666665929218e-2 + c)
    quarter = np.int64(k) & 3
    if quarter & 1:
        s, c = c, s
    if quarter & 2:
        s = -s
    if (quarter + 1) & 2:
        c = -c
    return c, s


@inline
def forward(
    joints: Floats,
    wiring: Ints,
    first: int,
    last: int,
    tip: Floats,
    start: Floats,
    x: Floats,
    axes: Floats,
    origins: Floats,
    pose: Floats,
) -> None:
    """Pose (12,) of one tip, and axis and origin (S, 3) of each joint on its path, in the frame of ``start``."""
    a, b, c, d, e, f, g, h, i = start[0], start[1], start[2], start[3], start[4], start[5], start[6], start[7], start[8]
    px, py, pz = start[9], start[10], start[11]
    for s in range(first, last):
        P = joints[s]
        px += a * P[9] + b * P[10] + c * P[11]
        py += d * P[9] + e * P[10] + f * P[11]
        pz += g * P[9] + h * P[10] + i * P[11]
        ux, vx, c = a * P[0] + b * P[3] + c * P[6], a * P[1] + b * P[4] + c * P[7], a * P[2] + b * P[5] + c * P[8]
        uy, vy, f = d * P[0] + e * P[3] + f * P[6], d * P[1] + e * P[4] + f * P[7], d * P[2] + e * P[5] + f * P[8]
        uz, vz, i = g * P[0] + h * P[3] + i * P[6], g * P[1] + h * P[4] + i * P[7], g * P[2] + h * P[5] + i * P[8]
        axes[s, 0], axes[s, 1], axes[s, 2] = c, f, i
        origins[s, 0], origins[s, 1], origins[s, 2] = px, py, pz
        value = P[SCALE] * x[wiring[s, COLUMN]] + P[SHIFT]
        if wiring[s, ROTATES] == 1:
            cos, sin = cos_sin(value)
            a, b = cos * ux + sin * vx, cos * vx - sin * ux
            d, e = cos * uy + sin * vy, cos * vy - sin * uy
            g, h = cos * uz + sin * vz, cos * vz - sin * uz
        else:
            a, b, d, e, g, h = ux, vx, uy, vy, uz, vz
            px, py, pz = px + value * c, py + value * f, pz + value * i
    P = tip
    pose[0], pose[1], pose[2] = (
        a * P[0] + b * P[3] + c * P[6],
        a * P[1] + b * P[4] + c * P[7],
        a * P[2] + b * P[5] + c * P[8],
    )
    pose[3], pose[4], pose[5] = (
        d * P[0] + e * P[3] + f * P[6],
        d * P[1] + e * P[4] + f * P[7],
        d * P[2] + e * P[5] + f * P[8],
    )
    pose[6], pose[7], pose[8] = (
        g * P[0] + h * P[3] + i * P[6],
        g * P[1] + h * P[4] + i * P[7],
        g * P[2] + h * P[5] + i * P[8],
    )
    pose[9] = px + a * P[9] + b * P[10] + c * P[11]
    pose[10] = py + d * P[9] + e * P[10] + f * P[11]
    pose[11] = pz + g * P[9] + h * P[10] + i * P[11]


@inline
def place_all(block: Floats, X: Floats, out: Floats, axes: Floats, origins: Floats) -> None:
    """``poses`` in room that was made for it."""
    joints, wiring, ends, tips = unpack(block).arm
    for k in range(X.shape[0]):
        for t in range(tips.shape[0]):
            forward(joints, wiring, ends[t], ends[t + 1], tips[t], IDENTITY, X[k], axes, origins, out[k, t])


@jit("void(f8[::1], f8[:,::1], f8[:,:,::1])")
def poses(block: Floats, X: Floats, out: Floats) -> None:
    """World poses (k, T, 12) of every tip for a population X (k, n)."""
    S = sizes_of(block)[0]
    place_all(block, X, out, np.empty((S, 3)), np.empty((S, 3)))
