"""Whether points lie inside closed surfaces of triangles, counted along rays.

A ray that leaves a closed surface from inside crosses it an odd number of times, however its triangles are turned.

* ``triangles`` (t, 9): three corners each, component by component; those of component c are ``starts[c]:starts[c+1]``.
* ``boxes`` (c, 6): least and greatest corner of the box around each component.
"""

from __future__ import annotations

from pin_metaik.compiled import Floats, Ints, inline, jit

# Three directions that no edge of a drawn part lies along; two of them outvote one that grazes an edge.
RAYS = ((0.5257, 0.2391, 0.8164), (-0.7136, 0.6213, 0.3237), (0.1773, -0.9283, 0.3269))


@inline
def crosses(triangle: Floats, x: float, y: float, z: float, u: float, v: float, w: float) -> bool:
    """Whether the ray from (x, y, z) along (u, v, w) meets a triangle (9,): Moeller and Trumbore 1997."""
    ax, ay, az = triangle[3] - triangle[0], triangle[4] - triangle[1], triangle[5] - triangle[2]
    bx, by, bz = triangle[6] - triangle[0], triangle[7] - triangle[1], triangle[8] - triangle[2]
    px, py, pz = v * bz - w * by, w * bx - u * bz, u * by - v * bx
    determinant = ax * px + ay * py + az * pz
    if determinant == 0.0:
        return False
    tx, ty, tz = x - triangle[0], y - triangle[1], z - triangle[2]
    first = (tx * px + ty * py + tz * pz) / determinant
    if first < 0.0 or first > 1.0:
        return False
    qx, qy, qz = ty * az - tz * ay, tz * ax - tx * az, tx * ay - ty * ax
    second = (u * qx + v * qy + w * qz) / determinant
    if second < 0.0 or first + second > 1.0:
        return False
    return bool((bx * qx + by * qy + bz * qz) / determinant > 0.0)


@inline
def encloses(triangles: Floats, starts: Ints, boxes: Floats, c: int, x: float, y: float, z: float) -> bool:
    """Whether component c has the point (x, y, z) inside."""
    box = boxes[c]
    if x < box[0] or y < box[1] or z < box[2] or x > box[3] or y > box[4] or z > box[5]:
        return False
    votes = 0
    for u, v, w in RAYS:
        crossings = 0
        for k in range(starts[c], starts[c + 1]):
            crossings += crosses(triangles[k], x, y, z, u, v, w)
        votes += crossings & 1
    return votes > 1


@jit("void(f8[:,::1], i8[::1], f8[:,::1], f8[:,::1], b1[:,::1])")
def enclosed(triangles: Floats, starts: Ints, boxes: Floats, points: Floats, inside: Ints) -> None:
    """Which components have which of the points (k, 3) inside: written to ``inside`` (k, c)."""
    for i in range(points.shape[0]):
        for c in range(boxes.shape[0]):
            inside[i, c] = encloses(triangles, starts, boxes, c, points[i, 0], points[i, 1], points[i, 2])


@jit("b1(f8[:,::1], i8[::1], f8[:,::1], i8[::1], f8[::1], f8[:,::1], f8[::1])")
def contains_any(
    triangles: Floats, starts: Ints, boxes: Floats, signs: Ints, pose: Floats, points: Floats, other: Floats
) -> bool:
    """Whether a solid has any of the points (k, 3) of another inside.

    Components of sign -1 are hollows: what they have inside is outside again. ``pose`` and ``other`` (12,) are where
    the two are: rotation column by column, then translation.
    """
    for i in range(points.shape[0]):
        px, py, pz = points[i, 0], points[i, 1], points[i, 2]
        dx = other[0] * px + other[3] * py + other[6] * pz + other[9] - pose[9]
        dy = other[1] * px + other[4] * py + other[7] * pz + other[10] - pose[10]
        dz = other[2] * px + other[5] * py + other[8] * pz + other[11] - pose[11]
        x = pose[0] * dx + pose[1] * dy + pose[2] * dz
        y = pose[3] * dx + pose[4] * dy + pose[5] * dz
        z = pose[6] * dx + pose[7] * dy + pose[8] * dz
        total = 0
        for c in range(boxes.shape[0]):
            if encloses(triangles, starts, boxes, c, x, y, z):
                total += signs[c]
        if total > 0:
            return True
    return False
