import numpy as np
import pytest
import shapely

from pin_metaik.errors import InvalidGeometry
from pin_metaik.mobile import NoPath, PathProblem, Scene, grid_of, load_scene, plan_path, read_grid

YAML = """# made by map_server
image: map.pgm   # next to it
resolution: 0.5
origin: [-1.0, 2.0, {yaw}]
negate: {negate}
occupied_thresh: 0.65
free_thresh: 0.196
"""


def area(polygons) -> float:
    return shapely.union_all(polygons).area


def write_map(folder, pixels, *, yaw=0.0, negate=0, plain=False):
    pixels = np.asarray(pixels, dtype=np.uint8)
    rows, columns = pixels.shape
    header = f"{'P2' if plain else 'P5'}\n# a comment\n{columns} {rows}\n255\n".encode()
    body = " ".join(map(str, pixels.ravel())).encode() if plain else pixels.tobytes()
    (folder / "map.pgm").write_bytes(header + body)
    (folder / "map.yaml").write_text(YAML.format(yaw=yaw, negate=negate))
    return folder / "map.yaml"


def test_occupied_cells_become_as_few_polygons_as_possible():
    grid = grid_of([[1, 1, 0, 0], [1, 1, 0, 1], [0, 0, 0, 1]], resolution=2.0, origin=(10.0, 20.0, 0.0))
    assert len(grid.polygons) == 2
    assert area(grid.polygons) == pytest.approx(4 * 6)
    assert shapely.union_all(grid.polygons).equals(shapely.box(10, 20, 14, 24) | shapely.box(16, 22, 18, 26))
    assert grid.bounds == (10, 20, 18, 26)


def test_random_grids_keep_their_area_and_their_cells():
    occupied = np.random.default_rng(0).random((30, 40)) < 0.4
    region = shapely.union_all(grid_of(occupied).polygons)
    rows, columns = np.mgrid[:30, :40]
    centres = shapely.points(columns + 0.5, rows + 0.5)
    assert np.array_equal(shapely.contains(region, centres), occupied)
    assert region.area == pytest.approx(occupied.sum(), abs=0.01)


def test_there_is_no_way_between_cells_that_touch_at_a_corner():
    grid = grid_of([[0, 1], [1, 0]])
    scene = Scene((0.5, 0.5), (1.5, 1.5), grid.polygons, grid.bounds)
    with pytest.raises(NoPath):
        plan_path(scene)


def test_unknown_cells_block_unless_told_otherwise():
    cells = [[-1, 0, 100], [0, 30, 0]]
    assert area(grid_of(cells, threshold=65).polygons) == pytest.approx(2)
    assert area(grid_of(cells, threshold=65, unknown_blocks=False).polygons) == pytest.approx(1)
    assert area(grid_of([[np.nan, 0.0]]).polygons) == pytest.approx(1)


@pytest.mark.parametrize("plain", [True, False])
@pytest.mark.parametrize("negate", [0, 1])
def test_a_ros_map_is_read_upside_down_as_it_is_meant(tmp_path, plain, negate):
    pixels = np.array([[0, 254, 254], [254, 254, 205]])  # occupied, free, unknown
    path = write_map(tmp_path, 255 - pixels if negate else pixels, negate=negate, plain=plain)
    known = read_grid(path, unknown_blocks=False)
    assert shapely.union_all(known.polygons).equals(shapely.box(-1, 2.5, -0.5, 3))
    careful = read_grid(path)
    assert shapely.union_all(careful.polygons).contains(shapely.Point(0.25, 2.25))
    assert known.bounds == (-1, 2, 0.5, 3)


def test_the_origin_may_be_a_list_below_its_key(tmp_path):
    path = write_map(tmp_path, np.full((2, 2), 254))
    path.write_text(path.read_text().replace("[-1.0, 2.0, 0.0]", "\n- -1.0\n- 2.0\n- 0.0") + "mode: trinary\n")
    assert read_grid(path).bounds == (-1, 2, 0, 3)


def test_a_turned_map_blocks_what_lies_beyond_its_sheet(tmp_path):
    path = write_map(tmp_path, np.full((4, 4), 254), yaw=np.pi / 4)
    grid = read_grid(path)
    x_min, y_min, x_max, y_max = grid.bounds
    assert area(grid.polygons) == pytest.approx((x_max - x_min) * (y_max - y_min) - 4)
    assert not shapely.union_all(grid.polygons).contains(shapely.Point(-1, 2 + np.sqrt(2)))


def test_a_map_is_a_scene_once_start_and_goal_are_given(tmp_path):
    cells = np.zeros((20, 20), dtype=np.uint8)
    cells[5:15, 9:11] = 1
    np.save(tmp_path / "grid.npy", cells)
    scene = load_scene(tmp_path / "grid.npy", (2.5, 10.5), (17.5, 10.5))
    plan = plan_path(PathProblem.of(scene, radius=0.5))
    assert plan.clearance == pytest.approx(0.5, abs=1e-9)
    with pytest.raises(InvalidGeometry, match=r"where the start is: give start=\(x, y\)"):
        load_scene(tmp_path / "grid.npy")


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("map.yaml", b"image: map.pgm\nresolution: 1\n", "has no origin, negate"),
        ("map.yaml", YAML.format(yaw=0, negate=0).encode() + b"mode: rough\n", "rough"),
        ("map.yaml", YAML.format(yaw=0, negate=0).replace("0.5", "half").encode(), "not an occupancy grid"),
        ("map.yaml", YAML.format(yaw=0, negate=0).replace("map.pgm", "gone.pgm").encode(), "cannot read .*gone.pgm"),
        ("map.yaml", YAML.format(yaw=0, negate=0).replace("-1.0, ", "").encode(), "not an occupancy grid"),
        ("grid.npy", b"nothing", "not an occupancy grid"),
        ("map.png", b"", "is a .npy file or the .yaml"),
        ("gone.npy", None, "cannot read"),
    ],
)
def test_what_is_no_grid_is_refused_by_name(tmp_path, name, content, said):
    write_map(tmp_path, [[0]])
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(InvalidGeometry, match=said):
        read_grid(tmp_path / name)


@pytest.mark.parametrize("content", [b"P6 1 1 255 0", b"P5 9 9 255 0", b"P5\n# only a comment"])
def test_what_is_no_pgm_image_is_refused(tmp_path, content):
    path = write_map(tmp_path, [[0]])
    (tmp_path / "map.pgm").write_bytes(content)
    with pytest.raises(InvalidGeometry, match=r"not a PGM image|ends early"):
        read_grid(path)


@pytest.mark.parametrize("values", [[1, 2], [[]], [["a"]]])
def test_what_is_no_table_of_numbers_is_no_grid(values):
    with pytest.raises(InvalidGeometry):
        grid_of(values)


def test_cells_need_a_width():
    with pytest.raises(InvalidGeometry, match="wider than 0"):
        grid_of([[1]], resolution=0.0)
