"""Look at a point: a list of goals is met together, and a wish uses the freedom that they leave. Draws it."""

import math
import sys
from pathlib import Path

import numpy as np

import pin_metaik as mik
from pin_metaik import goals

CAMERA, ELBOW = "panda_hand", "panda_link4"  # the camera is on the hand and looks along its z axis
POINT = np.array([0.6, 0.1, 0.2])  # m, in the world


def main() -> None:
    picture = Path(sys.argv[1] if len(sys.argv) > 1 else "look_at.png")
    chain = mik.Chain(mik.load_robot("panda"), CAMERA)
    asked = [
        goals.LookAt(CAMERA, POINT),
        goals.Distance(CAMERA, POINT, least=0.3, most=0.4),
        goals.OnPlane(ELBOW, (0.0, 0.0, 0.5), "z", most=math.inf),  # the elbow above half a metre
    ]
    result = mik.solve_ik(chain, asked)
    print(result)
    for outcome in result.goals:
        print(f"  {type(outcome.goal).__name__}: {'met' if outcome.met else 'missed'}")

    at = goals.Placed(chain, result.q)
    hand = at.pose(CAMERA)
    away = np.linalg.norm(POINT - hand.translation)
    beside = np.linalg.norm(np.cross(hand.rotation[:, 2], POINT - hand.translation))
    print(f"the camera is {away:.3f} m from the point, its ray passes the point at {1e6 * beside:.3f} um")
    print(f"the elbow is at {at.pose(ELBOW).translation[2]:.3f} m")

    # Of all configurations that do this, one whose joints are near the middle of their ranges.
    centred = goals.MidRange(0)
    with_wish = mik.solve_ik(chain, [*asked, goals.Wish(centred)])
    before, (after,) = centred.off(at), with_wish.wishes
    print(f"\noff the middle of the ranges: {before} without a wish, {after.off} with it")

    mik.ik.save_arm(picture, chain, with_wish.q, POINT)
    print(f"drawn: {picture}")

    # What cannot be met at once says which of the goals is missed, and by how much.
    apart = goals.Distance(CAMERA, POINT, least=2.0, most=2.5)
    few = mik.IKSolver(budget=mik.Budget(evaluations=2000))
    print("\nfrom two metres away:", mik.solve_ik(chain, [asked[0], apart], solver=few).why)


if __name__ == "__main__":
    main()
