"""The compiled loops under one roof. Importing it takes half a second: ``Chain`` does so when the first one is made."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

from pin_metaik.kinematics.kernel import (
    closed_form,
    forward,
    goals,
    multistart,
    pose_solver,
    singularities,
    warm_starts,
)

F = TypeVar("F", bound=Callable[..., Any])


class Kernels:
    """All that Python may call of them; see the functions themselves."""

    poses = staticmethod(forward.poses)
    costs = staticmethod(goals.costs)
    linearize = staticmethod(goals.linearize)
    gains_of = staticmethod(warm_starts.gains_of)
    nearest_samples = staticmethod(warm_starts.nearest_samples)
    descend = staticmethod(multistart.descend)
    descend_all = staticmethod(multistart.descend_all)
    all_branches = staticmethod(closed_form.all_branches)
    solve_directly = staticmethod(pose_solver.solve_directly)
    solve_pose = staticmethod(pose_solver.solve_pose)
    solve_poses = staticmethod(pose_solver.solve_poses)
    settle_pose = staticmethod(pose_solver.settle_pose)
    is_out_of_reach = staticmethod(pose_solver.is_out_of_reach)
    distances = staticmethod(pose_solver.distances)
    factors = staticmethod(singularities.factors)
    POSITION = pose_solver.POSITION

    @staticmethod
    def compiled(loop: F, without: bool = False) -> F:
        """The machine code behind a loop, for callers so frequent that one more frame counts."""
        return cast(F, loop.compiled(without))  # type: ignore[attr-defined]  # ``jit`` puts it there
