"""All solutions of six joints, and all self-motions of seven: what is missed, what is wrong, and how long it takes.

    python benchmarks/ik_complete.py [six peers seven] [--arms ur5 ...] [--random 500] [--descents 5000] ...

Writes the sections named, default all, into the page, and leaves the others as they are; each says by which command it
was measured, when and on what machine. The truth is the union of all solvers and of random descents, each judged by
Pinocchio. Peers are installed by ``pip install '.[branches]'``; one that is not installed, or needs minutes to derive
an arm's equations, is left out of that arm's row.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial
from itertools import repeat
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import pinocchio as pin
from sections import conditions, page_with
from six_joint_peers import PREBUILT, Floats, Solve, all_peers, quick_peers

import pin_metaik as mik
from pin_metaik.dexterity import singular_values
from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.refine import DLS

Measure: TypeAlias = Callable[[str, argparse.Namespace], str]  # the row of an arm

EXACT, ROUGH = 1e-9, 1e-5  # m and rad
ON_CURVE = 1e-6  # least singular value of the Jacobian below which a solution is one of a curve
APART = 1e-2  # rad or m: solutions that differ by less in every joint are one
OFF = 1e-3  # m and rad, of a calibrated arm
NEAR = 1e-4  # rad or m, from a singularity
CALLS = 5  # of each solver for a pose, of which the quickest counts ...
LONG = 5e-3  # s: ... but one that took longer is the only one
MOST = 512  # solutions of one target
SIX = ["ur5", "puma560", "rv7fl", "z1", "kinova", "aerial_arm", "bravo7_no_ee", "alexander"]
SIX += ["ur5 calibrated", "puma560 calibrated", *PREBUILT]
SEVEN = ["panda", "xarm7", "iiwa14", "pr2 arm"]


def chain_of(name: str) -> mik.Chain:
    """An arm by its name, perhaps one whose joints are 1 mm and 1 mrad off their places."""
    if name in [*PREBUILT, "iiwa14"]:
        return chain_from_peer(name)
    name, _, more = name.partition(" ")
    robot = mik.load_robot(name)
    if more == "arm":
        return mik.Chain(robot.model, robot.frame, locked=["torso_lift_joint"])
    model = robot.model.copy()
    if more == "calibrated":
        rng = np.random.default_rng(1)
        for j in range(1, model.njoints):
            twist = OFF * rng.uniform(-1.0, 1.0, 6)
            model.jointPlacements[j] = model.jointPlacements[j] * pin.exp6(pin.Motion(twist))
    return mik.Chain(model, robot.frame)


def chain_from_peer(name: str) -> mik.Chain:
    """An arm by the numbers that come with ssik: each joint's placement, axis and limits."""
    import ssik

    arm = next(arm for arm in ssik.list_arms() if arm.import_path.endswith(f"{name}_ik"))
    body = ssik.Manipulator.from_prebuilt(arm.name).kinbody
    model, parent, placement = pin.Model(), 0, pin.SE3.Identity()
    for joint in body.joints:
        placement = placement * pin.SE3(joint.T_left)
        kind = pin.JointModelRevoluteUnaligned(np.array(joint.axis))
        lower, upper = (np.array([limit]) for limit in joint.limits or (-np.pi, np.pi))
        parent = model.addJoint(parent, kind, placement, joint.name, np.ones(1), np.ones(1), lower, upper)
        placement = pin.SE3(joint.T_right)
    model.addFrame(pin.Frame("tip", parent, 0, placement, pin.FrameType.OP_FRAME))
    return mik.Chain(model, "tip")


def singular(chain: mik.Chain, rng: np.random.Generator) -> Floats:
    """Coordinates (6,) near where the determinant of the Jacobian changes its sign."""

    def sign(x: Floats) -> float:
        q = chain.q(x)
        J = pin.computeFrameJacobian(chain.model, chain.data, q, chain.frame_ids[0])
        return float(np.linalg.det(J[:, [chain.model.joints[int(j)].idx_v for j in chain.coordinates.joints]]))

    while True:
        a, b = chain.box.sample(rng, 2)
        if sign(a) * sign(b) < 0.0:
            break
    for _ in range(50):
        middle = 0.5 * (a + b)
        a, b = (middle, b) if sign(middle) * sign(a) > 0.0 else (a, middle)
    return chain.limits.clip(a + NEAR * rng.uniform(-1.0, 1.0, chain.n))


@dataclass
class Count:
    """What became of one solver on one arm.

    Attributes:
        missed: Solutions of the union that it has not, by family of poses.
        wrong: Of its own that Pinocchio does not accept.
        times: s, of each random pose.
    """

    missed: dict[str, int] = field(default_factory=lambda: {"random": 0, "singular": 0})
    wrong: int = 0
    times: list[float] = field(default_factory=list)


def inside(chain: mik.Chain, X: Floats) -> Floats:
    """Those of the coordinates (s, n) that whole turns bring inside the limits, there."""
    turn = 2.0 * np.pi
    up = np.ceil((chain.box.lower - 1e-9 - X) / turn)
    X = np.where(chain.limits.rotates, X + turn * up, X)
    return X[((chain.box.lower - 1e-9 <= X) & (chain.box.upper + 1e-9 >= X)).all(axis=1)].reshape(-1, chain.n)


def away(chain: mik.Chain, X: Floats, known: Floats) -> Floats:
    """(s,) how far each of X (s, n) is from the nearest that is known (k, n), in its worst coordinate."""
    if not len(known):
        return np.full(len(X), np.inf)
    ways = np.abs(X[:, None] - known)
    ways = np.where(chain.limits.rotates, np.abs(ways - 2.0 * np.pi * np.round(ways / (2.0 * np.pi))), ways)
    return np.asarray(ways.max(axis=2).min(axis=1))


def descents(problem: IKProblem, rng: np.random.Generator, count: int) -> Floats:
    """Distinct solutions (s, n) that so many descents from random coordinates come to."""
    found = np.empty((MOST, problem.chain.n))
    starts = problem.box.sample(rng, count)
    _, known, _ = DLS().descent().gather(problem, starts, found, 0, APART, count, 10**9, branch=False)
    return found[:known]


def union(chain: mik.Chain, sets: list[Floats]) -> Floats:
    """Each solution of several sets once."""
    every = np.empty((0, chain.n))
    for x in np.concatenate(sets):
        if away(chain, x[None], every)[0] > APART:
            every = np.vstack([every, x])
    return every


def target(pose: Floats) -> mik.Target:
    return mik.Target(pin.SE3(pose), position_tolerance=EXACT, orientation_tolerance=EXACT)


def six(options: argparse.Namespace) -> Iterator[list[str]]:
    """All solutions of arms of six joints: the lines so far, after each arm."""
    lines = [
        f"{options.random} random and {options.singular} near-singular poses an arm (det J = 0, then each joint moved "
        f"by up to {NEAR:g}), to {EXACT:g} m and rad, inside the limits. *Solutions*: of the union of all solvers and "
        f"of {options.descents:,} random descents a pose, but for points of a curve (least singular value below "
        f"{ON_CURVE:g}); *missed*: of these, at random and near-singular poses, by `solve_ik_all` and by its peers "
        "where they take the arm; *wrong*: not accepted by Pinocchio. *Called complete*: share of the random poses, by "
        "what proves it; *contradicted*: such sets of which the union has more solutions. Times are medians over the "
        f"random poses of the quickest of {CALLS} calls, or of the only one where it took longer than {1e3 * LONG:g} "
        "ms, in processor time, which depends less on the load of the machine than the clock; the solvers take turns: "
        "without boxes (`certify=False`), and with.",
        "",
        "| arm | solutions | missed | wrong | called complete | contradicted | us | us with boxes | peers |",
        "|---|---:|---:|---:|---:|---:|---:|---:|---|",
    ]
    for row in rows(six_row, options.arms or SIX, options):
        lines.append(row)
        yield lines


def rows(measure: Measure, names: list[str], options: argparse.Namespace) -> Iterator[str]:
    """The row of each arm that is there, some measured at once in processes of their own."""
    with ProcessPoolExecutor(options.workers) as pool:
        yield from filter(None, pool.map(row_of, repeat(measure), names, repeat(options)))


def row_of(measure: Measure, name: str, options: argparse.Namespace) -> str:
    """The row of an arm; none, if a package that has it is missing."""
    try:
        return measure(name, options)
    except ImportError:
        return ""


def six_row(name: str, options: argparse.Namespace) -> str:
    """The row of one arm."""
    chain, rng = chain_of(name), np.random.default_rng(11)
    others = dict(quick_peers(chain, name))
    counts = {solver: Count() for solver in ["ours", "boxes", *others]}
    total, proofs, contradicted = {"random": 0, "singular": 0}, dict.fromkeys(mik.Proof, 0), 0
    places = {"random": chain.box.sample(rng, options.random)}
    places["singular"] = np.array([singular(chain, rng) for _ in range(options.singular)]).reshape(-1, chain.n)
    for warm in places["random"][:3]:
        mik.solve_ik_all(chain, chain.poses(warm)[0, 0])
    for family, X in places.items():
        for x in X:
            pose = chain.poses(x)[0, 0]
            goal, answers = target(pose), {}
            problem = IKProblem.of(chain, goal)

            def timed(solver: str, solve: Callable[[], Any], family: str = family) -> Any:
                return quickest(counts[solver], solve) if family == "random" else solve()

            quick = timed("ours", lambda goal=goal: mik.solve_ik_all(chain, goal, certify=False))
            proved = timed("boxes", lambda goal=goal: mik.solve_ik_all(chain, goal))
            answers["ours"], answers["boxes"] = quick.x, proved.x
            for solver, solve in others.items():
                answers[solver] = inside(chain, timed(solver, lambda solve=solve, pose=pose: solve(pose)))
            for solver, found in answers.items():
                answers[solver] = right(counts[solver], problem, found)
            every = union(chain, [*answers.values(), descents(problem, rng, options.descents), x[None]])
            every = every[[singular_values(problem.linearize(one)[1])[-1] > ON_CURVE for one in every]]
            total[family] += len(every)
            for solver, found in answers.items():
                counts[solver].missed[family] += int((away(chain, every, found) > APART).sum())
            if proved.complete is not None:
                proofs[proved.complete] += family == "random"
                contradicted += bool((away(chain, every, proved.x) > 2.0 * APART).any())
    ours, boxes = counts["ours"], counts["boxes"]
    shares = ", ".join(f"{count / options.random:.1%} {proof}" for proof, count in proofs.items() if count)
    theirs = "; ".join(
        f"{solver}: missed {of(counts[solver].missed)}, wrong {counts[solver].wrong}, {us(counts[solver])} us"
        for solver in others
    )
    return (
        f"| {name} | {of(total)} | {of(ours.missed)}, with boxes {of(boxes.missed)} | {ours.wrong + boxes.wrong} "
        f"| {shares or 'none'} | {contradicted} | {us(ours)} | {us(boxes)} | {theirs or 'none'} |"
    )


def quickest(count: Count, solve: Callable[[], Any]) -> Any:
    """What a solver finds, and the least time of a few calls, or of one that takes long."""
    took: list[float] = []
    while not took or (len(took) < CALLS and took[0] < LONG):
        began = time.thread_time()
        found = solve()
        took.append(time.thread_time() - began)
    count.times.append(min(took))
    return found


def right(count: Count, problem: IKProblem, found: Floats) -> Floats:
    """Of coordinates found (k, n), those that Pinocchio accepts; the others are counted."""
    chain = problem.chain
    good = np.array([problem.accepts(q) for q in chain.q(chain.limits.clip(found))], dtype=bool)
    count.wrong += int((~good).sum())
    accepted: Floats = found[good]
    return accepted


def side_by_side(options: argparse.Namespace) -> Iterator[list[str]]:
    """Ours and all peers on random poses of arms of six joints: the lines so far, after each arm."""
    lines = [
        f"{options.side} random poses an arm. *Solutions*: of the union of all solvers and of {options.few:,} random "
        f"descents, to {ROUGH:g} m and rad, inside the limits. *Missed*: of these; *wrong*: not accepted by Pinocchio, "
        f"to {ROUGH:g}. Times are medians, the quickest of {CALLS} calls a pose, or the only one where that took more "
        f"than {1e3 * LONG:g} ms, of the processor's time, solver by solver by turns. ik-geo by the family that the "
        "arm's axes are of; Robotics Toolbox by its elimination in Python, for arms without a closed form.",
        "",
        "| arm | solutions | solver | missed | wrong | us |",
        "|---|---:|---|---:|---:|---:|",
    ]
    for name in options.arms or SIX:
        with suppress(ImportError):
            lines += side_rows(name, options)
            yield lines


def side_rows(name: str, options: argparse.Namespace) -> list[str]:
    """The rows of one arm."""
    chain, rng = chain_of(name), np.random.default_rng(13)
    solvers: dict[str, Solve] = {"pin_metaik": lambda T: mik.solve_ik_all(chain, T).x, **dict(all_peers(chain, name))}
    counts, total = {solver: Count() for solver in solvers}, 0
    mik.solve_ik_all(chain, chain.poses(chain.box.sample(rng, 1))[0, 0])
    for x in chain.box.sample(rng, options.side):
        pose, answers = chain.poses(x)[0, 0], {}
        problem = IKProblem.of(chain, pose)
        for solver, solve in solvers.items():
            found = inside(chain, quickest(counts[solver], partial(solve, pose)))
            answers[solver] = right(counts[solver], problem, found)
        every = union(chain, [*answers.values(), descents(problem.exact, rng, options.few), x[None]])
        total += len(every)
        for solver, found in answers.items():
            counts[solver].missed["random"] += int((away(chain, every, found) > APART).sum())
    return [
        f"| {name} | {total} | {solver} | {count.missed['random']} | {count.wrong} | {us(count)} |"
        for solver, count in counts.items()
    ]


def of(counted: dict[str, int]) -> str:
    return f"{counted['random']:,} + {counted['singular']:,}"


def us(count: Count) -> str:
    return f"{1e6 * np.median(count.times):.0f}"


def seven(options: argparse.Namespace) -> Iterator[list[str]]:
    """All self-motions of arms of seven joints: the lines so far, after each arm."""
    lines = [
        f"{options.poses} random poses an arm, `self_motions` at a resolution of {options.resolution:g} rad. "
        f"*Proved*: share of the poses where boxes cover all solutions. *Off*: of the solutions that "
        f"{options.descents:,} random descents a pose come to, those farther than {APART:g} rad in some joint from "
        "all curves. *Nearest*: poses where the nearest point of all curves to a random configuration is no farther "
        "than the best of these solutions. *Select*: median of `solve_ik` with `select='nearest'`. Times are of the "
        "processor.",
        "",
        "| arm | curves a pose | closed | proved | by descents | off | nearest | ms, median | 90 % | select, ms |",
        "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|",
    ]
    for row in rows(seven_row, options.arms or SEVEN, options):
        lines.append(row)
        yield lines


def seven_row(name: str, options: argparse.Namespace) -> str:
    """The row of one arm."""
    chain, rng = chain_of(name), np.random.default_rng(12)
    times, chosen, curves, closed, proved, seen, off, nearest = [], [], 0, 0, 0, 0, 0, 0
    mik.self_motions(chain, chain.poses(chain.box.sample(rng, 1))[0, 0])
    solver = mik.IKSolver(select="nearest")
    for x in chain.box.sample(rng, options.poses):
        pose, q0 = chain.poses(x)[0, 0], chain.q(chain.box.sample(rng, 1)[0])
        began = time.thread_time()
        motions = mik.self_motions(chain, pose, q0, resolution=options.resolution)
        times.append(1e3 * (time.thread_time() - began))
        began = time.thread_time()
        mik.solve_ik(chain, pose, q0, solver=solver)
        chosen.append(1e3 * (time.thread_time() - began))
        curves, closed = curves + len(motions), closed + sum(curve.closed for curve in motions)
        proved += motions.complete is not None
        found = descents(IKProblem.of(chain, target(pose)), rng, options.descents)
        seen += len(found)
        points = [chain.x(curve.sample(0.5 * APART)) for curve in motions]
        off += int((away(chain, found, np.concatenate([np.empty((0, chain.n)), *points])) > APART).sum())
        x0 = chain.x(q0)
        best = np.linalg.norm(chain.limits.nearest_turns(found, x0) - x0, axis=1).min(initial=np.inf)
        nearest += motions.nearest(q0).value <= best + 1e-4
    count = options.poses
    return (
        f"| {name} | {curves / count:.1f} | {closed / count:.1f} | {proved / count:.1%} | {seen:,} | {off} "
        f"| {nearest} of {count} | {np.median(times):.0f} | {np.quantile(times, 0.9):.0f} | {np.median(chosen):.0f} |"
    )


SECTIONS: dict[str, tuple[str, Callable[[argparse.Namespace], Iterator[list[str]]]]] = {
    "six": ("Six joints", six),
    "peers": ("Six joints, solver by solver", side_by_side),
    "seven": ("Seven joints", seven),
}


def main() -> None:
    """Measure the sections named and write them into the page, one after the other."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sections", nargs="*", choices=[[], *SECTIONS], metavar="SECTION", help=", ".join(SECTIONS))
    parser.add_argument("--arms", nargs="*", help="default: all of the section")
    parser.add_argument("--random", type=int, default=500, help="poses of each arm of six joints")
    parser.add_argument("--singular", type=int, default=200, help="near-singular poses of each")
    parser.add_argument("--side", type=int, default=100, help="poses of each arm of six joints, for all peers")
    parser.add_argument("--few", type=int, default=500, help="descents of each of those")
    parser.add_argument("--poses", type=int, default=200, help="of each arm of seven joints")
    parser.add_argument("--descents", type=int, default=5_000, help="of each pose")
    parser.add_argument("--resolution", type=float, default=0.2, help="of self-motions, rad")
    parser.add_argument("--workers", type=int, default=1, help="arms measured at once; more than one add to the times")
    parser.add_argument("--out", type=Path, default=Path(__file__).with_suffix(".md"))
    options = parser.parse_args()
    for name in options.sections or SECTIONS:
        title, measure = SECTIONS[name]
        for lines in measure(options):
            print(lines[-1], flush=True)
            page = options.out.read_text(encoding="utf-8") if options.out.exists() else ""
            titles = [title for title, _ in SECTIONS.values()]
            lines = [conditions(("ssik", "eaik", "ik-geo", "roboticstoolbox-python")), "", *lines]
            options.out.write_text(page_with(page, "# All solutions", titles, title, lines), encoding="utf-8")


if __name__ == "__main__":
    main()
