"""Vehicles: what wheels are asked for, what planning again costs, curves and sweeps against dense searches.

    pip install -e '.[mobile]'
    python benchmarks/mobile_vehicles.py --out benchmarks/mobile_vehicles.md

Five minutes; ``--quick`` takes one. Times are processor time of this process.
"""

from __future__ import annotations

import argparse
import datetime
import os
import platform
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import shapely

from pin_metaik import mobile
from pin_metaik.errors import InvalidSetting
from pin_metaik.mobile.curves.shortest import shortest_words

Row = list[object]

SHARES = (0.6, 0.8, 0.9, 0.95)  # of a wheel's speed, for driving on
BOTS = (mobile.TURTLEBOT3_BURGER, mobile.TURTLEBOT3_WAFFLE)
BENDS = {"L": 1, "S": 0, "R": -1}


def table(heading: list[str], rows: list[Row]) -> str:
    lines = [heading, ["---"] + ["---:"] * (len(heading) - 1), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines)


def paths(radius: float, count: int) -> Iterator[tuple[mobile.Scene, mobile.Path]]:
    """So many random scenes with a way for a robot, and their shortest paths."""
    seed, found = 0, 0
    while found < count:
        seed += 1
        try:
            scene = mobile.random_scene(10, seed - 1, gap=2 * radius + 0.5)
            path = mobile.PathProblem.of(scene, radius, 0.1).optimum
        except (InvalidSetting, mobile.NoPath, mobile.Blocked):  # no room for the obstacles, or no way
            continue
        found += 1
        yield scene, path


def asked(plan: mobile.TrajectoryPlan) -> tuple[float, float]:
    """Largest speed and acceleration of a wheel, integrated from the phases' accelerations by sums of one's own."""
    track = plan.route.vehicle.track
    wheels, speed, acceleration = np.zeros(2), 0.0, 0.0
    for phase in plan.trajectory.phases:
        a = phase.a + np.array([-1, 1]) * phase.alpha * track / 2
        for _ in range(20):
            wheels = wheels + a * phase.duration / 20
            speed = max(speed, np.abs(wheels).max())
        acceleration = max(acceleration, np.abs(a).max())
    return speed, acceleration


def differential(count: int) -> Iterator[str]:
    rows: list[Row] = []
    for bot in BOTS:
        beyond, ratios, stretched, collided = [], [], [], 0
        for scene, path in paths(bot.radius, count):
            plan = mobile.plan_trajectory(path, bot, scene.obstacles)
            collided += not plan.success
            speed, acceleration = asked(plan)
            beyond.append(max(speed - bot.wheel_speed, acceleration - bot.wheel_acceleration))
            scaled = [
                mobile.SynchroDrive(
                    "scaled", s * bot.v_max, bot.a_max, (1 - s) * bot.omega_max, bot.alpha_max, bot.radius
                )
                for s in SHARES
            ]
            ratios.append(min(mobile.plan_trajectory(path, each, scene.obstacles).time for each in scaled) / plan.time)
            both = mobile.SynchroDrive("both", bot.v_max, bot.a_max, bot.omega_max, bot.alpha_max, bot.radius)
            fast = mobile.plan_trajectory(path, both, scene.obstacles).trajectory.sample()
            slow = max(1.0, np.abs(bot.wheels(fast.v, fast.omega)).max() / bot.wheel_speed)
            stretched.append(slow * fast.t[-1] / plan.time)
        rows.append(
            [
                bot.name,
                count,
                collided,
                f"{max(beyond):.1e}",
                sum(ratio <= 1 for ratio in ratios),
                *(f"{value:.3f}" for value in (min(ratios), np.median(ratios), max(ratios))),
                f"{np.median(stretched):.3f}",
            ]
        )
    yield "## Differential drives\n"
    yield (
        "Random scenes; wheel speeds and accelerations integrated independently. Against the same robot with a fixed "
        "share of its wheels' speed for turning, the best of four shares for each scene, which is omega scaled down; "
        "and against both limits as if they were free, slowed down until the wheels keep up.\n"
    )
    heading = ["robot", "scenes", "no success", "largest excess", "not quicker"]
    yield table([*heading, "scaled down / ours, least", "median", "most", "slowed down / ours, median"], rows)


def again(count: int) -> Iterator[str]:
    rows: list[Row] = []
    for vehicle in (mobile.NOMAD_200, mobile.TURTLEBOT3_BURGER):
        seams, lost, spent, none = [0.0], [], [], 0
        for scene, path in paths(vehicle.radius, count):
            plan = mobile.plan_trajectory(path, vehicle, scene.obstacles)
            for t in plan.time * np.array([0.15, 0.4, 0.65, 0.9]):
                start = plan.trajectory.state(float(t))
                began = time.process_time()
                try:
                    new = mobile.replan(scene, vehicle, start=start, paths=1)
                except mobile.NoRoom:
                    none += 1
                    continue
                spent.append(1e3 * (time.process_time() - began))
                before, after = plan.trajectory.at(t), new.trajectory.at(0.0)
                seams += [
                    abs(float(getattr(before, key)[0] - getattr(after, key)[0]))
                    for key in ("x", "y", "heading", "v", "omega")
                ]
                lost.append(100 * ((t + new.time) / plan.time - 1))
                assert new.success and new.end_error < 1e-8
        rows.append(
            [
                vehicle.name,
                4 * count,
                none,
                f"{max(seams):.1e}",
                *(f"{value:.2f}" for value in (min(lost), np.median(lost), max(lost))),
                f"{np.median(spent):.0f}",
            ]
        )
    yield "\n\n## Planning again in motion\n"
    yield (
        "A plan stopped at four times and planned again from there in the same world, with one path: the largest jump "
        "of position, heading, speed or turning rate; by how much the whole takes longer, percent; ms to plan.\n"
    )
    heading = ["robot", "plans", "none found", "largest jump", "longer by, least", "median", "most", "ms, median"]
    yield table(heading, rows)


def drive(word: str, lengths: np.ndarray) -> np.ndarray:
    """Poses (n, 3) after a word with lengths (p, n), for radius 1, from the origin."""
    x, y, h = np.zeros((3, lengths.shape[1]))
    for letter, s in zip(word, lengths, strict=True):
        bend = BENDS[letter]
        if bend:
            x, y = x + (np.sin(h + bend * s) - np.sin(h)) / bend, y - (np.cos(h + bend * s) - np.cos(h)) / bend
        else:
            x, y = x + s * np.cos(h), y + s * np.sin(h)
        h = h + bend * s
    return np.column_stack((x, y, h))


def curves(words: int) -> Iterator[str]:
    rows: list[Row] = []
    for name, reverse in (("Dubins", False), ("Reeds and Shepp", True)):
        rng = np.random.default_rng(0)
        shorter, equal, worst, spent = 0, 0, 0.0, 0.0
        for _ in range(words):
            word = "".join(rng.choice(list("LSR"), size=rng.integers(2, 6)))
            lengths = rng.uniform(0, 1.6, (len(word), 5000))
            lengths *= rng.choice([-1, 1], size=(len(word), 1)) if reverse else 1
            goals, total = drive(word, lengths), np.abs(lengths).sum(axis=0)
            began = time.process_time()
            _, found = shortest_words(np.zeros((5000, 3)), goals, 1.0, reverse)
            spent += time.process_time() - began
            excess = np.abs(found).sum(axis=1) - total
            shorter += int((excess > 1e-9).sum())
            equal += int((np.abs(excess) <= 1e-9).sum())
            worst = max(worst, float(excess.max()))
        count = 5000 * words
        rows.append([name, f"{count:,}", shorter, f"{equal:,}", f"{worst:.1e}", f"{1e6 * spent / count:.1f}"])
    yield "\n\n## Shortest curves\n"
    yield (
        "Random drives of two to five arcs and straight lines: none may be shorter than the closed forms' shortest to "
        "where it ends, and many are it.\n"
    )
    heading = ["curves", "random drives", "shorter ones", "equal ones", "largest excess", "us a curve"]
    yield table(heading, rows)


def sweeps(count: int) -> Iterator[str]:
    rng = np.random.default_rng(0)
    met, missed, early, missing, spent = 0, 0, 0, 0, []
    for _ in range(count):
        start, goal = np.column_stack((rng.uniform(-2, 2, (2, 2)), rng.uniform(-np.pi, np.pi, 2)))
        curve = mobile.shortest_curve(tuple(start), tuple(goal), rng.uniform(0.2, 1), reverse=bool(rng.integers(2)))
        outline = mobile.Footprint.rectangle(rng.uniform(0.2, 1.2), rng.uniform(0.1, 0.8), rng.uniform(0, 0.2))
        posts = [shapely.Point(*rng.uniform(-3, 3, 2)).buffer(rng.uniform(0.001, 0.2), quad_segs=3) for _ in range(3)]
        began = time.process_time()
        contact = mobile.first_contact(curve, outline, posts)
        spent.append(1e3 * (time.process_time() - began))
        met += contact is not None
        s = np.linspace(0, curve.length, 4001)
        hit = s[shapely.distance(outline.at(curve.poses(s)), shapely.union_all(posts)) == 0]
        missed += contact is None and len(hit) > 0
        early += contact is not None and len(hit) > 0 and hit[0] < contact.s - 1e-5
        coarse = s[::200]
        unseen = shapely.distance(outline.at(curve.poses(coarse)), shapely.union_all(posts)).min() > 0
        missing += contact is not None and bool(unseen)
    yield "\n\n## Sweeps of rectangles\n"
    yield "Random curves past three posts; the first contact against 4,001 samples, and what 21 samples do not see.\n"
    heading = ["curves", "with a contact", "contacts missed", "found too late", "missed by 21 samples", "ms, median"]
    yield table(heading, [[count, met, missed, early, missing, f"{np.median(spent):.1f}"]])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, required=True, help="the page")
    parser.add_argument("--quick", action="store_true", help="a few runs of everything")
    options = parser.parse_args()
    few = options.quick
    parts = [
        "# Vehicles\n",
        f"`python benchmarks/mobile_vehicles.py --out {options.out}{' --quick' * few}`, {datetime.date.today()}, "
        f"{os.cpu_count()}-core {platform.machine()}, shared; shapely {shapely.__version__}.\n",
    ]
    for part in (
        differential(5 if few else 150),
        again(2 if few else 5),
        curves(20 if few else 200),
        sweeps(50 if few else 300),
    ):
        for text in part:
            print(text, flush=True)
            parts.append(text)
    options.out.write_text("\n".join(parts).replace("\n\n\n", "\n\n").rstrip() + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
