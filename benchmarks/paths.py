"""Paths of poses: what they cost, thin walls between poses, tolerances, long paths, and places of a base.

    python benchmarks/paths.py [--walls 200] [--samples 2000] [--long 5000] [--out PAGE]

No path that says it is continuous may pass a wall: its steps are looked at again by Pinocchio and coal alone, at evenly
spaced configurations on the meshes as loaded.
"""

from __future__ import annotations

import argparse
import datetime
import platform
import time
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pinocchio as pin
from motions import Meshes
from numpy.typing import NDArray
from path_cases import among_balls, without_self_motions
from rich.progress import track

import pin_metaik as mik
from pin_metaik.collision import Box, Obstacle, load_scene

Floats = NDArray[np.float64]

DOWN, FORWARD = pin.rpy.rpyToMatrix(np.pi, 0.0, 0.2), pin.rpy.rpyToMatrix(0.0, np.pi / 2, 0.0)
REPEATS = 5
DEEP = {"panda": 0.6, "ur5": 0.5}  # m, how far into the shelf
TILT = np.deg2rad(5.0)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--walls", type=int, default=200)
    parser.add_argument("--samples", type=int, default=2000, help="of each step")
    parser.add_argument("--long", type=int, default=5000, help="poses of a long path")
    parser.add_argument("--out", type=Path, default=Path(__file__).with_suffix(".md"))
    options = parser.parse_args()
    page = [
        "# Paths",
        "",
        f"`python benchmarks/paths.py --walls {options.walls} --samples {options.samples} --long {options.long}`, "
        f"{datetime.date.today()}, 2-core {platform.machine()}, shared, Python {platform.python_version()}, pin "
        f"{version('pin')}, coal {version('coal')}. Times are of the processor, one thread, the least of {REPEATS} for "
        "short paths.",
        "",
        "| what | result |",
        "|---|---|",
    ]
    for line in (
        *short_paths(),
        *shelf_paths(),
        *long_paths(options.long),
        walls(options.walls, options.samples),
        torch(),
        balls(),
        *bases(),
    ):
        page.append(f"| {line[0]} | {line[1]} |")
        print(page[-1], flush=True)
    options.out.write_text("\n".join(page) + "\n", encoding="utf-8")


def line(count: int) -> list[pin.SE3]:
    return [pin.SE3(DOWN, np.array([0.35, y, 0.35])) for y in np.linspace(-0.3, 0.3, count)]


def circle(count: int, turns: int = 1) -> list[pin.SE3]:
    angles = np.linspace(0.0, 2.0 * np.pi * turns, count)
    return [pin.SE3(DOWN, np.array([0.45 + 0.12 * np.cos(a), 0.12 * np.sin(a), 0.4])) for a in angles]


def arm(name: str) -> tuple[mik.Robot, mik.Chain]:
    robot = mik.load_robot(name)
    return robot, mik.Chain(robot, robot.frame)


def said(path: mik.IKPath, seconds: float) -> str:
    met = f"{path.success.sum()} of {len(path.q)} poses met, {len(path.breaks)} breaks"
    return f"{met}, longest step {path.longest_step:.3f} rad, {seconds:.2f} s"


def best_of(repeats: int, *arguments, **named) -> tuple[mik.IKPath, float]:
    """The path, and the least processor time of several runs, s."""
    runs = [timed(mik.solve_ik_path, *arguments, **named) for _ in range(repeats)]
    return runs[-1][0], min(seconds for _, seconds in runs)


def timed(call, *arguments, **named):
    """What a call returns, and the processor time it took, s."""
    began = time.process_time()
    result = call(*arguments, **named)
    return result, time.process_time() - began


def short_paths():
    for name in ("panda", "ur5"):
        _, chain = arm(name)
        for kind, poses in (("line", line(200)), ("circle", circle(200))):
            path, seconds = best_of(REPEATS, chain, poses, max_step=0.1)
            yield f"{name}, {kind} of 200 poses, no world", said(path, seconds)


def shelf_paths():
    """Into the shelf, above its middle board."""
    for name in ("panda", "ur5"):
        robot, chain = arm(name)
        world = mik.CollisionWorld(robot, load_scene("shelf"))
        poses = [pin.SE3(FORWARD, np.array([x, 0.2, 0.6])) for x in np.linspace(0.4, DEEP[name], 200)]
        path, seconds = best_of(REPEATS, chain, poses, max_step=0.1, world=world)
        yield f"{name}, 200 poses into the shelf, clear between them", said(path, seconds)


def long_paths(count: int):
    for name in ("panda", "ur5"):
        robot, chain = arm(name)
        for scene in (None, "table"):
            world = None if scene is None else mik.CollisionWorld(robot, load_scene(scene))
            path, seconds = best_of(1, chain, circle(count, 5), max_step=0.1, world=world)
            place = "no world" if scene is None else f"the scene {scene!r}"
            yield f"{name}, five circles, {count:,} poses, {place}", said(path, seconds)


def walls(count: int, samples: int) -> tuple[str, str]:
    """Plates of 2 mm between the second and third of four poses 5 cm apart, in the way or up to 15 cm aside of it."""
    rng = np.random.default_rng(20_261_129)
    arms = [arm(name) for name in ("panda", "ur5")]
    continuous = passed = told = 0
    for k in track(range(count), "walls"):
        robot, chain = arms[k % 2]
        begin = np.array([0.4, 0.0, 0.35]) + rng.uniform(-0.12, 0.12, 3)
        along = rng.normal(size=3)
        along *= 0.05 / np.linalg.norm(along)
        turn = pin.Quaternion.FromTwoVectors(np.array([1.0, 0.0, 0.0]), along / 0.05).matrix()
        size = rng.uniform(0.02, 0.12)
        aside = turn @ np.array([0.0, *rng.uniform(-0.15, 0.15, 2)])
        plate = Obstacle("plate", Box((0.002, size, size)), pin.SE3(turn, begin + 1.5 * along + aside))
        world = mik.CollisionWorld(robot, [plate])
        poses = [pin.SE3(DOWN, begin + i * along) for i in range(4)]
        path = mik.solve_ik_path(chain, poses, max_step=0.5, world=world)
        if path:
            continuous += 1
            meshes = Meshes(world)
            steps = [world.first_contact(a, b) for a, b in zip(path.q, path.q[1:], strict=False)]
            passed += any(meshes.collide(step.at(t)) for step in steps for t in np.linspace(0.0, 1.0, samples))
        else:
            told += all(one.contact is not None or one.step or one.proof for one in path.reasons)
    return (
        f"{count} paths with a plate of 2 mm between two of four poses 5 cm apart",
        f"{continuous} continuous, of these {passed} collide anywhere between their poses; of the others {told} of "
        f"{count - continuous} say at every break what is in the way",
    )


def torch() -> tuple[str, str]:
    """Poses tilted at random by 4.6 degrees off ones that a joint path in narrow limits has."""
    rng, strict, loose = np.random.default_rng(3), 0, 0
    robot = mik.load_robot("ur5")
    model, frame = robot.model, robot.frame
    for _ in range(20):
        begin = np.array([0.2, -1.2, 1.4, -1.5, -1.3, 0.4]) + rng.uniform(-0.3, 0.3, 6)
        X = begin + np.linspace(0.0, 1.0, 60)[:, None] * rng.uniform(-0.3, 0.3, 6)
        chain = mik.Chain(robot, frame)
        window = dict(zip(chain.names, zip(X.min(axis=0), X.max(axis=0), strict=True), strict=True))
        narrow = mik.Chain(model, frame, limits=window)
        tilts = [0.08 * axis / np.linalg.norm(axis) for axis in rng.normal(size=(len(X), 3))]
        poses = [
            narrow.placements(narrow.q(x))[0] * pin.SE3(pin.exp3(tilt), np.zeros(3))
            for x, tilt in zip(X, tilts, strict=True)
        ]
        strict += bool(mik.solve_ik_path(narrow, poses, max_step=0.1))
        torch = [mik.Target(pose, orientation_tolerance=TILT) for pose in poses]
        loose += bool(mik.solve_ik_path(narrow, torch, max_step=0.1))
    return (
        "20 paths of 60 poses, each feasible within 5 degrees by construction, in limits as narrow as it needs",
        f"{strict} continuous with the poses as they are, {loose} with 5 degrees of tolerance",
    )


def balls() -> tuple[str, str]:
    """Panda among balls that leave little of the self-motions of its poses free."""
    robot, chain = arm("panda")
    descents = curves = 0
    seconds = []
    for seed in track(range(20), "balls"):
        world, poses, _ = among_balls(robot, chain, seed)
        descents += without_self_motions(chain, poses, world, 0.1)
        path, took = timed(mik.solve_ik_path, chain, poses, max_step=0.1, world=world)
        curves += bool(path)
        seconds.append(took)
    return (
        "panda, 20 paths of 4 poses among balls in the way of nearly all of their self-motions, each feasible by "
        "construction",
        f"{descents} continuous through solutions that descents lead to, {curves} with points of whole self-motions; "
        f"{np.median(seconds):.2f} s in the median, {max(seconds):.2f} s at most",
    )


def bases():
    """The best place for ten poses, and the best of 200 random ones in the same region by the same measure."""
    for name in ("panda", "ur5"):
        _, chain = arm(name)
        better, seconds, reached = 0, [], 0
        for seed in range(5):
            rng = np.random.default_rng(seed)
            middle = np.array([3.0, 2.0, 0.0])
            poses = [
                pin.SE3(
                    pin.rpy.rpyToMatrix(np.pi, 0.0, rng.uniform(-1.0, 1.0)),
                    middle + rng.uniform([-0.4, -0.4, 0.2], [0.4, 0.4, 0.6]),
                )
                for _ in range(10)
            ]
            place, took = timed(mik.place_base, chain, poses)
            around = mik.Box([1.6, 0.6, -np.pi], [4.4, 3.4, np.pi])
            random = mik.place_base(chain, poses, region=around, algorithm=Anywhere(), budget=mik.Budget(200), rng=seed)
            better += place.cost < random.cost
            reached += place.reached
            seconds.append(took)
        yield (
            f"{name}, a place for ten poses, five times",
            f"better than the best of 200 random places {better} of 5 times, {reached} of 50 poses reached, "
            f"{np.mean(seconds):.1f} s each",
        )


class Anywhere:
    """A search that draws places at random."""

    def search(self, run: mik.Search):
        while True:
            yield run.space.sample(run.rng, 50)


if __name__ == "__main__":
    began = time.perf_counter()
    main()
    print(f"{time.perf_counter() - began:.0f} s")
