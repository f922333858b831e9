"""Talos stands: floating base, both feet on the ground, hands where they shall be, centre of mass over the feet.

    python benchmarks/whole_body.py [--count 500] [--pink 50]

Every problem is met by a configuration: an upper body and a base are drawn, the legs put onto the feet, and what does
not balance is drawn again. Answers are judged in Pinocchio alone. pink, where it is installed, solves the same with a
task a frame and one for the centre of mass, by steps of 5 ms until all errors are met, from the same start and from
random ones after 200 steps without. Writes ``whole_body.md``. Times are processor times of one call, one thread.
"""

from __future__ import annotations

import argparse
import logging
from collections.abc import Iterator
from pathlib import Path
from time import thread_time
from typing import NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray
from sections import conditions, page_with

import pin_metaik as mik

PAGE = Path(__file__).with_suffix(".md")
TITLE, SECTION = "# Whole bodies", "Talos stands and reaches with both hands"
FEET = "left_sole_link", "right_sole_link"
HANDS = "gripper_left_base_link", "gripper_right_base_link"
BASE = {
    "root_joint.x": (-0.3, 0.3),
    "root_joint.y": (-0.3, 0.3),
    "root_joint.z": (0.6, 1.1),
    "root_joint.yaw": (-0.5, 0.5),
    "root_joint.pitch": (-0.4, 0.4),
    "root_joint.roll": (-0.4, 0.4),
}
STANCE = [pin.SE3(np.eye(3), np.array([0.0, y, 0.0])) for y in (0.085, -0.085)]
SOLE = np.array([(x, y) for x in (-0.1, 0.1) for y in (-0.06, 0.06)])  # corners of a foot, m
MARGIN = 0.01  # m that the centre of mass keeps inside the feet's hull
TOLERANCE = 1e-5  # m and rad
LATE, STEPS, RESTARTS = 5e-3, 200, 20  # pink: s a step, steps a start, starts


class Stance(NamedTuple):
    """A problem that a configuration meets.

    Attributes:
        q: (nq,) that configuration.
        hands: Poses of both hands.
    """

    q: NDArray[np.float64]
    hands: list[pin.SE3]


def ground() -> NDArray[np.float64]:
    """(8, 2) corners of both feet, m."""
    return np.concatenate([foot.translation[:2] + SOLE for foot in STANCE])


def stances(whole: mik.Chain, balance: mik.goals.CentreOfMass) -> Iterator[Stance]:
    """Problems that can be met, for ever."""
    legs, rng = mik.Chain(whole.model, FEET, limits=BASE), np.random.default_rng(0)
    while True:
        standing = mik.solve_ik(legs, STANCE, whole.q(whole.box.sample(rng, 1)[0]))
        if standing.success and balance.met(mik.goals.Placed(whole, standing.q)):
            yield Stance(standing.q, whole.placements(standing.q)[2:])


def holds(model: pin.Model, q: NDArray[np.float64], hands: list[pin.SE3]) -> bool:
    """Whether q (nq,) stands, balances and reaches, by Pinocchio and the corners of the feet."""
    data = model.createData()
    pin.framesForwardKinematics(model, data, q)
    for name, pose in zip((*FEET, *HANDS), (*STANCE, *hands), strict=True):
        error = pose.actInv(data.oMf[model.getFrameId(name)])
        if np.linalg.norm(error.translation) > 1.001 * TOLERANCE or np.linalg.norm(pin.log3(error.rotation)) > (
            1.001 * TOLERANCE
        ):
            return False
    c = pin.centerOfMass(model, data, q)[:2]
    low, high = ground().min(axis=0) + 0.99 * MARGIN, ground().max(axis=0) - 0.99 * MARGIN  # the hull is a rectangle
    return bool(((low <= c) & (c <= high)).all())


def by_pink(model: pin.Model, start: NDArray[np.float64], stance: Stance, rng: np.random.Generator) -> bool:
    """Whether pink solves a problem: differential inverse kinematics until everything holds."""
    import pink
    from pink.tasks import ComTask, FrameTask

    frames = [FrameTask(name, position_cost=1.0, orientation_cost=1.0) for name in (*FEET, *HANDS)]
    for task, pose in zip(frames, (*STANCE, *stance.hands), strict=True):
        task.set_target(pose)
    com = ComTask(cost=np.array([0.1, 0.1, 0.0]))
    com.set_target(np.zeros(3))  # pink has no support polygon: the middle of the feet
    robot = pink.Configuration(model, model.createData(), start)
    lower, upper = model.lowerPositionLimit.copy(), model.upperPositionLimit.copy()
    for attempt in range(RESTARTS):
        if attempt:
            q = pin.neutral(model)
            q[7:] = rng.uniform(np.maximum(lower[7:], -3.0), np.minimum(upper[7:], 3.0))
            q[2] = start[2]
            robot = pink.Configuration(model, model.createData(), q)
        for _ in range(STEPS):
            velocity = pink.solve_ik(robot, [*frames, com], LATE, solver="daqp", safety_break=False)
            robot.integrate_inplace(velocity, LATE)
        if holds(model, robot.q, stance.hands):
            return True
    return False


def measured(count: int, beside: int) -> list[str]:
    """The table."""
    model = mik.load_robot("talos", free_flyer=True).model
    whole = mik.Chain(model, [*FEET, *HANDS], limits=BASE)
    balance = mik.goals.CentreOfMass(ground(), margin=MARGIN)
    drawn = stances(whole, balance)
    problems = [next(drawn) for _ in range(count)]
    assert all(holds(model, one.q, one.hands) for one in problems)
    times, spent, solved, right = [], [], 0, 0
    for one in problems:
        targets = [mik.Target(pose, frame) for pose, frame in zip((*STANCE, *one.hands), whole.frames, strict=True)]
        began = thread_time()
        result = mik.solve_ik(whole, [*targets, balance])
        times.append(thread_time() - began)
        spent.append(result.evaluations)
        solved += result.success
        right += result.success and holds(model, result.q, one.hands)
    rows = [_row("pin_metaik", count, solved, right, times[1:])]
    if beside:
        rng, start, times, met = np.random.default_rng(1), whole.q(whole.x(whole.reference)), [], 0
        for one in problems[:beside]:
            began = thread_time()
            met += by_pink(model, start.copy(), one, rng)
            times.append(thread_time() - began)
        rows.append(_row("pink", beside, met, met, times))
    return [
        f"{whole.n} coordinates: six of the base, twelve of the legs, two of the torso, fourteen of the arms. Poses of "
        f"feet and hands to {TOLERANCE:g} m and rad, the centre of mass {MARGIN:g} m inside the feet. *Verified* by "
        f"Pinocchio alone. Of ours, the median of the evaluations is {np.median(spent):.0f}.",
        "",
        "| solver | problems | solved | verified | median, ms | 99 %, ms |",
        "|---|---:|---:|---:|---:|---:|",
        *rows,
    ]


def _row(solver: str, count: int, solved: int, verified: int, times: list[float]) -> str:
    half, late = 1e3 * np.quantile(times, [0.5, 0.99])
    return f"| {solver} | {count} | {_percent(solved, count)} | {_percent(verified, count)} | {half:.2f} | {late:.1f} |"


def _percent(part: int, whole: int) -> str:
    return f"{100.0 * part / whole:.1f} %" if part < whole else "100 %"


def main() -> None:
    """Measure, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=500, help="problems")
    parser.add_argument("--pink", type=int, default=20, help="problems that pink gets, too; 0: it is not asked")
    parser.add_argument("--out", type=Path, default=PAGE, help="the page to write")
    options = parser.parse_args()
    logging.disable(logging.WARNING)  # pink's, of joints that are at a limit to rounding
    peers = ["pin-pink"] if options.pink else []
    lines = [conditions(peers), "", *measured(options.count, options.pink)]
    options.out.write_text(page_with(TITLE, TITLE, [SECTION], SECTION, lines), encoding="utf-8")


if __name__ == "__main__":
    main()
