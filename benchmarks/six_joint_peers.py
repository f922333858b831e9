"""Other solvers of six turning joints, for benchmarks/ik_complete.py: all that each has for a pose, as coordinates.

ssik, EAIK, ik-geo and Robotics Toolbox come with ``pip install pin-metaik[branches]``; what is not installed is left
out.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from itertools import pairwise
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

import pin_metaik as mik
from pin_metaik.kinematics.paths import matrix_of

Floats = NDArray[np.float64]
Solve = Callable[[Floats], Floats]  # coordinates (s, 6) for a pose (4, 4)

PREBUILT = ["jaco2", "xarm6", "crx10ia"]  # arms whose numbers ssik has
FLAT = 1e-5  # of two axes, m or a sine: what counts as meeting or parallel
TRIED = 10  # poses of which a solver has to have the configuration that they come from, half of the time


def quick_peers(chain: mik.Chain, name: str) -> Iterator[tuple[str, Solve]]:
    """Solvers that are ready in milliseconds."""
    links = links_of(chain)
    with suppress(ImportError):
        import ssik

        if name in PREBUILT:
            arm = next(arm for arm in ssik.list_arms() if arm.import_path.endswith(f"{name}_ik"))
            theirs = ssik.Manipulator.from_prebuilt(arm.name)
        elif len(chain.form):  # of others it takes minutes to derive the equations
            box = np.stack([chain.box.lower, chain.box.upper], axis=1)
            theirs = ssik.Manipulator.from_transforms(links, limits=box)
        if name in PREBUILT or len(chain.form):
            yield "ssik", lambda T: rows([s.q for s in theirs.solve(T, enumerate_windings=False)])
    with suppress(ImportError):
        from eaik.IK_Homogeneous import HomogeneousRobot

        frames = np.array([np.linalg.multi_dot([np.eye(4), *links[: k + 1]]) for k in range(7)])
        robot = HomogeneousRobot(frames)
        if robot.hasKnownDecomposition():

            def eaik(T: Floats) -> Floats:
                found = robot.IK(T)
                return rows([x for x, rough in zip(found.Q, found.is_LS, strict=True) if not rough])

            yield "EAIK", eaik


def all_peers(chain: mik.Chain, name: str) -> Iterator[tuple[str, Solve]]:
    """Those, and solvers that search, or derive an arm's equations in half a minute."""
    yield from quick_peers(chain, name)
    with suppress(ImportError):
        yield from with_ik_geo(chain)
    if not len(chain.form):
        with suppress(ImportError):
            yield "Robotics Toolbox", with_robotics_toolbox(chain)


def with_ik_geo(chain: mik.Chain) -> Iterator[tuple[str, Solve]]:
    """ik-geo, by the family of the arm: its axes h and the ways p between points that neighbours share."""
    from ik_geo import Robot

    frames = frames_of(chain)
    h, points, tip = frames[:6, :3, 2], frames[:6, :3, 3].copy(), frames[6]
    meets = [meeting(*frames[i : i + 2]) for i in range(5)]
    parallel = [np.linalg.norm(np.cross(a, b)) < FLAT for a, b in pairwise(h)]
    wrist = meets[3] is not None and meets[4] is not None and np.linalg.norm(meets[3] - meets[4]) < FLAT
    if wrist:
        points[3:] = meets[3]
        family = "spherical_two_parallel" if parallel[1] else "spherical"
        if meets[0] is not None:
            family, points[:2] = "spherical_two_intersecting", meets[0]
    elif parallel[1] and parallel[2]:
        family = "three_parallel"
        if meets[4] is not None:
            family, points[4:] = "three_parallel_two_intersecting", meets[4]
    elif parallel[1]:
        family = "two_parallel"
    elif meets[4] is not None:
        family, points[4:] = "two_intersecting", meets[4]
    else:
        family = "gen_six_dof"
    p = np.diff(np.vstack([np.zeros(3), points, tip[:3, 3]]), axis=0)

    def solver(family: str) -> Solve:
        robot = getattr(Robot, family)(h, p)

        def solve(T: Floats) -> Floats:
            try:
                found = robot.get_ik(T[:3, :3] @ tip[:3, :3].T, T[:3, 3])
            except BaseException as error:
                if type(error).__name__ == "PanicException":  # as Rust says where its search finds no bracket
                    return np.empty((0, 6))
                raise
            return rows([q for q, rough in found if not rough])

        return solve

    if recovers(chain, solver(family)):
        yield f"ik-geo ({family})", solver(family)
    elif recovers(chain, solver("gen_six_dof")):
        yield "ik-geo (gen_six_dof)", solver("gen_six_dof")


def with_robotics_toolbox(chain: mik.Chain) -> Solve:
    """Robotics Toolbox's elimination for general arms, with the arm's Denavit and Hartenberg parameters."""
    import roboticstoolbox as rtb
    from roboticstoolbox.robot.symbolic_ik_rr import General6RIK

    table, offsets, base, tool = table_of(chain)
    robot = rtb.DHRobot([rtb.RevoluteDH(d=d, a=a, alpha=alpha) for d, a, alpha in table])
    theirs: Any = General6RIK(robot)
    before, after = np.linalg.inv(base), np.linalg.inv(tool)
    return lambda T: rows(theirs._solve_pose(before @ T @ after).q) - offsets


def table_of(chain: mik.Chain) -> tuple[Floats, Floats, Floats, Floats]:
    """(6, 3) d, a (m) and alpha (rad); (6,) theta (rad) at zero; and the frames (4, 4) before and behind them.

    Each x axis is along the common normal of two joints, from the first to the second, as by Denavit and Hartenberg.
    """
    frames = frames_of(chain)
    table, offsets, base = np.zeros((6, 3)), np.zeros(6), frames[0]
    here = base
    for k in range(6):
        z, o = here[:3, 2], here[:3, 3]
        z2, o2 = (frames[k + 1][:3, 2], frames[k + 1][:3, 3]) if k < 5 else (z, o)
        across = np.cross(z, z2)
        if np.linalg.norm(across) < FLAT:
            way = (o2 - o) - z * (z @ (o2 - o))
            size = np.linalg.norm(way)
            x, d, a = (way / size if size > FLAT else here[:3, 0]), 0.0, size
            alpha = 0.0 if z @ z2 > 0.0 else np.pi
        else:
            x, alpha = across / np.linalg.norm(across), float(np.arctan2(np.linalg.norm(across), z @ z2))
            d, _, a = np.linalg.solve(np.stack([z, -z2, x], axis=1), o2 - o)
        offsets[k] = np.arctan2(x @ here[:3, 1], x @ here[:3, 0])
        table[k] = d, a, alpha
        here = here @ (pin.SE3(pin.utils.rotate("z", offsets[k]), np.array([0.0, 0.0, d])).homogeneous)
        here = here @ (pin.SE3(pin.utils.rotate("x", alpha), np.array([a, 0.0, 0.0])).homogeneous)
    return table, offsets, base, np.linalg.inv(here) @ frames[6]


def links_of(chain: mik.Chain) -> Floats:
    """Links (7, 4, 4) before each joint, which turns about its z, and behind the last one."""
    return np.array([matrix_of(row) for row in [*chain.paths.joints, chain.paths.tips[0]]])


def frames_of(chain: mik.Chain) -> Floats:
    """Frames (7, 4, 4) of the joints and the tip, all joints being at zero."""
    return np.array([np.linalg.multi_dot([np.eye(4), np.eye(4), *links_of(chain)[: k + 1]]) for k in range(7)])


def meeting(a: Floats, b: Floats) -> Floats | None:
    """The point (3,) where the z axes of two frames meet, if they do."""
    across = np.cross(a[:3, 2], b[:3, 2])
    if np.linalg.norm(across) < FLAT or abs(across @ (b[:3, 3] - a[:3, 3])) > FLAT * np.linalg.norm(across):
        return None
    along = np.linalg.lstsq(np.stack([a[:3, 2], -b[:3, 2]], axis=1), b[:3, 3] - a[:3, 3], rcond=None)[0]
    return np.asarray(a[:3, 3] + along[0] * a[:3, 2])


def recovers(chain: mik.Chain, solve: Solve) -> bool:
    """Whether a solver has most configurations that poses come from: whether it is one for this arm."""
    met = 0
    for x in chain.box.sample(np.random.default_rng(0), TRIED):
        ways = np.abs((solve(chain.poses(x)[0, 0]) - x + np.pi) % (2.0 * np.pi) - np.pi)
        met += bool(len(ways) and ways.max(axis=1).min() < 1e-3)
    return met >= TRIED // 2


def rows(found: Any) -> Floats:
    """Coordinates (s, 6) of a list."""
    return np.array(found, dtype=float).reshape(-1, 6)
