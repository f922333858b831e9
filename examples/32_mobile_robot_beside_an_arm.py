"""A mobile robot drives up to an arm, which reaches for it: one Pinocchio, one viewer.

``--show`` plays it in a browser; that takes ``pip install '.[viewer]'`` in the clone.

python examples/32_mobile_robot_beside_an_arm.py [picture.png]
"""

import sys
import time

import numpy as np
import pinocchio as pin

import pin_metaik as mik
from pin_metaik import mobile
from pin_metaik.collision import Box, Cylinder, Obstacle, save_world


def main() -> None:
    # The arm stands at the origin and is an obstacle on the floor, next to two boxes.
    obstacles = [[(x - a, y - b), (x + a, y - b), (x + a, y + b), (x - a, y + b)] for x, y, a, b in BOXES]
    scene = mobile.Scene(start=(-2, -1.5), goal=(0.5, 0), obstacles=obstacles)
    problem = mobile.PathProblem.of(scene, mobile.NOMAD_200.radius, margin=0.1)
    plan = mobile.plan_trajectory(mobile.plan_path(problem).path, mobile.NOMAD_200, scene.obstacles)
    print(plan)

    # Both robots are Pinocchio models; the mobile one has a planar joint: q = (x, y, cos, sin).
    cart, panda = mobile.mobile_robot(mobile.NOMAD_200, HEIGHT), mik.load_robot("panda")
    drive = mobile.configurations(plan.trajectory.sample(dt=1 / 30))
    data = cart.model.createData()
    pin.framesForwardKinematics(cart.model, data, drive[-1])
    parked = data.oMf[cart.model.getFrameId(cart.frame)]
    print(f"{cart.name} has arrived at {parked.translation.round(3)}")

    # The hand shall point down, 0.1 m above the mobile robot.
    chain, down = mik.Chain(panda.model, "panda_hand_tcp"), np.diag([1.0, -1.0, -1.0])
    rest = mik.solve_ik(chain, pin.SE3(down, np.array([0.3, 0, 0.6])))
    above = parked.translation + np.array([0, 0, HEIGHT + 0.1])
    reached = mik.solve_ik(chain, pin.SE3(down, above), rest.q, solver=mik.IKSolver(select="nearest"))
    print(f"{panda.name}: {reached.status}, the hand above it")

    if sys.argv[1:] not in ([], ["--show"]):
        low = [Obstacle(f"box {i}", Box((2 * a, 2 * b, 0.5)), (x, y, 0.25)) for i, (x, y, a, b) in enumerate(BOXES[1:])]
        there = parked.translation + np.array([0, 0, HEIGHT / 2])
        low.append(Obstacle("cart", Cylinder(mobile.NOMAD_200.radius, HEIGHT), there))
        save_world(sys.argv[1], mik.CollisionWorld(panda, low), [rest.q, reached.q], [pin.SE3(down, above)])
    if "--show" in sys.argv:
        show(cart, drive, panda, rest.q, reached.q)


HEIGHT = 0.4  # of the mobile robot, m
BOXES = [(0, 0, 0.12, 0.12), (-1.2, -0.9, 0.3, 0.3), (0.6, -1.0, 0.4, 0.2)]  # centre, half widths


def show(cart: mik.Robot, drive: np.ndarray, panda: mik.Robot, rest: np.ndarray, reach: np.ndarray) -> None:
    import viser
    from pinocchio.visualize import ViserVisualizer

    server = viser.ViserServer()
    views = []
    for robot in (cart, panda):
        view = ViserVisualizer(robot.model, robot.collision_model, robot.visual_model)
        view.initViewer(server)
        view.loadViewerModel(robot.name)
        views.append(view)
    for i, (x, y, a, b) in enumerate(BOXES[1:]):
        server.scene.add_box(f"/box{i}", dimensions=(2 * a, 2 * b, 0.5), position=(x, y, 0.25), color=(200, 195, 185))
    while True:
        for q in drive:
            views[0].display(q)
            views[1].display(rest)
            time.sleep(1 / 30)
        for share in np.linspace(0, 1, 45):
            views[1].display(pin.interpolate(panda.model, rest, reach, share))
            time.sleep(1 / 30)
        time.sleep(2)


if __name__ == "__main__":
    main()
