"""Look at the world in a browser, through Pinocchio's viser visualizer: pip install '.[viewer]'.

python examples/11_look_at_the_world.py --stay                 # then open the address it prints
python examples/11_look_at_the_world.py --picture shelf.png    # takes a picture with the browser that is looking
"""

import argparse
import time
from typing import Any

import matplotlib.image
import numpy as np
import pinocchio as pin

import pin_metaik as mik
from pin_metaik.collision import load_scene
from pin_metaik.collision.viewer import open_viewer


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--stay", action="store_true", help="until Ctrl-C")
    parser.add_argument("--picture", help="file to write, .png")
    parser.add_argument("--port", type=int, default=8080)
    options = parser.parse_args()

    robot = mik.load_robot("panda")
    chain = mik.Chain(robot.model, robot.frame)
    world = mik.CollisionWorld(robot, load_scene("shelf"))
    deep_in_the_shelf = pin.SE3(pin.utils.rotate("y", np.pi / 2), np.array([0.68, -0.25, 0.6]))
    alone = mik.solve_ik(chain, deep_in_the_shelf)
    clear = mik.solve_ik(chain, deep_in_the_shelf, world=world)
    print("without the world:", "; ".join(map(str, world.pairs_in_collision(alone.q))))
    print("in the world:     ", clear)

    viewer = open_viewer(world, options.port)
    viewer.display(clear.q)
    if options.picture:
        matplotlib.image.imsave(options.picture, np.hstack([photograph(viewer, q) for q in (alone.q, clear.q)]))
    while options.stay:
        for q in (alone.q, clear.q):
            viewer.display(q)
            time.sleep(2.0)


def photograph(viewer: Any, q: np.ndarray) -> np.ndarray:
    """What the first browser that looks sees of the robot at q, from behind it: red, green and blue (h, w, 3)."""
    while not viewer.viewer.get_clients():
        time.sleep(0.1)
    client = next(iter(viewer.viewer.get_clients().values()))
    client.camera.position, client.camera.look_at = (-0.15, -0.92, 0.9), (0.35, -0.06, 0.4)
    viewer.display(q)
    time.sleep(5.0)  # meshes are on their way
    return np.asarray(client.get_render(height=640, width=720))[110:530, 140:680]


if __name__ == "__main__":
    main()
