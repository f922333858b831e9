from pathlib import Path

import coal
import numpy as np
import pytest

from pin_metaik.collision import Mesh, MeshSize
from pin_metaik.collision.mesh import triangles_of
from pin_metaik.errors import InvalidGeometry

CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
FACES = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4)]
CUBE = np.array([*FACES, (1, 5, 7), (1, 7, 3)])


def write(path: Path, vertices: np.ndarray, faces: np.ndarray) -> Path:
    lines = [f"v {x} {y} {z}" for x, y, z in vertices] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]
    path.write_text("\n".join(lines))
    return path


def test_a_closed_mesh_is_read(tmp_path: Path) -> None:
    mesh = Mesh.read(write(tmp_path / "cube.obj", CORNERS, CUBE), scale=0.5)
    assert mesh.convex
    assert mesh.geometry().computeVolume() == pytest.approx(0.125)


def test_a_concave_mesh_stays_a_surface() -> None:
    dented = np.concatenate([CORNERS, [[0.5, 0.5, 0.4]]])
    top = [(1, 5, 8), (5, 7, 8), (7, 3, 8), (3, 1, 8)]
    sides = [face for face in CUBE.tolist() if not set(face) <= {1, 3, 5, 7}]
    mesh = Mesh(dented, np.array(sides + top))
    assert not mesh.convex
    assert isinstance(mesh.geometry(), coal.BVHModelBase)


def test_a_mesh_that_is_missing_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidGeometry, match=r"no mesh .*cube\.stl"):
        Mesh.read(tmp_path / "cube.stl")


@pytest.mark.parametrize("text", ["", "solid nothing\nendsolid nothing\n", "not a mesh at all"])
def test_a_file_without_a_mesh_is_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "empty.stl"
    path.write_text(text)
    with pytest.raises(InvalidGeometry):
        Mesh.read(path)


def test_a_mesh_with_a_hole_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidGeometry, match="not closed: 3 of its"):
        Mesh.read(write(tmp_path / "open.obj", CORNERS, CUBE[:-1]))


def test_a_mesh_in_millimetres_is_warned_of(tmp_path: Path) -> None:
    path = write(tmp_path / "large.obj", 300.0 * CORNERS, CUBE)
    with pytest.warns(MeshSize, match=r"300 m large.*scale=0\.001"):
        Mesh.read(path)


@pytest.mark.parametrize(
    ("vertices", "triangles"),
    [
        (np.empty((0, 3)), None),
        (np.full((4, 3), np.nan), None),
        (CORNERS[:3], None),
        (np.ones((6, 3)) * np.arange(6)[:, None] * [1.0, 1.0, 0.0], None),
        (CORNERS, np.empty((0, 3), dtype=int)),
        (CORNERS, np.array([[0, 1, 9]])),
        (CORNERS, CUBE.astype(float)),
    ],
)
def test_arrays_that_are_no_mesh_are_refused(vertices: np.ndarray, triangles: np.ndarray | None) -> None:
    with pytest.raises(InvalidGeometry):
        Mesh(vertices, triangles)


def test_a_file_given_for_vertices_is_told_how_to_read_it() -> None:
    with pytest.raises(InvalidGeometry, match=r"to read a file use Mesh\.read\('b\.stl'\)"):
        Mesh("b.stl")  # type: ignore[arg-type]


@pytest.mark.parametrize("path", [3, None, {"file": "a.stl"}, "a\0b.stl", "~nobody-of-that-name/a.stl", ""])
def test_what_is_no_path_of_a_mesh_is_refused(path: object) -> None:
    with pytest.raises(InvalidGeometry, match="mesh"):
        Mesh.read(path)  # type: ignore[arg-type]


@pytest.mark.parametrize("scale", [0.0, -1.0, np.nan, np.inf, "0.001", None, [1.0, 1.0, 1.0], True])
def test_what_is_no_scale_of_a_mesh_is_refused(tmp_path: Path, scale: object) -> None:
    with pytest.raises(InvalidGeometry, match="scale"):
        Mesh.read(write(tmp_path / "cube.obj", CORNERS, CUBE), scale)  # type: ignore[arg-type]


@pytest.mark.parametrize("size", [1e-9, 1e-3, 1.0])
@pytest.mark.parametrize("thickness", [0.0, 1e-15, 1e-12, 1e-10, 1e-9, 1e-6])
def test_points_that_are_nearly_flat_are_a_hull_or_an_error(size: float, thickness: float) -> None:
    for seed in range(20):
        rng = np.random.default_rng(seed)
        points = size * rng.standard_normal((30, 3)) * [1.0, 1.0, thickness] @ np.linalg.qr(rng.random((3, 3)))[0]
        points = points[rng.integers(0, 30, 30)] + rng.choice([0.0, size, 1e4 * size])
        try:
            assert Mesh(points).geometry().num_points >= 4
        except InvalidGeometry as error:
            assert "in one plane" in str(error)


def test_a_hull_encloses_its_points_and_its_faces_look_outward() -> None:
    points = np.random.default_rng(0).standard_normal((300, 3)) * [0.3, 0.1, 0.05] + [5.0, -3.0, 1.0]
    hull = Mesh(points).hull
    a, b, c = (np.array(hull.points())[triangles_of(hull)[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    assert (points @ normals.T - (normals * a).sum(axis=1)).max() <= 1e-12
    assert hull.computeVolume() > 0.0


@pytest.mark.parametrize("width", [1e-3, 0.05, 0.3])
def test_a_solid_with_a_small_hole_is_not_its_hull(width: float) -> None:
    dented = np.concatenate([CORNERS, [[0.5 - width, 0.5, 1.0], [0.5, 0.5 - width, 1.0], [0.5 + width, 0.5, 1.0]]])
    dented = np.concatenate([dented, [[0.5, 0.5 + width, 1.0], [0.5, 0.5, 0.5]]])
    rim = [(1, 5, 9), (5, 10, 9), (5, 7, 10), (7, 11, 10), (7, 3, 11), (3, 8, 11), (3, 1, 8), (1, 9, 8)]
    hole = [(8, 9, 12), (9, 10, 12), (10, 11, 12), (11, 8, 12)]
    sides = [face for face in CUBE.tolist() if not set(face) <= {1, 3, 5, 7}]
    assert not Mesh(dented, np.array(sides + rim + hole)).convex
    assert Mesh(dented[:-1], np.array(sides + rim + [(8, 9, 10), (8, 10, 11)])).convex
