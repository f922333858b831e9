"""Straight joint moves: whether those called free are, where those called touching touch, and what each costs.

    python benchmarks/motions.py [--moves 1000] [--samples 10000] [--robots panda ur5 talos_arm] [--out PAGE]

What is called free is looked at again, by Pinocchio and coal alone, at evenly spaced configurations on the meshes as
loaded, every pair that the world does not exempt; so is the part of a touching move that is called clear.
"""

from __future__ import annotations

import argparse
import datetime
import itertools
import platform
import time
from importlib.metadata import version
from pathlib import Path

import coal
import numpy as np
import pinocchio as pin
from collision_cases import bin_of, l_block, places
from collision_truth import Truth
from numpy.typing import NDArray
from rich.progress import track

import pin_metaik as mik
from pin_metaik.collision import Box, Capsule, Cone, Cylinder, Move, MoveStatus, Obstacle, Shape, Sphere, load_scene
from pin_metaik.collision.touch import random_configurations

Floats = NDArray[np.float64]

ROBOTS = ("panda", "ur5", "talos_arm")
OBSTACLES = 20
TOUCHING = 1e-6  # m; the distance at which the world's own check may already call two bodies touching
REPEATS = 200  # of each move whose cost is measured


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--moves", type=int, default=1000, help="of each robot")
    parser.add_argument("--samples", type=int, default=10_000, help="of each move")
    parser.add_argument("--robots", nargs="*", default=ROBOTS)
    parser.add_argument("--out", type=Path, default=Path(__file__).with_suffix(".md"))
    options = parser.parse_args()
    page = [
        "# Moves between configurations",
        "",
        f"`python benchmarks/motions.py --moves {options.moves} --samples {options.samples}`, {datetime.date.today()}, "
        f"2-core {platform.machine()}, shared, Python {platform.python_version()}, pin {version('pin')}, coal "
        f"{version('coal')}. Times are of the processor, through Python, one thread.",
        "",
        "## What a move costs",
        "",
        "Panda, `first_contact` and `clear_between` at the default resolution of 0.1 mm: median of "
        f"{REPEATS} calls, ms. *parts*: number of configurations checked.",
        "",
        "| move | answer | `first_contact`, ms | `clear_between`, ms | parts |",
        "|---|---|---:|---:|---:|",
        *[cost(*case) for case in cases()],
        "",
        "## Random moves among 20 obstacles",
        "",
        f"{options.moves:,} moves of each robot between random configurations that are free, among {OBSTACLES} boxes, "
        "balls, cylinders, cones, capsules, bins and concave blocks; obstacles are drawn anew every 100 moves. Of what "
        f"is called clear {options.samples:,} configurations a move are checked on the original meshes: *not free* "
        "counts moves with any that collides. *touching, but free*: the original meshes are more than a micrometre "
        "apart in the configuration that is said to touch. *open*: how far a body that touches moves between what is "
        "called clear and the collision, in the world, median and most. Median times.",
        "",
        "| robot | free | touching | undecided | not free | touching, but free | open, mm | free, ms | touching, ms | "
        "`clear_between` of free, of touching, ms |",
        "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|",
    ]
    for name in options.robots:
        page.append(among_obstacles(name, options.moves, options.samples))
        print(page[-1], flush=True)
    options.out.write_text("\n".join(page) + "\n", encoding="utf-8")


def cases() -> list[tuple[str, mik.CollisionWorld, Floats, Floats]]:
    """Moves of panda's base by 1 rad: alone, beside a shelf, and with its hand through a gap."""
    robot = mik.load_robot("panda")
    alone, shelf = mik.CollisionWorld(robot), mik.CollisionWorld(robot, load_scene("shelf"))
    chain = mik.Chain(robot, "panda_hand_tcp")
    ready = np.array([0.0, -0.25 * np.pi, 0.0, -0.75 * np.pi, 0.0, 0.5 * np.pi, 0.25 * np.pi, 0.02])
    left, right = ready.copy(), ready.copy()
    left[0], right[0] = -0.5, 0.5
    forward = pin.rpy.rpyToMatrix(0.0, np.pi / 2, 0.0)
    ends = [pin.SE3(forward, np.array([0.42, side, 0.42])) for side in (-0.2, 0.2)]
    reached = [mik.solve_ik(chain, end, ready, world=shelf).q for end in ends]
    hand = chain.placements(ready)[0]
    gap = mik.CollisionWorld(robot)
    blade = hand.translation + np.array([0.25, 0.0, 0.0])  # 30 cm long, 1 cm thick, level
    gap.attach("blade", Box((0.3, 0.04, 0.01)), "panda_hand_tcp", hand.inverse() * pin.SE3(np.eye(3), blade))
    for name, side in (("below", -1.0), ("above", 1.0)):
        middle = blade + np.array([0.1, 0.0, side * (0.01 + 0.01)])
        gap.add(Obstacle(name, Box((0.08, 0.3, 0.02)), middle))
    post = mik.CollisionWorld(robot, [Obstacle("post", Cylinder(0.03, 1.0), (0.29, 0.09, 0.5))])
    return [
        ("1 rad in free space", alone, left, right),
        ("along the front of the shelf, 0.4 m", shelf, *reached),
        ("1 rad, a blade of 1 cm held through a gap of 2 cm", gap, left, right),
        ("1 rad, into a post", post, left, right),
    ]


def cost(name: str, world: mik.CollisionWorld, q0: Floats, q1: Floats) -> str:
    """A row of the table."""
    move, parts = world.first_contact(q0, q1), looks(world, q0, q1)
    times = [timed(world.first_contact, q0, q1)[1] for _ in range(REPEATS)]
    clear = [timed(world.clear_between, q0, q1)[1] for _ in range(REPEATS)]
    return f"| {name} | {move} | {1e3 * np.median(times):.2f} | {1e3 * np.median(clear):.2f} | {parts} |"


def looks(world: mik.CollisionWorld, q0: Floats, q1: Floats) -> int:
    """How many configurations the search along a move places the robot at."""
    solids, count = world.checker.solids, 0
    place = type(solids).place

    def counted(self: object, q: Floats) -> object:
        nonlocal count
        count += 1
        return place(self, q)

    type(solids).place = counted
    try:
        world.first_contact(q0, q1)
    finally:
        type(solids).place = place
    return count


def timed(call, *arguments):
    """What a call returns, and its seconds."""
    began = time.process_time()
    result = call(*arguments)
    return result, time.process_time() - began


def obstacles(rng: np.random.Generator) -> list[Obstacle]:
    """Twenty obstacles 0.3 to 0.7 m from the arm's axis."""
    made: list[Shape] = [bin_of(0.2, 0.15, 0.1, 0.005), l_block(0.15)]
    made += [Box(tuple(rng.uniform(0.02, 0.15, 3))) for _ in range(6)]
    made += [Sphere(float(rng.uniform(0.02, 0.07))) for _ in range(3)]
    made += [Cylinder(*rng.uniform([0.01, 0.05], [0.05, 0.3]).tolist()) for _ in range(3)]
    made += [Capsule(*rng.uniform([0.01, 0.05], [0.05, 0.3]).tolist()) for _ in range(3)]
    made += [Cone(*rng.uniform([0.02, 0.05], [0.07, 0.2]).tolist()) for _ in range(3)]
    return [
        Obstacle(f"{k}", shape, pose) for k, (shape, pose) in enumerate(zip(made, places(rng, OBSTACLES), strict=True))
    ]


class Meshes:
    """Pinocchio's own check of the geometry as loaded, with the world's pairs and no other help."""

    def __init__(self, world: mik.CollisionWorld) -> None:
        self.model, self.data = world.model, world.model.createData()
        self.geometry = world.robot.collision_model.copy()
        count = self.geometry.ngeoms
        for one in world.obstacles:
            self.geometry.addGeometryObject(pin.GeometryObject(one.name, 0, 0, one.pose, one.shape.geometry()))
        self.geometry.removeAllCollisionPairs()
        things = list(self.geometry.geometryObjects)
        names = [world.model.frames[t.parentFrame].name if k < count else t.name for k, t in enumerate(things)]
        for i, j in itertools.combinations(range(len(things)), 2):
            pair = tuple(sorted((names[i], names[j])))
            if things[i].parentJoint != things[j].parentJoint and pair not in world.disabled:
                self.geometry.addCollisionPair(pin.CollisionPair(i, j))
        self.placed = self.geometry.createData()
        for request in self.placed.collisionRequests:
            request.gjk_initial_guess = coal.GJKInitialGuess.DefaultGuess

        tree = pin.BroadPhaseManager_DynamicAABBTreeCollisionManager
        self.manager = tree(self.model, self.geometry, self.placed)

    def collide(self, q: Floats) -> bool:
        return bool(pin.computeCollisions(self.model, self.data, self.manager, q, True))


def among_obstacles(name: str, count: int, samples: int) -> str:
    """A row of the table."""
    robot, rng = mik.load_robot(name), np.random.default_rng(20_261_129)
    moves: list[Move] = []
    seconds, clear_seconds, ways = [], [], []
    wrong = apart = 0
    for _ in track(range(0, count, 100), name):
        world = mik.CollisionWorld(robot, obstacles(rng))
        meshes, truth = Meshes(world), Truth.of(world)
        pairs = free_pairs(world, rng, min(100, count))
        world.first_contact(*pairs[0])  # machine code, requests and levels are made once
        for q0, q1 in pairs:
            move, took = timed(world.first_contact, q0, q1)
            clear, took_clear = timed(world.clear_between, q0, q1)
            assert clear == bool(move)
            moves.append(move)
            seconds.append(took)
            clear_seconds.append(took_clear)
            end = move.clear * (1.0 - 1e-12)
            wrong += any(meshes.collide(move.at(fraction)) for fraction in np.linspace(0.0, end, samples))
            if move.status is MoveStatus.TOUCHES:
                apart += truth.least(move.q) > TOUCHING
                ways.append(1e3 * undecided(world, move))
    status = np.array([move.status.value for move in moves])
    free, touching = (status == value for value in ("FREE", "TOUCHES"))
    times, clear_times = 1e3 * np.array(seconds), 1e3 * np.array(clear_seconds)
    return (
        f"| {name} | {free.sum()} | {touching.sum()} | {(status == 'UNDECIDED').sum()} | {wrong} | {apart} | "
        f"{np.median(ways):.3f}, {np.max(ways):.3f} | "
        f"{np.median(times[free]):.2f} | {np.median(times[touching]):.2f} | "
        f"{np.median(clear_times[free]):.2f}, {np.median(clear_times[touching]):.2f} |"
    )


def undecided(world: mik.CollisionWorld, move: Move) -> float:
    """How far (m) the farthest of the two bodies that touch moves in the part before that is not decided."""
    assert move.contact is not None
    data, places = world.model.createData(), []
    touching = [b for b in world.checker.solids.moving if b.link in move.contact[:2]]
    for fraction in (move.clear, move.touch):
        pin.forwardKinematics(world.model, data, move.at(fraction))
        corners = [
            b.solid.corners @ M.rotation.T + M.translation for b in touching for M in [data.oMi[b.joint] * b.placement]
        ]
        places.append(np.concatenate(corners))
    return float(np.linalg.norm(places[1] - places[0], axis=1).max())


def free_pairs(world: mik.CollisionWorld, rng: np.random.Generator, count: int) -> list[tuple[Floats, Floats]]:
    """Pairs of configurations that are free."""
    found: list[Floats] = []
    while len(found) < 2 * count:
        Q = random_configurations(world.model, rng, 4 * count)
        found += list(Q[~world.in_collision_batch(Q, workers=1)])
    return list(zip(found[:count], found[count : 2 * count], strict=True))


if __name__ == "__main__":
    main()
