"""When a complex root counts as a configuration, and when a descent is worth its while: for loops and arrays alike."""

from __future__ import annotations

REAL = 1e-7  # imaginary part that is rounding
NEARLY = 0.05  # imaginary part of what may be real where rounding, or a tolerance, makes two of one
BEYOND = 1e-3  # rad or m outside a limit, from where a descent may still end inside
UNBOUNDED = 2**62  # evaluations
FOR_ROOTS = 20_000  # evaluations: more than it takes to find all roots for one pose
