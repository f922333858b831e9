from pathlib import Path

import coal
import numpy as np
import pytest

from pin_metaik.collision import Mesh, MeshSize
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
