"""Carry a cup upright: along a line, its axis within five degrees of the vertical, its handle anywhere. Draws it."""

import math
import sys
from pathlib import Path

import numpy as np
import pinocchio as pin
from matplotlib.figure import Figure

import pin_metaik as mik
from pin_metaik import goals

HAND = "panda_hand_tcp"
START, END = np.array([0.5, -0.4, 0.3]), np.array([0.4, 0.4, 0.6])  # m
TILT = math.radians(5)


def main() -> None:
    picture = Path(sys.argv[1] if len(sys.argv) > 1 else "cup_upright.png")
    chain = mik.Chain(mik.load_robot("panda"), HAND)
    upright = goals.Pointing(HAND, "x", "z", tolerance=TILT)  # the hand is level where its x axis is up
    places = np.linspace(START, END, 30)
    path = mik.solve_ik_path(chain, [[mik.Target.at(place), upright] for place in places], max_step=0.2)
    print(f"{len(places)} places, continuous: {path.continuous}, longest step of a joint {path.longest_step:.3f} rad")

    hands = [chain.placements(q)[0] for q in path.q]
    tilts = [math.degrees(math.acos(min(1.0, hand.rotation[2, 0]))) for hand in hands]
    off = max(np.linalg.norm(hand.translation - place) for hand, place in zip(hands, places, strict=True))
    print(f"the cup tilts by up to {max(tilts):.2f} degrees, and is at most {1e6 * off:.2f} um off its line")
    turns = [math.degrees(pin.rpy.matrixToRpy(hand.rotation)[0]) for hand in (hands[0], hands[-1])]
    print(f"nobody asked where the handle is: it turns from {turns[0]:.0f} to {turns[1]:.0f} degrees")

    figure = Figure(figsize=(12, 4.5), layout="constrained")
    for part, k in zip(figure.subfigures(1, 3), (0, len(places) // 2, -1), strict=True):
        mik.ik.draw_arm(part, chain, path.q[k], END)
        part.axes[0].plot(*places.T, color="#e69f00")
    figure.savefig(picture, dpi=110)
    print(f"drawn: {picture}")

    # The cone may be wide; a wish then keeps the cup as upright as the arm allows.
    low = [mik.Target.at([0.75, 0.0, 0.1]), goals.Pointing(HAND, "x", "z", tolerance=math.radians(40))]
    for asked in (low, [*low, goals.Wish(goals.Pointing(HAND, "x", "z"))]):
        result = mik.solve_ik(chain, asked)
        tilt = math.degrees(math.acos(min(1.0, chain.placements(result.q)[0].rotation[2, 0])))
        print(f"{len(asked)} goals and wishes: {result.status}, tilted by {tilt:.3g} degrees")


if __name__ == "__main__":
    main()
