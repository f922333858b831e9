"""Look at the world in a browser, through Pinocchio's viser visualizer. It needs the extra ``viewer``.

python examples/11_look_at_the_world.py --stay                 # then open the address it prints; Ctrl-C ends it
python examples/11_look_at_the_world.py --picture shelf.png    # takes a picture with the browser that looks
"""

import argparse
import json
import sys
import time

import numpy as np
import pinocchio as pin
from PIL import Image, ImageDraw, ImageFont
from PIL.PngImagePlugin import PngInfo

import pin_metaik as mik
from pin_metaik.collision import load_scene
from pin_metaik.collision.viewer import WorldViewer, open_viewer


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

    viewer = open_viewer(world, options.port, frame=robot.frame)
    viewer.show_target(deep_in_the_shelf)
    viewer.display(clear.q)
    if options.picture:
        panels = [panel(viewer, q, world) for q in (alone.q, clear.q)]
        shown = PngInfo()  # which configurations it shows, for whoever finds the file
        shown.add_text("configurations", json.dumps([q.round(6).tolist() for q in (alone.q, clear.q)]))
        Image.fromarray(np.hstack(panels)).save(options.picture, pnginfo=shown)
    elif not options.stay:
        print("nobody will have seen it: --stay keeps the page open until Ctrl-C")
    while options.stay:
        for q in (alone.q, clear.q):
            viewer.display(q)
            time.sleep(2.0)


def panel(viewer: WorldViewer, q: np.ndarray, world: mik.CollisionWorld) -> np.ndarray:
    """What the first browser that looks sees of the robot at q, with a title: red, green and blue (h, w, 3)."""
    viewer.display(q)
    image = Image.fromarray(viewer.picture(720, 600, timeout=600.0))
    title = "collides" if world.in_collision(q) else "free"
    ImageDraw.Draw(image).text((24, 16), title, fill=(40, 40, 40), font=ImageFont.load_default(36))
    return np.asarray(image)


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)
