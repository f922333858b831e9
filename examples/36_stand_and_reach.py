"""Stand and reach: a humanoid on a floating base, its feet fixed, reaches down without falling over. Draws it."""

import sys
from pathlib import Path

import numpy as np
import pinocchio as pin
from matplotlib.figure import Figure

import pin_metaik as mik
from pin_metaik import goals

FEET = "left_sole_link", "right_sole_link"
HAND = "gripper_left_base_link"
STANCE = [pin.SE3(np.eye(3), np.array([0.0, y, 0.0])) for y in (0.085, -0.085)]
SOLE = np.array([(x, y) for x in (-0.1, 0.1) for y in (-0.06, 0.06)])  # m, corners of a foot
BASE = {
    "x": (-0.3, 0.3),
    "y": (-0.3, 0.3),
    "z": (0.5, 1.1),
    "yaw": (-0.5, 0.5),
    "pitch": (-0.6, 0.6),
    "roll": (-0.3, 0.3),
}


def main() -> None:
    picture = Path(sys.argv[1] if len(sys.argv) > 1 else "stand_and_reach.png")
    robot = mik.load_robot("talos", free_flyer=True)
    limits = {f"root_joint.{name}": span for name, span in BASE.items()}
    chain = mik.Chain(robot, [*FEET, HAND], limits=limits)
    print(f"{chain.n} coordinates: six of the base, and the joints of both legs, the torso and an arm")

    ground = np.concatenate([foot.translation[:2] + SOLE for foot in STANCE])
    standing = [mik.Target(pose, foot) for foot, pose in zip(FEET, STANCE, strict=True)]
    balance = goals.CentreOfMass(ground, margin=0.02)
    calm = goals.Wish(goals.Posture(chain.reference))
    reached = []
    for place in ((0.45, 0.25, 1.1), (0.5, 0.2, 0.35)):
        asked = [*standing, balance, mik.Target.at(place, frame=HAND), calm]
        result = mik.solve_ik(chain, asked)
        c = goals.Placed(chain, result.q).centre_of_mass
        print(f"\nhand at {place} m: {result.status}")
        print(f"  pelvis at {result.q[2]:.2f} m, centre of mass at x {c[0]:.3f}, y {c[1]:.3f} m, over the feet")
        reached.append((place, result.q, c))

    # Without the goal of balance the body may hang over its toes: a statue that would fall.
    far = mik.Target.at((0.75, 0.2, 0.5), frame=HAND)
    careless, careful = mik.solve_ik(chain, [*standing, far]), mik.solve_ik(chain, [*standing, balance, far])
    falls = balance.off(goals.Placed(chain, careless.q))["m"]
    print(f"\nfarther out: {careful.status}; without the goal of balance its centre of mass were {falls:.3f} m outside")

    figure = Figure(figsize=(11, 6), layout="constrained")
    for part, (place, q, c) in zip(figure.subfigures(1, 2), reached, strict=True):
        mik.ik.draw_arm(part, chain, q, np.array(place))
        (ax,) = part.axes
        for corners in (ground[[0, 1, 3, 2, 0]], ground[[4, 5, 7, 6, 4]]):
            ax.plot(*corners.T, color="black", linewidth=1)
        ax.plot([c[0], c[0]], [c[1], c[1]], [0.0, c[2]], "--o", color="#e69f00", label="centre of mass")
        ax.legend(loc="upper left", fontsize="small")
        ax.view_init(elev=12, azim=-65)
    figure.savefig(picture, dpi=110)
    print(f"\ndrawn: {picture}")


if __name__ == "__main__":
    main()
