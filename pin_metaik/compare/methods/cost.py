"""The cost of a kernel evaluation: the unit in which methods get the same budget.

An evaluation of forward kinematics counts 1. With the Jacobian that a descent needs it counts ``FK_WITH_JACOBIAN``, the
measured ratio of two compiled loops that differ in nothing else: 1.16 to 1.19 on eleven arms, by
``python benchmarks/kernel_costs.py`` (2026-11-25, 2-core x86-64, shared). It is a constant, not measured anew, so that
the same comparison has the same rows on any day. What else a method computes (a QP, a sort of its population) is not
counted; processor time shows it.
"""

from __future__ import annotations

FK_WITH_JACOBIAN = 1.2
TENTHS = round(10 * FK_WITH_JACOBIAN)  # whole numbers: no rounding decides how many steps a budget pays for


def steps_within(budget: int) -> int:
    """Evaluations with a Jacobian that a budget of kernel evaluations pays for."""
    return 10 * budget // TENTHS


def evaluations_of(steps: int) -> int:
    """Kernel evaluations that a number of evaluations with a Jacobian costs, rounded up."""
    return -(-TENTHS * steps // 10)
