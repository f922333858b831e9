"""The quickest path over a graph of places among moving obstacles: A* over places and time windows.

Time is not discretised: a place is free in windows, within one of which an earlier arrival is never worse, because the
robot can wait (safe interval path planning, Phillips and Likhachev 2011). The windows, and the times at which a line
may be driven, are computed from the motions of the obstacles, not sampled.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from contextlib import nullcontext
from heapq import heappop, heappush
from time import perf_counter

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from pin_metaik.arguments import array, checked, number
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidSetting
from pin_metaik.mobile.errors import NoTimedPath
from pin_metaik.mobile.moving.obstacle import MovingObstacle
from pin_metaik.mobile.moving.waiting import WaitingPath
from pin_metaik.mobile.moving.windows import SHORT, Departures, Windows
from pin_metaik.mobile.paths.problem import PathProblem
from pin_metaik.mobile.world.cells import cell_middles
from pin_metaik.mobile.world.scene import Scene
from pin_metaik.notice import notice
from pin_metaik.optimize.settings import positive, whole
from pin_metaik.watching import Progress, Stopped, Watch, tell

LARGE = 1500  # places from which on looking for lines of sight takes seconds
CELLS = 16
MOST = 6000  # places; their lines of sight are 18 million

State = tuple[int, int]  # a place, and the number of its window


@checked
def plan_among_moving(
    problem: PathProblem | Scene,
    moving: Sequence[MovingObstacle],
    speed: float,
    *,
    start_time: float = 0.0,
    cells: int = CELLS,
    places: ArrayLike | None = None,
    watch: Watch | None = None,
) -> WaitingPath:
    """The quickest motion over straight lines among obstacles at rest and moving obstacles.

    The robot drives at its speed or waits, and starts and stops instantly. It turns and waits only at certain places:
    start, goal, corners of the grown obstacles at rest, centres of the ``cells``, and ``places``. The result is a
    quickest one of all such motions along lines of sight between these places; with other places or speeds there may be
    a quicker one. At the goal the robot can stay for ever.

    Args:
        problem: Obstacles at rest, start, goal, and the clearance, which is kept from moving obstacles too; or a scene,
            for a point robot.
        moving: The moving obstacles. Discs are replaced by polygons of 64 sides around them.
        speed: Speed of the robot, m/s.
        start_time: When the motion begins, s, on the time axis of the obstacles.
        cells: Number of square cells along the longer side of the workspace, in whose centres it may turn and wait; 0
            for none.
        places: Further positions (k, 2) to turn and wait at, m; those that are not free are left out.
        watch: Called with the number of time windows expanded so far; returning True ends the search.

    Raises:
        Blocked: The robot cannot be at the start or the goal.
        NoPath: There is no path even if nothing moves.
        NoTimedPath: No motion over these places keeps clear of the moving obstacles, or the watch ended the search; a
            subclass of ``NoPath`` with the reason.
        InvalidSetting: A speed that is not above zero, or too many places.
    """
    began = perf_counter()
    if isinstance(problem, Scene):
        problem = PathProblem.of(problem)
    positive("speed", speed)
    whole("cells", cells, 0)
    number("start_time", start_time)
    direct = problem.optimum.length / speed
    points = _places(problem, cells, np.empty((0, 2)) if places is None else array("places", places, "k", 2))
    departures = Departures(moving, speed, problem.space.clearance)
    search = _Search(problem, points, _lines_of_sight(problem, points), departures, start_time, watch)
    try:
        times, nodes = search.run()
    except Stopped:
        raise search.none("its watch ended the search") from None
    return WaitingPath(
        times, points[nodes], speed, problem, tuple(moving), direct, search.opened, perf_counter() - began
    )


class _Search:
    """A* from the start, the first place, to the goal, the second; costs are times of arrival."""

    def __init__(
        self,
        problem: PathProblem,
        points: Array,
        lines: csr_array,
        departures: Departures,
        start_time: float,
        watch: Watch | None,
    ) -> None:
        self.problem, self.points, self.lines, self.departures = problem, points, lines, departures
        self.begin, self.watch = start_time, watch
        self.to_go = dijkstra(lines, indices=1) / departures.speed
        self.opened = 0
        self._windows: dict[tuple[int, int], Windows] = {}

    def run(self) -> tuple[Array, list[int]]:
        """Times (n,) and places of the quickest motion, waits included."""
        first = next((k for k, (low, high) in enumerate(self.windows(0)) if low <= self.begin < high), None)
        if first is None:
            raise self.none(f"a moving obstacle covers the start at {self.begin:g} s")
        if not self.windows(1) or self.windows(1)[-1][1] < np.inf:
            raise self.none("a moving obstacle stays over the goal for ever")
        goal = (1, len(self.windows(1)) - 1)
        arrival: dict[State, float] = {(0, first): self.begin}
        before: dict[State, tuple[State, float]] = {}  # where from, and when it set out
        settled: set[State] = set()
        order = itertools.count()
        heap = [(self.begin + float(self.to_go[0]), next(order), (0, first))]
        while heap:
            _, _, state = heappop(heap)
            if state in settled:
                continue
            settled.add(state)
            self.opened += 1
            if state == goal:
                return _traced(arrival, before, goal)
            tell(self.watch, Progress(self.opened, label="windows opened"))
            for following, departure, there in self._ways_on(state, arrival[state]):
                if there < arrival.get(following, np.inf) and following not in settled:
                    arrival[following], before[following] = there, (state, departure)
                    heappush(heap, (there + float(self.to_go[following[0]]), next(order), following))
        raise self.none("with any waits, every path over these places meets a moving obstacle")

    def windows(self, node: int) -> Windows:
        """When a place is free."""
        return self.departures_of(node, node)

    def departures_of(self, node: int, other: int) -> Windows:
        """When to set out from a place to another."""
        if (node, other) not in self._windows:
            self._windows[node, other] = self.departures.along(self.points[node], self.points[other])
        return self._windows[node, other]

    def _ways_on(self, state: State, now: float) -> list[tuple[State, float, float]]:
        """From a place in a window, there from a time on: states that follow, when to set out, when one arrives."""
        node, window = state
        until = self.windows(node)[window][1]
        ways = []
        row = slice(self.lines.indptr[node], self.lines.indptr[node + 1])
        for other, length in zip(self.lines.indices[row].tolist(), self.lines.data[row].tolist(), strict=True):
            took = length / self.departures.speed
            reached = set()
            for low, high in self.departures_of(node, other):
                departure = max(low, now)
                if departure > min(high, until):
                    continue
                there = departure + took
                into = self._window_at(other, there)
                if into is not None and into not in reached:
                    reached.add(into)
                    ways.append(((other, into), departure, there))
        return ways

    def _window_at(self, node: int, there: float) -> int | None:
        """The window of a place that a time is in; as the line was free until then, there is one but for rounding."""
        for slack in (0.0, SHORT * max(1.0, abs(there))):
            for k, (low, high) in enumerate(self.windows(node)):
                if low - slack <= there <= high + slack:
                    return k
        return None

    def none(self, why: str) -> NoTimedPath:
        """What to raise where there is nothing to return."""
        scene = self.problem.scene
        return NoTimedPath(scene.start, scene.goal, self.problem.space.clearance, why)


def _traced(
    arrival: dict[State, float], before: dict[State, tuple[State, float]], goal: State
) -> tuple[Array, list[int]]:
    """Times and places from the start to the goal; a place is there twice where the robot waits."""
    times, nodes, state = [arrival[goal]], [goal[0]], goal
    while state in before:
        state, departure = before[state]
        times.append(departure)
        nodes.append(state[0])
        if departure - arrival[state] > SHORT * max(1.0, abs(departure)):  # less is rounding
            times.append(arrival[state])
            nodes.append(state[0])
    return np.array(times[::-1]), nodes[::-1]


def _places(problem: PathProblem, cells: int, more: Array) -> Array:
    """Start, goal, corners, middles of cells, and what is added (n, 2)."""
    if cells**2 > MOST:
        raise InvalidSetting(f"cells: {cells:,} along a side are more than {MOST:,} places")
    extra = np.vstack((cell_middles(problem.space.box, cells).reshape(-1, 2) if cells else np.empty((0, 2)), more))
    extra = extra[~shapely.intersects(problem.space.core, shapely.points(extra))]
    corners = problem.visibility.border.vertices[problem.visibility.border.corners]
    points = np.vstack((problem.scene.start, problem.scene.goal, corners, extra))
    if len(points) > MOST:
        raise InvalidSetting(f"{len(points):,} places: at most {MOST:,}, whose lines of sight are looked for in pairs")
    return points


def _lines_of_sight(problem: PathProblem, points: Array) -> csr_array:
    """Lengths of the free lines between places (n, 2), both ways, sparse (n, n)."""
    n = len(points)
    with notice(f"lines of sight between {n:,} places") if n > LARGE else nullcontext():
        seen: list[NDArray[np.int64]] = []
        for i in range(n - 1):
            lines = np.stack((np.broadcast_to(points[i], (n - 1 - i, 2)), points[i + 1 :]), axis=1)
            free = ~shapely.intersects(problem.space.core, shapely.linestrings(lines))
            others = i + 1 + np.flatnonzero(free)
            seen.append(np.column_stack((np.full(len(others), i), others)))
    one, other = np.concatenate(seen).T
    lengths = np.hypot(*(points[other] - points[one]).T)
    both = np.concatenate((one, other)), np.concatenate((other, one))
    return csr_array((np.tile(lengths, 2), both), shape=(n, n))
