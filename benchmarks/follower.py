"""Followers: limits over a million ticks, the same targets as pink's, what a tick costs, and collisions looked for.

    pip install -e '.[peers]'
    python benchmarks/follower.py [--ticks 1000000] [--world 20000] [--out PAGE]

Ten minutes. Times are processor time of one thread.
"""

from __future__ import annotations

import argparse
import datetime
import os
import platform
import time
import warnings
from collections.abc import Callable, Iterator
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
from rich.progress import track

import pin_metaik as mik
from pin_metaik import collision

warnings.filterwarnings("ignore", "invalid value encountered in sqrt", RuntimeWarning)  # pink's, beyond a limit
RATE = 500.0  # Hz
RUNS = 3  # of the ticks in a world, whose least times count: what else the machine does costs none of them
HARD = (15.0, 7.5, 10.0, 12.5, 15.0, 20.0, 20.0)  # rad/s^2, of panda's data sheet
HOME = np.array([0.0, -0.3, 0.0, -2.0, 0.0, 1.8, 0.7, 0.0])
SINGULAR = np.array([0.3, -1.4, 1.7, -1.9, 0.0, 0.4])  # ur5, wrist stretched

Poses = list[pin.SE3]
Tick = Callable[[pin.SE3, np.ndarray], np.ndarray]


def table(heading: list[str], rows: list[list[object]]) -> str:
    lines = [heading, ["---"] + ["---:"] * (len(heading) - 1), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines)


def arm(name: str) -> mik.Chain:
    robot = mik.load_robot(name)
    return mik.Chain(robot, "tool0" if name == "ur5" else robot.frame)


def limits_of(chain: mik.Chain) -> mik.MotionLimits:
    known = np.isfinite(chain.limits.velocity) & (chain.limits.velocity > 0.0)
    hard = HARD if chain.model.name == "panda" else None
    return mik.MotionLimits.of(chain, np.where(known, chain.limits.velocity, 2.0), hard)


# Limits ---------------------------------------------------------------------------------------------------------------


def any_target(chain: mik.Chain, rng: np.random.Generator) -> Any:
    """A reachable pose, one at the limits, one out of reach, a position, or a pose with a free axis."""
    box = chain.limits.box()
    kind = rng.integers(5)
    x = np.where(rng.random(chain.n) < 0.5, box.lower, box.upper) if kind == 1 else box.sample(rng, 1)[0]
    pose = chain.placements(chain.q(x))[0]
    if kind == 2:
        return pin.SE3(pose.rotation, 3.0 * pose.translation)
    if kind == 3:
        return pose.translation
    return mik.Target(pose, orientation_tolerance=(1e-5, 1e-5, np.inf)) if kind == 4 else pose


def exceeded(name: str, ticks: int) -> list[object]:
    """By how much a follower exceeds the limits at most: by the differences of the configurations it returns."""
    chain, rng = arm(name), np.random.default_rng(0)
    limits = limits_of(chain)
    follower = mik.Follower(chain, RATE, limits, posture=chain.reference)
    q = chain.q(chain.limits.box().sample(rng, 1)[0])
    x, target, left, status = [chain.x(q)], any_target(chain, rng), 0, dict.fromkeys(mik.FollowerStatus, 0)
    worst = np.full(3, -np.inf)
    v = np.zeros((1, chain.n))
    for i in track(range(ticks), name):
        if left == 0:
            target, left = any_target(chain, rng), int(rng.choice([1, 2, 20, 200, 400]))
        left -= 1
        step = follower.step(target, q)
        q = step.q
        status[step.status] += 1
        x.append(chain.x(q))
        if len(x) > 10_000 or i + 1 == ticks:
            rows = np.array(x)
            speeds = np.concatenate([v, chain.limits.way(rows[:-1], rows[1:]) * RATE])
            fast = np.abs(speeds).max(axis=0) - limits.velocity
            hard = np.abs(np.diff(speeds, axis=0)).max(axis=0) - limits.acceleration / RATE
            outside = np.maximum(rows - chain.limits.upper, chain.limits.lower - rows)
            worst = np.maximum(worst, [fast.max(), hard.max() * RATE, outside.max()])
            x, v = x[-1:], speeds[-1:]
    seen = ", ".join(f"{100 * n / ticks:.0f} % {one}" for one, n in status.items() if n)
    return [name, f"{ticks:,}", *(f"{one:.1e}" for one in worst), seen]


# The same targets as pink ---------------------------------------------------------------------------------------------


def moved(pose: pin.SE3, *by: float) -> pin.SE3:
    return pin.SE3(pose.rotation, pose.translation + by)


def circle(centre: pin.SE3, seconds: float, count: int, begin: float = 0.0) -> Poses:
    """On a circle of 0.1 m in the plane y, z, which takes so long once it has sped up for a second.

    It begins at a part of the turn from the lowest point.
    """
    t = np.arange(count) / RATE
    angles = 2.0 * np.pi * (begin + np.where(t < 1.0, 0.5 * t * t, t - 0.5) / seconds)
    return [moved(centre, 0.0, 0.1 * np.sin(a), -0.1 * np.cos(a)) for a in angles]


def hand(start: pin.SE3, count: int) -> Poses:
    """A hand that wanders, as a tracker at 90 Hz sees it with 0.3 mm of noise; interpolated between."""
    rng = np.random.default_rng(1)
    t = np.arange(0.0, count / RATE + 0.1, 1.0 / 90.0)
    waves = sum(
        rng.normal(size=(6, 1)) * (np.sin(f * t + (phase := rng.uniform(0, 6))) - np.sin(phase))
        for f in (0.5, 0.9, 1.7, 3.1)
    )
    waves *= np.array([0.05, 0.05, 0.05, 0.15, 0.15, 0.15])[:, None]
    waves[:3] += 0.0003 * rng.normal(size=(3, len(t)))
    now = np.arange(count) / RATE
    rows = np.array([np.interp(now, t, one) for one in waves]).T
    return [pin.SE3(start.rotation @ pin.exp3(row[3:]), start.translation + row[:3]) for row in rows - rows[0]]


def recorded() -> Iterator[tuple[str, mik.Chain, np.ndarray, Poses]]:
    """Targets, one a tick, and where to begin."""
    panda, ur5 = arm("panda"), arm("ur5")
    start = panda.placements(HOME)[0]
    yield "panda, a circle, 4 s a turn", panda, HOME, circle(moved(start, 0.0, 0.0, 0.1), 4.0, 4000)
    yield "panda, a hand", panda, HOME, hand(start, 5000)
    jumps = [moved(start, *by) for by in ((0.0, 0.3, 0.0), (-0.1, -0.3, 0.2), (0.0, 0.0, 0.0)) for _ in range(1000)]
    yield "panda, jumps by 0.3 to 0.6 m", panda, HOME, jumps
    out = [moved(start, min(0.6, 0.0004 * i), 0.0, 0.0) for i in range(2500)]
    yield "panda, out of reach and back", panda, HOME, [*out, *out[::-1]]
    singular = ur5.placements(SINGULAR)[0]
    for where, quarter in (("beside it", 0.25), ("in it", 0.0)):
        poses = circle(moved(singular, 0.0, 0.0, -0.1), 4.0, 4000, quarter)
        begin = mik.solve_ik(ur5, poses[0], np.add(SINGULAR, (0.0, 0.0, 0.0, 0.0, 0.3, 0.0))).q
        yield f"ur5, a circle through its wrist's singularity, begun {where}", ur5, begin, poses


def ours(chain: mik.Chain, limits: mik.MotionLimits) -> Tick:
    follower = mik.Follower(chain, RATE, limits)
    return lambda target, q: follower.step(target, q).q


def pinks(chain: mik.Chain, limits: mik.MotionLimits, accelerations: bool) -> Tick:
    """Pink with a frame task and its limits of configuration and speed, and of acceleration if it can."""
    import pink
    from pink.limits import AccelerationLimit, ConfigurationLimit, VelocityLimit

    model = pin.buildReducedModel(
        chain.model,
        [j for j in range(1, chain.model.njoints) if chain.model.names[j] not in chain.names],
        chain.reference,
    )
    model.upperVelocityLimit, model.lowerVelocityLimit = limits.velocity, -limits.velocity
    configuration = pink.Configuration(model, model.createData(), pin.neutral(model))
    bounds: list[Any] = [ConfigurationLimit(model), VelocityLimit(model)]
    acceleration = AccelerationLimit(model, limits.acceleration)
    if accelerations:
        bounds.append(acceleration)
    task = pink.FrameTask(chain.frames[0], position_cost=1.0, orientation_cost=1.0, lm_damping=1e-3)

    def tick(target: pin.SE3, q: np.ndarray) -> np.ndarray:
        configuration.update(chain.x(q))
        task.set_target(target)
        try:
            v = pink.solve_ik(configuration, [task], 1.0 / RATE, "daqp", limits=bounds, safety_break=False)
        except pink.exceptions.PinkError:  # it knows no speed that keeps its limits: it stands
            v = np.zeros(model.nv)
        acceleration.set_last_integration(v, 1.0 / RATE)
        return chain.q(pin.integrate(model, configuration.q, v / RATE), q)

    return tick


def follow(chain: mik.Chain, limits: mik.MotionLimits, begin: np.ndarray, poses: Poses, tick: Tick) -> list[object]:
    """Errors, speeds, accelerations and time a tick."""
    q, x, missed, spent = begin, [chain.x(begin)], [], []
    for pose in poses:
        began = time.thread_time()
        q = tick(pose, q)
        spent.append(time.thread_time() - began)
        x.append(chain.x(q))
        missed.append(np.linalg.norm(chain.placements(q)[0].translation - pose.translation))
    v = np.diff(np.array(x), axis=0) * RATE
    a = np.diff(np.concatenate([np.zeros((1, chain.n)), v]), axis=0) * RATE
    outside = max(float((x - chain.limits.upper).max()), float((chain.limits.lower - x).max()), 0.0)
    return [
        f"{1e3 * np.median(missed):.3g}",
        f"{1e3 * np.quantile(missed, 0.95):.3g}",
        f"{1e3 * max(missed):.3g}",
        f"{(np.abs(v) / limits.velocity).max():.3f}",
        f"{(np.abs(a) / limits.acceleration).max():.3f}",
        f"{outside:.1e}",
        f"{1e6 * np.median(spent):.0f}",
    ]


def compared() -> str:
    rows: list[list[object]] = []
    for name, chain, begin, poses in recorded():
        limits = limits_of(chain)
        for who, tick in (
            ("Follower", ours(chain, limits)),
            ("pink", pinks(chain, limits, accelerations=False)),
            ("pink, accelerations limited", pinks(chain, limits, accelerations=True)),
        ):
            rows.append([name, who, *follow(chain, limits, begin, poses, tick)])
            print(rows[-1], flush=True)
    heading = ["targets", "who", "error, median, mm", "95 %", "largest", "speed / limit", "acceleration / limit"]
    return table([*heading, "outside, rad", "us a tick"], rows)


# Worlds ---------------------------------------------------------------------------------------------------------------


def among(chain: mik.Chain, world: mik.CollisionWorld, ticks: int) -> Iterator[tuple[np.ndarray, Any, float]]:
    """Where each tick towards random targets begins, what it comes to, and its processor time, s."""
    follower, rng = mik.Follower(chain, RATE, limits_of(chain), world), np.random.default_rng(0)
    q = next(q for q in chain.q(chain.box.sample(rng, 1000)) if world.min_distance(q).distance > 0.02)
    for i in range(ticks):
        if i % 300 == 0:
            target = chain.placements(chain.q(chain.box.sample(rng, 1)[0]))[0]
        began = time.thread_time()
        step = follower.step(target, q)
        yield q, step, time.thread_time() - began
        q = step.q


def in_a_world(scene: str, ticks: int) -> list[object]:
    """Random targets among obstacles: collisions in a dense check, distances, and what ticks cost."""
    robot = mik.load_robot("panda")
    chain = mik.Chain(robot, robot.frame)
    world = mik.CollisionWorld(robot, collision.load_scene(scene))
    runs = [[spent for *_, spent in among(chain, world, ticks)] for _ in range(RUNS)]  # the same ticks, to the last bit
    collided, nearest, held = 0, np.inf, 0
    for i, (q, step, _) in enumerate(track(among(chain, world, ticks), scene, ticks)):
        between = chain.x(q) + np.linspace(0.2, 1.0, 5)[:, None] * step.v / RATE
        collided += int(world.in_collision_batch(chain.q(between, q), workers=1).sum())
        held += step.status is mik.FollowerStatus.NEAR_COLLISION
        if i % 10 == 0:
            nearest = min(nearest, world.min_distance(step.q).distance)
    us = 1e6 * np.min(runs, axis=0)
    counts = [f"{ticks:,}", f"{collided} of {5 * ticks:,}", f"{1e3 * nearest:.1f}", f"{100 * held / ticks:.0f} %"]
    return [scene, *counts, f"{np.median(us):.0f}", f"{np.quantile(us, 0.9):.0f}", f"{np.quantile(us, 0.99):.0f}"]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--ticks", type=int, default=1_000_000, help="of random targets")
    parser.add_argument("--world", type=int, default=20_000, help="ticks in each world")
    parser.add_argument("--out", type=Path, default=Path(__file__).with_suffix(".md"))
    options = parser.parse_args()
    versions = ", ".join(f"{name} {version(name)}" for name in ("pin-pink", "daqp", "numba"))
    shares = {"panda": 0.4, "ur5": 0.3, "kinova": 0.3}
    page = [
        "# Followers",
        "",
        f"`python benchmarks/follower.py --ticks {options.ticks} --world {options.world}`, {datetime.date.today()}, "
        f"{os.cpu_count()}-core {platform.machine()}, shared; {versions}. {RATE:g} ticks a second; times are processor "
        "time of one thread.",
        "",
        "## The same targets as pink",
        "",
        "In every tick both are given their configuration and a target. Pink has a frame task and "
        "limits of configuration and speed, in the second row of each also of acceleration; where it finds no speed "
        "within them it does not move. "
        "Errors are the tip's distance from the target of the tick, by Pinocchio; for jumps and "
        "targets out of reach they are mostly unavoidable. *outside*: beyond a joint's limit.",
        "",
        compared(),
        "",
        "## Among obstacles",
        "",
        "Panda, a random target every 300 ticks, reachable or not. Five configurations of every tick are checked on "
        "the original geometry. *held*: ticks in which nearby bodies slow the arm down or stop it. "
        f"Times of a tick are the least of {RUNS} runs of the same ticks.",
        "",
        table(
            ["scene", "ticks", "collisions", "nearest, mm", "held", "us a tick, median", "90 %", "99 %"],
            [in_a_world(scene, options.world) for scene in ("shelf", "table", "narrow_box")],
        ),
        "",
        "## Limits",
        "",
        "Targets that stay for 1 to 400 ticks: reachable poses, poses at the limits of all joints, poses out of reach, "
        "positions, a free axis. By how much limits are exceeded at most, from differences of configurations alone: "
        "below 0 a limit was never reached, 1e-12 is rounding.",
        "",
        table(
            ["arm", "ticks", "speed, rad/s", "acceleration, rad/s^2", "position, rad", "ticks by status"],
            [exceeded(name, int(share * options.ticks)) for name, share in shares.items()],
        ),
    ]
    options.out.write_text("\n".join(page) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
