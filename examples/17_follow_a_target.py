"""Teleoperation: a hand draws circles through a singularity of the wrist, and the arm follows within its limits."""

import sys
from pathlib import Path

import numpy as np
import pinocchio as pin
from matplotlib.figure import Figure

import pin_metaik as mik

RATE = 500.0  # ticks a second
TURN = 8.0  # s
SINGULAR = np.array([0.3, -1.4, 1.7, -1.9, 0.0, 0.4])  # wrist_2_joint at 0: two axes of the wrist are one line


def moved(pose: pin.SE3, *by: float) -> pin.SE3:
    return pin.SE3(pose.rotation, pose.translation + by)


def circle(singular: pin.SE3, t: float) -> pin.SE3:
    """A circle of 0.1 m from its lowest point, sped up for a second; lowest and highest point are singular."""
    angle = 2.0 * np.pi / TURN * (0.5 * t * t if t < 1.0 else t - 0.5)
    return moved(singular, 0.0, 0.1 * np.sin(angle), -0.1 - 0.1 * np.cos(angle))


def main() -> None:
    chain = mik.Chain(mik.load_robot("ur5"), "tool0")
    singular = chain.placements(SINGULAR)[0]
    q = mik.solve_ik(chain, circle(singular, 0.0), np.add(SINGULAR, (0.0, 0.0, 0.0, 0.0, 0.3, 0.0))).q

    follower = mik.Follower(chain, RATE, mik.MotionLimits.of(chain, acceleration=16.0))  # rad/s^2; speeds of the model
    times = np.arange(0.0, 2.0 * TURN, 1.0 / RATE)
    targets = [circle(singular, t) for t in times]
    steps = []
    for target in targets:
        steps.append(follower.step(target, q))  # one control tick
        q = steps[-1].q  # what goes to the arm

    missed = 1e3 * np.array([step.position_error for step in steps])
    v = np.array([step.v for step in steps])
    a = np.diff(v, axis=0) * RATE
    lost = np.array([step.status is mik.FollowerStatus.NO_DIRECTION for step in steps])
    later = times > 2.0
    wrist = np.array([step.q[4] for step in steps])
    crossed = int((np.diff(np.sign(wrist[later])) != 0).sum())
    print(f"begun in the singularity, the wrist across the way: missed by {missed.max():.1f} mm until it has turned")
    print(f"later it crosses the singularity {crossed} times, and misses by {missed[later].max():.6f} mm at most")
    print(f"fastest joint: {(np.abs(v) / follower.limits.velocity).max():.3f} of its limit of speed,")
    print(f"               {(np.abs(a) / follower.limits.acceleration).max():.3f} of its limit of acceleration")
    print(f"NO_DIRECTION in {lost.sum()} of {len(steps)} ticks; at the end: {steps[-1].status}")

    # A target that cannot be had: it says why, and whether there is another branch to go to.
    for _ in range(3000):
        step = follower.step(moved(singular, 0.8, 0.0, 0.0), q)
        q = step.q
    other = follower.switch(singular, q)
    print(f"\n0.8 m farther out: {step.status}, {step.position_error:.3f} m away, standing still")
    print("back by joints to", np.round(other, 2))
    while not (step := follower.move(other, q)):
        q = step.q

    figure = Figure(figsize=(11, 6), layout="constrained")
    path, error, speed = figure.subplot_mosaic([["path", "error"], ["path", "speed"]], width_ratios=[1, 1.6]).values()
    tip = np.array([chain.placements(step.q)[0].translation for step in steps])
    path.plot(*np.array([target.translation for target in targets]).T[1:], color="0.6", linewidth=4, label="target")
    path.plot(*tip.T[1:], color="#0072b2", linewidth=1, label="tip")
    path.plot(*singular.translation[1:], "o", color="#d55e00", label="singular, as the lowest point")
    path.set(aspect="equal", xlabel="y, m", ylabel="z, m", title="two turns, begun at the lowest point")
    path.legend(loc="center")
    error.plot(times, missed, color="#0072b2")
    error.fill_between(times, 0, missed.max(), where=lost, color="#d55e00", alpha=0.3, label="no direction")
    error.set(ylabel="error, mm")
    error.legend()
    for name, one, limit in zip(chain.names, v.T, follower.limits.velocity, strict=True):
        speed.plot(times, one / limit, label=name, linewidth=1)
    for end in (-1.0, 1.0):
        speed.axhline(end, color="black", linestyle=":", linewidth=0.8)
    speed.set(xlabel="time, s", ylabel="speed / limit")
    speed.legend(ncols=3, fontsize="small", loc="lower right")
    picture = Path(sys.argv[1] if len(sys.argv) > 1 else "follower.png")
    figure.savefig(picture, dpi=130)
    print(f"\ndrawn: {picture}")


if __name__ == "__main__":
    main()
