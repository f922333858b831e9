"""Solve one pose of a Panda, and let Pinocchio confirm the answer.

python examples/01_solve_one_pose.py [picture.png]
"""

import sys

import numpy as np
import pinocchio as pin

import pin_metaik as mik
from pin_metaik.collision import save_world


def main() -> None:
    robot = mik.load_robot("panda")  # a name, a .urdf or a DH table; any pin.Model will do
    chain = mik.Chain(robot.model, "panda_hand_tcp")

    target = pin.SE3(pin.rpy.rpyToMatrix(np.pi, 0.0, 0.3), np.array([0.4, 0.2, 0.5]))
    result = mik.solve_ik(chain, target)
    print(result)

    # The answer is a Pinocchio configuration of the whole model, fingers included.
    data = robot.model.createData()
    pin.framesForwardKinematics(robot.model, data, result.q)
    reached = data.oMf[robot.model.getFrameId("panda_hand_tcp")]
    print(f"Pinocchio: {np.linalg.norm(pin.log6(target.actInv(reached)).vector):.1e} from the target")

    # Out of reach is an answer too, not an exception.
    far = mik.solve_ik(chain, pin.SE3(target.rotation, np.array([2.0, 0.0, 0.5])))
    print(f"{far.status}: {far.why}")

    if len(sys.argv) > 1:
        save_world(sys.argv[1], mik.CollisionWorld(robot), result.q, [target])


if __name__ == "__main__":
    main()
