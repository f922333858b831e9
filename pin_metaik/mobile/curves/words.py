"""The shortest curves of bounded curvature between two poses, by closed forms: forwards only, and with reversing.

Forwards only: Dubins, "On curves of minimal length with a constraint on average curvature", 1957. A shortest curve is
one of LSL, LSR, RSL, RSR, LRL and RLR. With reversing: Reeds and Shepp, "Optimal paths for a car that goes both
forwards and backwards", 1990, section 8; the formulas' numbers are theirs. Each formula is of one word; the others are
its mirror images in time (all is driven backwards), in space (left is right) and in order (from the goal to the start).

All is for radius 1 and a start at the origin along x. A formula yields signed lengths (3 to 5, n), NaN where its word
does not lead to the goal. Whatever it yields does lead there, so signs need no looking at: no curve is left out, and
the shortest of all is the shortest there is.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from pin_metaik.arrays import Array

Formula = Callable[[Array, Array, Array], tuple[Array, ...]]
Found = tuple[str, list[Array]]

QUARTER = np.pi / 2
ROUNDING = 1e-12  # of squares, sines and cosines
FULL = 1e-9  # rad; an arc that lacks as little to a full circle has none, but for rounding beside a short straight


def dubins_words(x: Array, y: Array, phi: Array) -> Iterator[Found]:
    """Words and lengths (3 of (n,)), none below zero, that lead to poses (n,) forwards."""
    for formula, word in ((_lsl_forwards, "LSL"), (_lsr_forwards, "LSR"), (_lrl_forwards, "LRL")):
        yield word, list(formula(x, y, phi))
        yield _mirrored(word), list(formula(x, -y, -phi))


def reeds_shepp_words(x: Array, y: Array, phi: Array) -> Iterator[Found]:
    """Words and signed lengths (3 to 5 of (n,)) that lead to poses (n,)."""
    xb, yb = x * np.cos(phi) + y * np.sin(phi), x * np.sin(phi) - y * np.cos(phi)
    for formula, word, reversible in FORMULAS:
        yield from _images(formula, word, x, y, phi)
        if reversible:
            for letters, lengths in _images(formula, word, xb, yb, phi):
                yield letters[::-1], lengths[::-1]


def _images(formula: Formula, word: str, x: Array, y: Array, phi: Array) -> Iterator[Found]:
    """A formula's word and its mirror images in time and space."""
    for backwards, mirrored in ((1, 1), (-1, 1), (1, -1), (-1, -1)):
        lengths = formula(backwards * x, mirrored * y, backwards * mirrored * phi)
        yield word if mirrored > 0 else _mirrored(word), [backwards * length for length in lengths]


def _mirrored(word: str) -> str:
    return word.translate(str.maketrans("LR", "RL"))


def _forward(angle: Array) -> Array:
    """An angle in [0, 2 pi); one below zero by rounding only is zero."""
    turned = np.mod(angle, 2 * np.pi)
    return np.where(turned > 2 * np.pi - FULL, 0.0, turned)


def _near(angle: Array) -> Array:
    """An angle in (-pi, pi]."""
    return np.asarray(np.pi - np.mod(np.pi - angle, 2 * np.pi))


def _real(square: Array) -> Array:
    """The square root of a number that is at most by rounding below zero; else NaN."""
    return np.sqrt(np.where(square > -ROUNDING, np.maximum(square, 0.0), np.nan))


def _within(share: Array) -> Array:
    """A number as a sine or cosine; NaN beyond 1."""
    return np.where(np.abs(share) <= 1 + ROUNDING, np.clip(share, -1, 1), np.nan)


# Dubins: d leads from the centre of the first arc to that of the last.


def _lsl_forwards(x: Array, y: Array, phi: Array) -> tuple[Array, ...]:
    d = x - np.sin(phi) + 1j * (y - 1 + np.cos(phi))
    psi = np.angle(d)
    return _forward(psi), np.abs(d), _forward(phi - psi)


def _lsr_forwards(x: Array, y: Array, phi: Array) -> tuple[Array, ...]:
    d = x + np.sin(phi) + 1j * (y - 1 - np.cos(phi))
    p = _real(np.abs(d) ** 2 - 4)
    psi = np.angle(d) + np.arctan2(2, p)
    return _forward(psi), p, _forward(psi - phi)


def _lrl_forwards(x: Array, y: Array, phi: Array) -> tuple[Array, ...]:
    d = x - np.sin(phi) + 1j * (y - 1 + np.cos(phi))
    p = 2 * np.pi - 2 * np.arcsin(_within(np.abs(d) / 4))
    theta = np.angle(d) + p / 2
    return _forward(theta), p, _forward(phi - theta + p)


# Reeds and Shepp.


def _to_left(x: Array, y: Array, phi: Array) -> tuple[Array, Array]:
    """From the centre of the first arc, to the left, to that of a last one to the left: length and direction."""
    d = x - np.sin(phi) + 1j * (y - 1 + np.cos(phi))
    return np.abs(d), np.angle(d)


def _to_right(x: Array, y: Array, phi: Array) -> tuple[Array, Array, Array]:
    """The same to a last arc to the right: the two coordinates and the length."""
    xi, eta = x + np.sin(phi), y - 1 - np.cos(phi)
    return xi, eta, np.hypot(xi, eta)


def _lsl(x: Array, y: Array, phi: Array) -> tuple[Array, ...]:
    """(8.1) C S C."""
    u, t = _to_left(x, y, phi)
    return t, u, _near(phi - t)


def _lsr(x: Array, y: Array, phi: Array) -> tuple[Array, ...]:
    """(8.2) C S C."""
    xi, eta, rho = _to_right(x, y, phi)
    u = _real(rho**2 - 4)
    t = _near(np.arctan2(eta, xi) + np.arctan2(2, u))
    return t, u, _near(t - phi)


def _lrl(x: Array, y: Array, phi: Array) -> tuple[Array, ...]:
    """(8.3) and (8.4) C|C|C and C|C C."""
    rho, theta = _to_left(x, y, phi)
    u = -2 * np.arcsin(_within(rho / 4))
    t = _near(theta + u / 2 + np.pi)
    return t, u, _near(phi - t + u)


def _ends(u: Array, v: Array, xi: Array, eta: Array, phi: Array) -> tuple[Array, Array]:
    """The first and last lengths of the words of four arcs."""
    delta = _near(u - v)
    a, b = np.sin(u) - np.sin(delta), np.cos(u) - np.cos(delta) - 1
    turned = 2 * (np.cos(delta) - np.cos(v) - np.cos(u)) + 3 < 0
    tau = _near(np.arctan2(eta * a - xi * b, xi * a + eta * b) + np.where(turned, np.pi, 0.0))
    return tau, _near(tau - u + v - phi)


def _lrlr(x: Array, y: Array, phi: Array) -> tuple[Array, ...]:
    """(8.7) C C|C C with equal inner arcs."""
    xi, eta, rho = _to_right(x, y, phi)
    u = np.arccos(_within((2 + rho) / 4))
    t, v = _ends(u, -u, xi, eta, phi)
    return t, u, -u, v


def _lrlr_cusps(x: Array, y: Array, phi: Array) -> tuple[Array, ...]:
    """(8.8) C|C C|C with equal inner arcs."""
    xi, eta, rho = _to_right(x, y, phi)
    share = (20 - rho**2) / 16
    u = -np.arccos(np.where(share > -ROUNDING, _within(share), np.nan))
    t, v = _ends(u, u, xi, eta, phi)
    return t, u, u, v


def _lrsl(x: Array, y: Array, phi: Array) -> tuple[Array, ...]:
    """(8.9) C|C(pi/2) S C."""
    rho, theta = _to_left(x, y, phi)
    r = _real(rho**2 - 4)
    t = _near(theta + np.arctan2(r, -2))
    return t, np.full_like(t, -QUARTER), 2 - r, _near(phi - QUARTER - t)


def _lrsr(x: Array, y: Array, phi: Array) -> tuple[Array, ...]:
    """(8.10) C|C(pi/2) S C."""
    xi, eta, rho = _to_right(x, y, phi)
    t = np.arctan2(xi, -eta)
    return t, np.full_like(t, -QUARTER), 2 - rho, _near(t + QUARTER - phi)


def _lrslr(x: Array, y: Array, phi: Array) -> tuple[Array, ...]:
    """(8.11) C|C(pi/2) S C(pi/2)|C."""
    xi, eta, rho = _to_right(x, y, phi)
    u = 4 - _real(rho**2 - 4)
    t = _near(np.arctan2((4 - u) * xi - 2 * eta, -2 * xi + (u - 4) * eta))
    quarter = np.full_like(t, -QUARTER)
    return t, quarter, u, quarter, _near(t - phi)


FORMULAS: tuple[tuple[Formula, str, bool], ...] = (  # and whether the word from goal to start is another one
    (_lsl, "LSL", False),
    (_lsr, "LSR", False),
    (_lrl, "LRL", True),
    (_lrlr, "LRLR", False),
    (_lrlr_cusps, "LRLR", False),
    (_lrsl, "LRSL", True),
    (_lrsr, "LRSR", True),
    (_lrslr, "LRSLR", False),
)
