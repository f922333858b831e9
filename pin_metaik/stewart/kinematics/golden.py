"""Golden-section search: the minimum of a unimodal function of one variable."""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt

RATIO = (sqrt(5.0) - 1.0) / 2.0
SECTIONS = 60  # each leaves 62 %: 60 leave 3e-13 of the interval, more than a minimum can be told apart


def golden_section(f: Callable[[float], float], low: float, high: float) -> float:
    """Where f is least between low and high (Kiefer 1953)."""
    inner = [high - RATIO * (high - low), low + RATIO * (high - low)]
    values = [f(x) for x in inner]
    for _ in range(SECTIONS):
        if values[0] <= values[1]:
            high = inner[1]
            inner, values = [high - RATIO * (high - low), inner[0]], [0.0, values[0]]
            values[0] = f(inner[0])
        else:
            low = inner[0]
            inner, values = [inner[1], low + RATIO * (high - low)], [values[1], 0.0]
            values[1] = f(inner[1])
    return inner[0] if values[0] <= values[1] else inner[1]
