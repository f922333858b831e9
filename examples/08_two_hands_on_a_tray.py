"""Two hands on a tray: a frame's pose in the coordinates of another, and a centre of mass that stays over the feet.

Draws it.
"""

import math
import sys
from pathlib import Path

import numpy as np
import pinocchio as pin

import pin_metaik as mik
from pin_metaik import goals

LEFT, RIGHT = "gripper_left_base_link", "gripper_right_base_link"
WIDTH = 0.45  # m, of the tray, from hand to hand
FEET = [(-0.1, -0.15), (0.1, -0.15), (0.1, 0.15), (-0.1, 0.15)]  # m, corners around both soles


def main() -> None:
    picture = Path(sys.argv[1] if len(sys.argv) > 1 else "two_hands.png")
    chain = mik.Chain(mik.load_robot("talos"), [LEFT, RIGHT])
    print(f"{chain.n} joints move two hands")

    # The right hand is where the left one sees it: across the tray, and turned by half a turn, as hands are.
    across = pin.SE3(np.diag([-1.0, -1.0, 1.0]), np.array([0.0, -WIDTH, 0.0]))
    handle = np.array([0.4, 0.5 * WIDTH, 0.1])  # m: where the left hand holds the tray, to within two centimetres
    asked = [
        goals.FramePose(RIGHT, across, reference=LEFT),
        mik.Target.at(handle, frame=LEFT, tolerance=0.02),
        goals.Pointing(LEFT, "x", "z", tolerance=math.radians(3)),  # level
        goals.CentreOfMass(FEET, margin=0.02),
    ]
    result = mik.solve_ik(chain, asked)
    print(result)
    left, right = chain.placements(result.q)
    grasp = left.actInv(right)
    print(f"the hands are {np.linalg.norm(grasp.translation):.5f} m apart")
    print(f"their poses are off the grasp by {np.linalg.norm(pin.log6(across.actInv(grasp)).vector):.1e} m and rad")
    print(f"the tray tilts by {math.degrees(math.acos(min(1.0, left.rotation[2, 0]))):.2f} degrees")
    print(f"the centre of mass is at {goals.Placed(chain, result.q).centre_of_mass.round(3)} m")

    # The same with joints as near to where they stand as the tray allows.
    calm = mik.solve_ik(chain, [*asked, goals.Wish(goals.Posture(chain.reference))])
    away = goals.Posture(chain.reference).off(goals.Placed(chain, result.q))
    print(f"\n{calm.status}: joints are {calm.wishes[0].off['rad']:.3f} rad from where they stood,", end=" ")
    print(f"without the wish {away['rad']:.3f} rad")

    mik.ik.save_arm(picture, chain, calm.q, handle)
    print(f"drawn: {picture}")


if __name__ == "__main__":
    main()
