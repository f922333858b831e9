"""Collision checks and collision-free inverse kinematics: how quick, how safe, and what each means of finding brings.

    python benchmarks/collision.py [--configurations 1000] [--safety 10000] [--targets 200] [--out PAGE]

Robots are those of example-robot-data. What counts as a collision in the reference is Pinocchio's ``computeCollisions``
on the meshes as loaded, whatever our world says.
"""

from __future__ import annotations

import argparse
import datetime
import os
import platform
import time
from collections.abc import Callable
from functools import partial
from importlib.metadata import version
from itertools import product
from pathlib import Path

import numpy as np
import pinocchio as pin
from collision_searches import SEARCHES, Outcome
from numpy.typing import NDArray
from rich.progress import track

import pin_metaik as mik
from pin_metaik.collision import load_scene, scene_names
from pin_metaik.collision.touch import random_configurations

ROBOTS = ("panda", "ur5", "kinova", "xarm7")
LOOSE = {"position_tolerance": 1e-3, "orientation_tolerance": 1e-2}
# Where the tips of a scene's targets are, m: among the boxes, between the boards, inside the box.
REGIONS = {
    "table": ((0.25, -0.5, 0.0), (0.75, 0.5, 0.35)),
    "shelf": ((0.53, -0.37, 0.17), (0.78, 0.37, 0.73)),
    "narrow_box": ((0.38, -0.12, 0.02), (0.62, 0.12, 0.28)),
}
KINDS = ("pose", "position")
BUDGETS = (50, 200, 50_000)
READING = """
## Reading

- Plain rejection solves these scenes, too, given enough evaluations: a descent takes some ten microseconds, and of some
  dozens of random solutions one is free. Our search needs fewer evaluations, because it starts from the sample table
  and checks distinct solutions only, and because it pushes solutions out of collision where a target leaves freedom. In
  time the two are alike, as a push takes milliseconds.
- On their own, seeds take a hundred times as long as other solutions, because each of their evaluations calls coal.
  Here they find nothing more; they are tried last, for targets that neither random starts nor pushes solve.
- Maxima of several milliseconds are due to other work on the machine; evaluations are reproducible.
- A target that puts the gripper into an obstacle is reported after one solution; on a non-redundant arm the search ends
  when no new solution appears; on a redundant one that finds nothing it spends its budget: 50,000 evaluations, about a
  second on the Panda.
"""

Floats = NDArray[np.float64]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--configurations", type=int, default=1000, help="random q that checks are timed on")
    parser.add_argument("--safety", type=int, default=10_000, help="random q that answers are compared on")
    parser.add_argument("--targets", type=int, default=200)
    parser.add_argument("--robots", nargs="*", default=ROBOTS)
    parser.add_argument("--out", type=Path, default=Path(__file__).with_suffix(".md"))
    options = parser.parse_args()
    command = f"--configurations {options.configurations} --safety {options.safety} --targets {options.targets}"
    packages = ", ".join(f"{name} {version(name)}" for name in ("pin", "coal", "numpy", "daqp"))
    page = [
        "# Collisions",
        "",
        f"`python benchmarks/collision.py {command}`, {datetime.date.today()}, {os.cpu_count()}-core "
        f"{platform.machine()}, shared, Python {platform.python_version()}, {packages}. Times are by the clock, "
        "through Python, one thread.",
    ]
    for section in (checks, safety, alone, scenes, means):
        page += section(options)
        options.out.write_text("\n".join(page) + "\n" + READING, encoding="utf-8")


def checks(options: argparse.Namespace) -> list[str]:
    """How long one check takes."""
    lines = [
        "",
        "## Checking time",
        "",
        f"`world.in_collision(q)`, us over {options.configurations:,} random q: median (mean; 95th percentile). *all "
        "pairs*: Pinocchio on the meshes with every pair of links that moves, as one gets it without a world. The "
        "other columns check the pairs that the world leaves; their number is in the second column. *exact*: what "
        "simplified solids find is confirmed on the meshes, so that the answer is theirs; *alone*: it is not.",
        "",
        "| robot | pairs | all pairs, meshes | meshes | **convex, exact** | **capsule, exact** | convex alone "
        "| capsule alone |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for name in options.robots:
        robot = mik.load_robot(name)
        Q = random_configurations(robot.model, np.random.default_rng(1), options.configurations)
        every = reference(robot, {})
        cells = [spread([timed(every, q) for q in track(Q[: len(Q) // 10], f"{name}, all pairs", transient=True)])]
        for simplify, exact in (("none", True), *VARIANTS):
            world = mik.CollisionWorld(robot, simplify=simplify, exact=exact)
            world.in_collision(Q[0])
            cells.append(spread([timed(world.in_collision, q) for q in Q]))
        lines.append(f"| {name} | {len(world.checker.pairs)} | {' | '.join(cells)} |")
        print(lines[-1], flush=True)
    return lines


VARIANTS = (("convex", True), ("capsule", True), ("convex", False), ("capsule", False))


def safety(options: argparse.Namespace) -> list[str]:
    """How often a world says free where the meshes collide, and the other way round."""
    lines = [
        "",
        "## Safety",
        "",
        f"Over {options.safety:,} random q, against the meshes and all pairs but those that the SRDF, neighbourhood or "
        "construction exempts; pairs that the world leaves out because they never touch are in the reference. "
        "*unsafe*: called free, yet the meshes collide. *lost*: called a collision, yet the meshes are free.",
        "",
        "| robot | in collision | "
        + " | ".join(f"{s}, {'exact' if e else 'alone'}: unsafe, lost" for s, e in VARIANTS)
        + " |",
        "|---|---|---|---|---|---|",
    ]
    for name in options.robots:
        robot = mik.load_robot(name)
        Q = random_configurations(robot.model, np.random.default_rng(2), options.safety)
        worlds = [mik.CollisionWorld(robot, simplify=simplify, exact=exact) for simplify, exact in VARIANTS]
        collides = reference(robot, {p: r for p, r in worlds[0].disabled.items() if r != "Never"})
        truth = np.array([collides(q) for q in track(Q, f"{name}, meshes", transient=True)])
        cells = []
        for world in worlds:
            said = world.in_collision_batch(Q)
            cells.append(f"{(truth & ~said).sum()}, {(said & ~truth).sum()}")
        lines.append(f"| {name} | {100 * truth.mean():.1f} % | {' | '.join(cells)} |")
        print(lines[-1], flush=True)
    return lines


def alone(options: argparse.Namespace) -> list[str]:
    """Inverse kinematics free of self-collision."""
    lines = [
        "",
        "## Free of self-collision",
        "",
        f"{options.targets} poses of random configurations without self-collision, 1 mm and 0.01 rad; solved: "
        "Pinocchio and coal agree. *first free*: the share whose solution without a world happens to be free.",
        "",
        "| robot | first free | solved | p50 ms | p95 ms | max ms | evaluations |",
        "|---|---|---|---|---|---|---|",
    ]
    for name in (robot for robot in ("xarm7", "panda", "ur5") if robot in options.robots):
        robot = mik.load_robot(name)
        chain, world = mik.Chain(robot.model, robot.frame), mik.CollisionWorld(robot)
        X = chain.box.sample(np.random.default_rng(3), 4 * options.targets)
        free = [q for q in chain.q(X) if not world.in_collision(q)][: options.targets]
        targets = [mik.Target(chain.placements(q)[0], **LOOSE) for q in free]
        first = np.mean([not world.in_collision(mik.solve_ik(chain, target).q) for target in targets])
        found = solved(chain, world, targets, partial(SEARCHES["ours"], evaluations=50_000, seed=0))
        lines.append(f"| {name} | {100 * first:.0f} % | {summary(found)} |")
        print(lines[-1], flush=True)
    return lines


def scenes(options: argparse.Namespace) -> list[str]:
    """The scenes of the package, next to plain rejection."""
    lines = [
        "",
        "## Among obstacles",
        "",
        f"{options.targets} random configurations free of collisions, the tip among the obstacles; the target is the "
        "pose of the tip, or its position alone, to 1e-5 m and 1e-5 rad. *rejection*: the same descent from uniformly "
        "random starts until a solution is free, with the same budget of kernel evaluations. *first free*: the share "
        "whose solution without a world happens to be free. Then: solved within so many evaluations, and the rest at "
        "50,000.",
        "",
        "| scene | robot | target | first free | search | within 50 | within 200 | **within 50,000** | p50 ms | p95 ms "
        "| max ms | mean evaluations |",
        "|---|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    for scene in scene_names():
        for name in (robot for robot in ("panda", "ur5") if robot in options.robots):
            for kind in KINDS:
                chain, world, targets = problem(scene, name, kind, options.targets)
                first = np.mean([not world.in_collision(mik.solve_ik(chain, target).q) for target in targets])
                for search in ("ours", "rejection"):
                    shares = []
                    for budget in BUDGETS:
                        found = solved(chain, world, targets, partial(SEARCHES[search], evaluations=budget, seed=0))
                        shares.append(f"{100 * np.mean([outcome.success for outcome, _ in found]):.1f} %")
                    rest = summary(found).split(" | ", 1)[1]
                    what = f"{scene} | {name} | {kind} | {100 * first:.0f} %"
                    label = "**ours**" if search == "ours" else search
                    lines.append(f"| {what} | {label} | {' | '.join(shares)} | {rest} |")
                    print(lines[-1], flush=True)
    return lines


def means(options: argparse.Namespace) -> list[str]:
    """What each means of finding a free solution brings on its own."""
    lines = [
        "",
        "## Each method on its own",
        "",
        "The Panda's targets whose first solution collides, with each method on its own: free "
        "solutions found, evaluations "
        "and time spent a target. *others*: distinct solutions from the atlas and random starts, 500 evaluations at "
        "most. *push*: quadratic programs from the first solution. *seeds*: one round of MTDE on distance from the "
        "target plus depth, 1,000 evaluations, its elite refined and pushed. *rejection*: random starts, 500 "
        "evaluations at most.",
        "",
        "| scene | target | targets | method | found | evaluations | ms |",
        "|---|---|---|---|---|---|---|",
    ]
    for scene, kind in product(scene_names() if "panda" in options.robots else (), KINDS):
        chain, world, targets = problem(scene, "panda", kind, options.targets)
        hard = [target for target in targets if world.in_collision(mik.solve_ik(chain, target).q)]
        for search in ("others", "push", "seeds", "rejection") if hard else ():
            found = solved(chain, world, hard, partial(SEARCHES[search], evaluations=500, seed=0))
            share = np.mean([outcome.success for outcome, _ in found])
            spent = np.mean([outcome.evaluations for outcome, _ in found])
            ms = 1e3 * np.mean([seconds for _, seconds in found])
            lines.append(
                f"| {scene} | {kind} | {len(hard)} | {search} | {100 * share:.0f} % | {spent:.0f} | {ms:.2f} |"
            )
            print(lines[-1], flush=True)
    return lines


def problem(scene: str, name: str, kind: str, count: int) -> tuple[mik.Chain, mik.CollisionWorld, list[mik.Target]]:
    """A chain, a world, and targets that have a free solution by construction."""
    robot = mik.load_robot(name)
    chain = mik.Chain(robot.model, robot.frame)
    world = mik.CollisionWorld(robot, load_scene(scene))
    rng, (lower, upper) = np.random.default_rng(4), REGIONS[scene]
    poses: list[pin.SE3] = []
    while len(poses) < count:
        X = chain.box.sample(rng, 20_000)
        tips = chain.poses(X)[:, 0, :3, 3]
        inside = ((tips > lower) & (tips < upper)).all(axis=1)
        poses += [chain.placements(q)[0] for q in chain.q(X[inside]) if not world.in_collision(q)]
    make = mik.Target if kind == "pose" else lambda pose: mik.Target.at(pose.translation)
    return chain, world, [make(pose) for pose in poses[:count]]


def solved(
    chain: mik.Chain, world: mik.CollisionWorld, targets: list, run: Callable[..., Outcome]
) -> list[tuple[Outcome, float]]:
    """Outcome and seconds of each target, after one that warms up; a success is judged again."""
    run(chain, world, targets[0])
    found = []
    for target in track(targets, "solving", transient=True):
        began = time.perf_counter()
        outcome = run(chain, world, target)
        seconds = time.perf_counter() - began
        judged = outcome.success and mik.IKProblem.of(chain, target, world).accepts(outcome.q)
        found.append((outcome._replace(success=judged), seconds))
    return found


def summary(found: list[tuple[Outcome, float]]) -> str:
    ms = 1e3 * np.array([seconds for _, seconds in found])
    share = np.mean([outcome.success for outcome, _ in found])
    spent = np.mean([outcome.evaluations for outcome, _ in found])
    p50, p95 = np.quantile(ms, [0.5, 0.95])
    return f"{100 * share:.1f} % | {p50:.3f} | {p95:.2f} | {ms.max():.1f} | {spent:.0f}"


def reference(robot: mik.Robot, exempt: dict[tuple[str, str], str]) -> Callable[[Floats], bool]:
    """Pinocchio's own check of the meshes as loaded, over all pairs of links that move and are not exempt."""
    geometry, frames = robot.collision_model.clone(), robot.model.frames
    objects = list(geometry.geometryObjects)
    for j, b in enumerate(objects):
        for i, a in enumerate(objects[:j]):
            names = tuple(sorted((frames[a.parentFrame].name, frames[b.parentFrame].name)))
            if a.parentJoint != b.parentJoint and names not in exempt:
                geometry.addCollisionPair(pin.CollisionPair(i, j))
    data, shapes = robot.model.createData(), geometry.createData()
    return lambda q: bool(pin.computeCollisions(robot.model, data, geometry, shapes, q, len(exempt) > 0))


def timed(call: Callable[[Floats], object], q: Floats) -> float:
    began = time.perf_counter()
    call(q)
    return time.perf_counter() - began


def spread(seconds: list[float]) -> str:
    us = 1e6 * np.array(seconds)
    return f"{np.median(us):.1f} ({us.mean():.0f}; {np.quantile(us, 0.95):.0f})"


if __name__ == "__main__":
    main()
