"""The fastest of several paths: the shortest one may have sharp corners, or no room to round them."""

from __future__ import annotations

from collections.abc import Iterable

from pin_metaik.arguments import checked
from pin_metaik.errors import InvalidSetting
from pin_metaik.mobile.errors import Blocked, NoPath
from pin_metaik.mobile.motion.result import TrajectoryPlan
from pin_metaik.mobile.motion.timing import plan_trajectory
from pin_metaik.mobile.motion.vehicle import NOMAD_200, Vehicle
from pin_metaik.mobile.paths.problem import PathProblem
from pin_metaik.mobile.world.growth import Join
from pin_metaik.mobile.world.scene import Scene

MARGINS = (0.05, 0.1, 0.2, 0.3)  # m


@checked
def fastest_trajectory(
    scene: Scene,
    vehicle: Vehicle = NOMAD_200,
    *,
    paths: int = 3,
    margins: Iterable[float] = MARGINS,
    join: Join | None = None,
) -> TrajectoryPlan:
    """The quickest trajectory over the shortest paths of the best homotopy classes, for each of several margins.

    A wider margin makes the path longer but its curves faster; none is best everywhere, so all are tried.

    Args:
        scene: The world, start and goal, in m.
        vehicle: The robot.
        paths: How many homotopy classes to try, for each margin.
        margins: Distances, in m, that paths keep in addition to the robot's radius. Margins without a path are skipped.
        join: How corners of grown obstacles are joined; see ``PathProblem.of``.

    Raises:
        Blocked: The robot cannot be at the start or the goal with any of the margins.
        NoPath: There is no path with any of the margins.
        InvalidSetting: No margins at all.
    """
    best: TrajectoryPlan | None = None
    failure: Blocked | NoPath | None = None
    for margin in margins:
        try:
            found = PathProblem.of(scene, vehicle.radius, margin, join).alternatives(paths)
        except (Blocked, NoPath) as error:
            failure = failure or error
            continue
        for path in found:
            plan = plan_trajectory(path, vehicle, scene.obstacles)
            if plan.success and (best is None or plan.time < best.time):
                best = plan
    if best is not None:
        return best
    if failure is not None:
        raise failure
    raise InvalidSetting("give at least one margin")
