"""The compiled loops of the visibility graph: which nodes see each other.

Arrays they share:

* ``vertices`` (n, 2), ``before`` and ``after`` (n,): the border of the free space, each vertex with the indices of its
  neighbours along the ring; the free space is on the left of every edge ``vertices[k] -> vertices[after[k]]``.
* ``bends`` (n,): whether a shortest path can bend at a vertex, where the free space is wider than a half-plane.
* ``slack``: how far from a line a point still counts as on it.
* ``first`` (cells + 1,), ``edges``: the edges near each cell of a grid over the border, those of cell c are
  ``edges[first[c]:first[c + 1]]``; ``place``, x and y of the grid's corner and the width of a cell; ``columns``.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from pin_metaik.compiled import Floats, Ints, inline, jit, shared

BORDER = "f8[:,::1], i8[::1], i8[::1], b1[::1], f8"  # vertices, before, after, bends, slack
GRID = "i8[::1], i8[::1], f8[::1], i8"  # first, edges, place, columns


@inline
def cell(x: float, low: float, width: float, count: int) -> int:
    """The row or column of a coordinate, the nearest there is."""
    return min(max(int((x - low) / width), 0), count - 1)


@inline
def at_height(y: float, ax: float, ay: float, bx: float, by: float) -> float:
    """Where the line from a to b is at a height; beyond an end, that end's x."""
    if by == ay:
        return bx
    share = min(max((y - ay) / (by - ay), 0.0), 1.0)
    return ax + share * (bx - ax)


@jit("void(f8[:,::1], i8[::1], f8, f8[::1], i8, i8, i8[::1], i8[::1])")
def sort_into_cells(
    vertices: Floats, after: Ints, pad: float, place: Floats, columns: int, rows: int, first: Ints, edges: Ints
) -> None:
    """Which edges come within a pad of each cell, or, as long as there is no room for them, how many.

    Args:
        vertices: (n, 2).
        after: (n,).
        pad: How near is near.
        place: Corner and width of a cell.
        columns: Cells in a row.
        rows: Rows.
        first: (cells + 1,): counted without room; with room, where to put the first of each, and where the next one's
            begin when done.
        edges: Filled in, if it has any room.
    """
    x, y, width = place[0], place[1], place[2]
    for k in range(len(vertices)):
        ax, ay = vertices[k, 0], vertices[k, 1]
        bx, by = vertices[after[k], 0], vertices[after[k], 1]
        top = cell(max(ay, by) + pad, y, width, rows)
        for row in range(cell(min(ay, by) - pad, y, width, rows), top + 1):
            low, high = y + row * width - pad, y + (row + 1) * width + pad
            p, q = at_height(low, ax, ay, bx, by), at_height(high, ax, ay, bx, by)
            if ay == by:
                p, q = ax, bx
            for column in range(cell(min(p, q) - pad, x, width, columns), cell(max(p, q) + pad, x, width, columns) + 1):
                c = row * columns + column
                if len(edges) > 0:
                    edges[first[c]] = k
                first[c] += 1


@inline
def side(ax: float, ay: float, ux: float, uy: float, px: float, py: float, slack: float) -> int:
    """On which side of the line through a with unit direction u the point p is: 1 left, -1 right, 0 on it."""
    s = ux * (py - ay) - uy * (px - ax)
    return 1 if s > slack else (-1 if s < -slack else 0)


@inline
def touched_on(k: int, ux: float, uy: float, vertices: Floats, before: Ints, after: Ints, slack: float) -> int:
    """On which side of a line through corner k the obstacle is: 1 left, -1 right, 0 neither; 2 if the line cuts it."""
    x, y = vertices[k, 0], vertices[k, 1]
    a, b = before[k], after[k]
    one = side(x, y, ux, uy, vertices[a, 0], vertices[a, 1], slack)
    other = side(x, y, ux, uy, vertices[b, 0], vertices[b, 1], slack)
    return 2 if one * other < 0 else (one if one != 0 else other)


@inline
def stands_between(
    k: int,
    ax: float,
    ay: float,
    ux: float,
    uy: float,
    length: float,
    vertices: Floats,
    before: Ints,
    after: Ints,
    bends: NDArray[np.bool_],
    slack: float,
) -> bool:
    """Whether vertex k, or its edge, stands in the way from a along the unit direction u.

    A vertex on the line blocks it, unless it lies amid an edge along the line. At a corner the two shorter segments,
    which end there, stand for the long one; anywhere else the free space is convex, and the line leaves it.
    """
    px, py = vertices[k, 0] - ax, vertices[k, 1] - ay
    q = after[k]
    qx, qy = vertices[q, 0] - ax, vertices[q, 1] - ay
    sp, sq = ux * py - uy * px, ux * qy - uy * qx
    if -slack <= sp <= slack:  # the vertex is on the line
        t = ux * px + uy * py
        if slack < t < length - slack:
            o = before[k]
            so = ux * (vertices[o, 1] - ay) - uy * (vertices[o, 0] - ax)
            return bool(bends[k] or abs(so) > slack or abs(sq) > slack)
    elif (sp > 0) != (sq > 0) and not -slack <= sq <= slack:  # the edge crosses the line
        share = sp / (sp - sq)
        t = ux * (px + share * (qx - px)) + uy * (py + share * (qy - py))
        return bool(slack < t < length - slack)
    return False


@shared
def wall_between(
    ax: float,
    ay: float,
    bx: float,
    by: float,
    vertices: Floats,
    before: Ints,
    after: Ints,
    bends: NDArray[np.bool_],
    slack: float,
    first: Ints,
    edges: Ints,
    place: Floats,
    columns: int,
    guess: int,
) -> int:
    """The vertex that, or whose edge, stands between a and b, or -1; a guess is looked at first, if it is not -1.

    Looked for along the cells that the line runs through, from a to b, row by row.
    """
    length = math.hypot(bx - ax, by - ay)
    ux, uy = (bx - ax) / length, (by - ay) / length
    if guess >= 0 and stands_between(guess, ax, ay, ux, uy, length, vertices, before, after, bends, slack):
        return guess
    x, y, width = place[0], place[1], place[2]
    rows = (len(first) - 1) // columns
    row, last_row = cell(ay, y, width, rows), cell(by, y, width, rows)
    up = 1 if last_row >= row else -1
    right = 1 if bx >= ax else -1
    column = cell(ax, x, width, columns)
    while True:
        leaves = bx
        if row != last_row:
            leaves = at_height(y + (row + (up + 1) // 2) * width, ax, ay, bx, by)
        last_column = cell(leaves, x, width, columns)
        while True:
            c = row * columns + column
            for i in range(first[c], first[c + 1]):
                k = int(edges[i])
                if stands_between(k, ax, ay, ux, uy, length, vertices, before, after, bends, slack):
                    return k
            if right * (last_column - column) <= 0:
                break
            column += right
        if row == last_row:
            return -1
        row += up


@jit(f"i8(i8, i8, f8[:,::1], i8[::1], f8[::1], f8[::1], b1[::1], f8, {BORDER}, {GRID}, i8[::1])")
def nearer_through(
    node: int,
    came_from: int,
    points: Floats,
    vertex: Ints,
    length_to: Floats,
    to_go: Floats,
    settled: NDArray[np.bool_],
    longest: float,
    vertices: Floats,
    before: Ints,
    after: Ints,
    bends: NDArray[np.bool_],
    slack: float,
    first: Ints,
    edges: Ints,
    place: Floats,
    columns: int,
    found: Ints,
) -> int:
    """Nodes that a node sees along taut lines and that are nearer to the start through it than by any way before.

    A shortest path bends at a corner only towards the obstacle, so most of what a corner sees need not be looked at.

    Args:
        node: Where from.
        came_from: The node before it on its shortest path, or -1.
        points: Nodes (m, 2).
        vertex: Which vertex each node is (m,); -1 for start and goal.
        length_to: Length of the shortest path to each node so far (m,).
        to_go: Least distance from each node to the goal (m,).
        settled: Whether a node's shortest path is known (m,).
        longest: Longer paths are of no use.
        vertices: Of the border, see above, as all that follow.
        before: See above.
        after: See above.
        bends: See above.
        slack: See above.
        first: See above.
        edges: See above.
        place: See above.
        columns: See above.
        found: The nodes (m,), filled in.

    Returns:
        How many.
    """
    x, y, k = points[node, 0], points[node, 1], vertex[node]
    ix, iy, come, wrapped = 0.0, 0.0, 0.0, 0
    if came_from >= 0:
        ix, iy = x - points[came_from, 0], y - points[came_from, 1]
        come = math.hypot(ix, iy)
        ix, iy = ix / come, iy / come
        wrapped = touched_on(k, ix, iy, vertices, before, after, slack)
    count, guess = 0, -1
    for m in range(len(points)):
        if settled[m] or m == node:
            continue
        dx, dy = points[m, 0] - x, points[m, 1] - y
        far = math.hypot(dx, dy)
        whole = length_to[node] + far
        if far <= slack or whole >= length_to[m] or whole + to_go[m] > longest:
            continue
        ux, uy = dx / far, dy / far
        if k >= 0:
            obstacle = touched_on(k, ux, uy, vertices, before, after, slack)
            if obstacle == 2:
                continue
            if came_from >= 0:
                # no turn, either, where the node is within the slack of the line from the one before to the next
                ahead = side(0.0, 0.0, ix, iy, dx, dy, slack * max(1.0, far / come))
                if ahead * obstacle < 0 or ahead * wrapped < 0 or (ahead == 0 and ix * ux + iy * uy < 0):
                    continue
        j = vertex[m]
        if j >= 0 and touched_on(j, ux, uy, vertices, before, after, slack) == 2:
            continue
        wall = wall_between(
            x, y, points[m, 0], points[m, 1], vertices, before, after, bends, slack, first, edges, place, columns, guess
        )
        if wall < 0:
            found[count] = m
            count += 1
        else:
            guess = wall
    return count


@jit(f"void(i8, i8, f8[:,::1], i8[::1], {BORDER}, {GRID}, b1[::1])")
def seen_from(
    node: int,
    begin: int,
    points: Floats,
    vertex: Ints,
    vertices: Floats,
    before: Ints,
    after: Ints,
    bends: NDArray[np.bool_],
    slack: float,
    first: Ints,
    edges: Ints,
    place: Floats,
    columns: int,
    sees: NDArray[np.bool_],
) -> None:
    """Which nodes (m,), from ``begin`` on, a node sees along a line that is taut at both ends; never itself."""
    x, y, k = points[node, 0], points[node, 1], vertex[node]
    guess = -1
    for m in range(begin, len(points)):
        dx, dy = points[m, 0] - x, points[m, 1] - y
        far = math.hypot(dx, dy)
        sees[m] = False
        if m == node or far <= slack:
            continue
        ux, uy = dx / far, dy / far
        if k >= 0 and touched_on(k, ux, uy, vertices, before, after, slack) == 2:
            continue
        if vertex[m] >= 0 and touched_on(vertex[m], ux, uy, vertices, before, after, slack) == 2:
            continue
        wall = wall_between(
            x, y, points[m, 0], points[m, 1], vertices, before, after, bends, slack, first, edges, place, columns, guess
        )
        sees[m] = wall < 0
        if wall >= 0:
            guess = wall
