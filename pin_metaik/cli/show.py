"""``--show``: a solution in the browser, until Ctrl-C."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rich.console import Console

from pin_metaik.collision import CollisionWorld
from pin_metaik.robots import Robot


def show_in_browser(
    robot: Robot, frame: str, q: NDArray[np.float64], target: Any = None, world: CollisionWorld | None = None
) -> None:
    """Show a robot at configuration q (nq,) and its target; what collides is red. Returns at Ctrl-C.

    Args:
        robot: The robot.
        frame: Whose axes are drawn.
        q: The configuration.
        target: A pose or a position (3,) whose axes are drawn, or None.
        world: With its obstacles; without one the robot is alone.

    Raises:
        MissingExtra: viser, trimesh or pycollada is not installed.
        InvalidModel: The robot has no geometry to show.
    """
    from pin_metaik.collision.viewer import open_viewer

    viewer = open_viewer(CollisionWorld(robot) if world is None else world, 0, frame=frame)
    if target is not None:
        viewer.show_target(target)
    viewer.display(q)
    address = f"http://localhost:{viewer.viewer.get_port()}"
    Console(stderr=True).print(f"open {address}; Ctrl-C ends", highlight=False, soft_wrap=True)
    try:
        while True:
            time.sleep(0.5)
    except KeyboardInterrupt:
        viewer.viewer.stop()
