"""Weld a pipe onto a plate: all round it with a torch that is free about its axis and may tilt by 5 degrees.

python examples/14_weld_seam.py [picture.png]
"""

import sys
from pathlib import Path

import numpy as np
import pinocchio as pin
from matplotlib.figure import Figure

import pin_metaik as mik
from pin_metaik.collision import Box, Cylinder, Obstacle, draw_world

PIPE, HEIGHT, CENTRE = 0.05, 0.12, np.array([0.42, 0.1, 0.2])  # radius and height of the pipe, its foot: m
TORCH = 0.18  # m from the flange to the tip
POSES = 150
TILT = np.deg2rad(5.0)


def seam() -> list[pin.SE3]:
    """Poses of the torch round the foot of the pipe: z into the corner, 45 degrees steep, x along the seam."""
    poses = []
    for angle in np.linspace(-np.pi, np.pi, POSES):
        out = np.array([np.cos(angle), np.sin(angle), 0.0])
        z = -(out + np.array([0.0, 0.0, 1.0])) / np.sqrt(2.0)
        x = np.array([-out[1], out[0], 0.0])
        at = CENTRE + (PIPE + 0.004) * out + np.array([0.0, 0.0, 0.004])  # 4 mm of stick-out on both sides
        poses.append(pin.SE3(np.column_stack([x, np.cross(z, x), z]), at))
    return poses


def main() -> None:
    picture = Path(sys.argv[1] if len(sys.argv) > 1 else "weld_seam.png")
    robot = mik.load_robot("ur5")
    flange = robot.model.frames[robot.model.getFrameId("tool0")]
    tip = pin.SE3(np.eye(3), np.array([0.0, 0.0, TORCH]))
    robot.model.addFrame(pin.Frame("torch", flange.parentJoint, flange.placement * tip, pin.FrameType.OP_FRAME))
    hose = {"wrist_3_joint": (-1.8, 1.8)}  # rad; farther it would wind the hose round the arm
    chain = mik.Chain(robot, "torch", limits=hose)
    pipe = Obstacle("pipe", Cylinder(PIPE, HEIGHT), CENTRE + np.array([0.0, 0.0, HEIGHT / 2]))
    plate = Obstacle("plate", Box((0.3, 0.3, 0.02)), CENTRE - np.array([0.0, 0.0, 0.01]))
    world = mik.CollisionWorld(robot, [pipe, plate])
    body = pin.SE3(np.eye(3), np.array([0.0, 0.0, TORCH / 2 - 0.006]))
    world.attach("torch body", Cylinder(0.006, TORCH - 0.016), "tool0", body, touching=["wrist_3_link"])

    asked = {
        "the pose, strictly": seam(),
        "free about the torch": [mik.Target(pose, orientation_tolerance=(1e-5, 1e-5, np.inf)) for pose in seam()],
        "free, and 5 degrees of tilt": [
            mik.Target(pose, orientation_tolerance=(TILT, TILT, np.inf)) for pose in seam()
        ],
    }
    paths = {}
    for name, targets in asked.items():
        path = paths[name] = mik.solve_ik_path(chain, targets, max_step=0.15, world=world, reconfigure=True)
        print(
            f"{name}: {path.success.sum()} of {POSES} poses met, {len(path.breaks)} breaks, {len(path.moves)} of them "
            f"bridged by a free move, {path.seconds:.2f} s"
        )
        print("".join(f"    {reason}\n" for reason in path.reasons[:2]), end="")

    path = next((path for path in paths.values() if path), list(paths.values())[-1])
    figure = Figure(figsize=(12, 6), layout="constrained")
    figure.get_layout_engine().set(wspace=0.08)  # room for the label of z
    axes = figure.add_subplot(1, 2, 1, projection="3d")
    draw_world(axes, world, path.q[[POSES // 2]])
    axes.view_init(elev=24, azim=-35)
    axes.set_box_aspect(None, zoom=0.9)
    spins = figure.add_subplot(1, 2, 2)
    for name, path in paths.items():
        turns = np.unwrap([spin(chain, q, pose) for q, pose in zip(path.q, seam(), strict=True)])
        spins.plot(np.where(path.success, np.rad2deg(turns), np.nan), label=name)
    spins.set(xlabel="pose", ylabel="turn of the torch about its axis, deg")
    spins.legend()
    figure.savefig(picture, dpi=110)
    print(picture)


def spin(chain: mik.Chain, q: np.ndarray, pose: pin.SE3) -> float:
    """How far (rad) the torch is turned about its axis, away from the pose."""
    return float(pin.log3(pose.rotation.T @ chain.placements(q)[0].rotation)[2])


if __name__ == "__main__":
    main()
