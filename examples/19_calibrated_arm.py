"""A calibrated arm: its joints are a little off the drawing, so that its closed form no longer holds.

python examples/19_calibrated_arm.py [picture.png]
"""

import sys

import numpy as np
import pinocchio as pin

import pin_metaik as mik
from pin_metaik.figures import new_figure, save_picture

PLACE, ANGLE = 1e-3, 1e-3  # m and rad: what a calibration finds, joint by joint
TARGETS = 200


def main() -> None:
    rng = np.random.default_rng(0)
    drawing = mik.load_robot("ur5").model
    measured = drawing.copy()
    for joint in range(1, measured.njoints):
        off = pin.exp6(np.concatenate([rng.normal(0, PLACE, 3), rng.normal(0, ANGLE, 3)]))
        measured.jointPlacements[joint] = measured.jointPlacements[joint] * off

    nominal, real = mik.Chain(drawing, "tool0"), mik.Chain(measured, "tool0")
    poses = [real.placements(real.q(real.box.sample(rng, 1)[0]))[0] for _ in range(TARGETS)]

    # Where the real arm ends up with the answers for the drawing, and with those for the calibrated model.
    missed = {"closed form of the drawing": [], "calibrated model": []}
    for pose in poses:
        for errors, chain in zip(missed.values(), (nominal, real), strict=True):
            result = mik.solve_ik(chain, pose)
            if result:
                errors.append(np.linalg.norm(pose.translation - real.placements(result.q)[0].translation))
    for name, errors in missed.items():
        print(f"{name:28} {len(errors)} of {TARGETS} solved, misses by {1e3 * max(errors):.1e} mm at most")

    every = mik.solve_ik_all(real, poses[0])
    print(f"the calibrated arm has {len(every)} solutions of the first pose, these are all: {every.complete}")
    far = mik.solve_ik(real, pin.SE3(poses[0].rotation, np.array([0.7, 0.5, 0.6])))
    print(f"a pose too far out: {far.status}, proved by {far.proof}")

    if len(sys.argv) > 1:
        figure = new_figure((7.0, 4.5))
        axes = figure.add_subplot()
        axes.hist([1e3 * np.array(errors) for errors in missed.values()], np.logspace(-9, 2, 45), label=list(missed))
        axes.set(xscale="log", xlabel="how far the arm is from the target, mm", ylabel=f"of {TARGETS} targets")
        axes.legend()
        save_picture(figure, sys.argv[1])


if __name__ == "__main__":
    main()
