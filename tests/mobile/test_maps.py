"""ROS maps as people have them: nav2's rule cell by cell, YAML as YAML, unknown cells as asked, large ones too."""

from fractions import Fraction
from itertools import product

import numpy as np
import pytest
import shapely
from numpy.testing import assert_array_equal
from PIL import Image
from scipy import ndimage
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from pin_metaik.errors import InvalidGeometry, InvalidSetting
from pin_metaik.mobile import NoPath, PathProblem, Scene, grid_of, load_scene, plan_path, read_grid
from pin_metaik.mobile.world.ros_maps import read_ros_map

GIVEN = {
    "image": "map.png",
    "resolution": "0.05",
    "origin": "[-1.0, 2.0, 0.0]",
    "negate": "0",
    "occupied_thresh": "0.65",
    "free_thresh": "0.196",
}
FORMS = {"grey": "L", "grey_alpha": "LA", "rgb": "RGB", "rgba": "RGBA"}


def written(folder, pixels=((0, 205, 254),), **changed):
    """A map of grey pixels and its YAML, with some values changed; None leaves a key out."""
    Image.fromarray(np.array(pixels, dtype=np.uint8)).save(folder / "map.png")
    pairs = {**GIVEN, **changed}
    text = "".join(f"{key}: {value}\n" for key, value in pairs.items() if value is not None)
    (folder / "map.yaml").write_text(text)
    return folder / "map.yaml"


def map_io(channels, alpha, mode, negate, occupied, free):
    """A cell by the rule of nav2's map server (nav2_map_server/src/map_io.cpp, loadMapFromFile).

    Args:
        channels: Red, green and blue, 0 to 255.
        alpha: 0, transparent, to 255; None if the image has no such channel.
        mode: trinary, scale or raw.
        negate: Whether white is occupied.
        occupied: Threshold, as written.
        free: Threshold, as written.
    """
    averaged = [*channels, alpha] if mode == "trinary" and alpha is not None else channels
    shade = Fraction(sum(averaged), 255 * len(averaged))
    if mode == "raw":
        value = int(255 * shade + Fraction(1, 2))  # std::round of what is not negative
        return value if value <= 100 else -1
    darkness = shade if negate else 1 - shade
    occupied, free = Fraction(occupied), Fraction(free)
    if mode == "scale" and alpha not in (None, 255):
        return -1
    if darkness > occupied:
        return 100
    if darkness < free:
        return 0
    return -1 if mode == "trinary" else round(100 * (darkness - free) / (occupied - free))  # std::rint


@pytest.mark.parametrize(("mode", "negate"), [*product(("trinary", "scale", "raw"), ("false", "true"))])
@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("thresholds", [("0.65", "0.196"), ("0.5", "0.1")])
def test_every_cell_is_what_nav2s_map_server_makes_of_it(tmp_path, form, mode, negate, thresholds):
    rng = np.random.default_rng(0)
    greys = rng.choice([0, 1, 49, 50, 51, 90, 100, 101, 127, 128, 204, 205, 206, 254, 255], (12, 15, 1))
    colours = (greys + rng.integers(-9, 10, (12, 15, 3))).clip(0, 255) if "rgb" in form else greys
    opacity = rng.choice([0, 100, 254, 255], (12, 15, 1), p=[0.1, 0.1, 0.1, 0.7])
    pixels = np.dstack((colours, opacity)) if form in ("grey_alpha", "rgba") else colours
    image = Image.fromarray(pixels.squeeze().astype(np.uint8))
    assert image.mode == FORMS[form]
    path = written(tmp_path, mode=mode, negate=negate, occupied_thresh=thresholds[0], free_thresh=thresholds[1])
    image.save(tmp_path / "map.png")

    has_alpha = pixels.shape[2] in (2, 4)
    expected = np.array(
        [
            [
                map_io(
                    [int(c) for c in np.broadcast_to(colours[row, column], 3)],
                    int(opacity[row, column, 0]) if has_alpha else None,
                    mode,
                    negate == "true",
                    *thresholds,
                )
                for column in range(15)
            ]
            for row in reversed(range(12))  # row 0 of a map is the lowest
        ]
    )
    assert_array_equal(read_ros_map(path).cells, expected)
    assert_array_equal(read_grid(path, unknown="free").occupied, expected == 100)
    assert_array_equal(read_grid(path, unknown="blocked").occupied, (expected == 100) | (expected == -1))
    assert len(np.unique(expected)) >= 3


@pytest.mark.parametrize("threshold", [0, 40, 65.5])
def test_cells_above_a_threshold_of_ones_own_are_occupied(tmp_path, threshold):
    pixels = np.arange(256, dtype=np.uint8).reshape(16, 16)
    path = written(tmp_path, pixels, mode="scale", free_thresh="0.1", occupied_thresh="0.9")
    percents = read_ros_map(path).cells
    assert_array_equal(read_grid(path, threshold=threshold).occupied, percents > threshold)


# --- YAML ---

FREE = ("false", "False", "FALSE", "no", "No", "off", "0", '"0"', "'false'", '"no"')
DARK = ("true", "True", "yes", "on", "1", '"1"', "'True'")


@pytest.mark.parametrize(("negate", "occupied"), [*((word, 0) for word in FREE), *((word, 2) for word in DARK)])
def test_negate_is_a_boolean_or_a_number_quoted_or_not(tmp_path, negate, occupied):
    cells = read_ros_map(written(tmp_path, [[0, 205, 254]], negate=negate, occupied_thresh="0.85")).cells
    assert np.flatnonzero(cells[0] == 100).tolist() == [occupied]


FLOW = "{image: map.png, resolution: 0.05, origin: [-1, 2, 0], negate: no, occupied_thresh: .65, free_thresh: .196}"
ANCHORS = """%YAML 1.1
---
image: &name map.png
resolution: &width 5e-2
origin:
- -1.0     # x
- 2        # y
- 0.0
negate: false
occupied_thresh: .65
free_thresh: 1.96e-1
"""
MERGED = """# of two halves
image: >-
  map.png
<<: {resolution: 0.05, origin: [-1.0,
  2.0,
  0.0], negate: 0}
occupied_thresh: "0.65"
free_thresh: '0.196'
mode: Trinary
"""
BLOCK = "".join(f"{key}:    {value}   # a comment\r\n" for key, value in GIVEN.items())


@pytest.mark.parametrize("text", [FLOW, ANCHORS, MERGED, BLOCK, "\ufeff" + BLOCK, f"---\n{BLOCK}...\n"])
def test_yaml_is_read_as_yaml(tmp_path, text):
    path = written(tmp_path)
    expected = read_ros_map(path)
    path.write_bytes(text.encode())
    found = read_ros_map(path)
    assert_array_equal(found.cells, expected.cells)
    assert (found.resolution, found.origin) == (0.05, (-1.0, 2.0, 0.0))


def test_the_image_is_beside_its_yaml_wherever_one_is(tmp_path, monkeypatch):
    folder = tmp_path / "maps" / "site"
    folder.mkdir(parents=True)
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    path = written(folder)
    expected = read_ros_map(path).cells
    for name, target in (("../up.png", tmp_path / "maps" / "up.png"), ("a b.png", folder / "a b.png")):
        (folder / "map.png").replace(target)
        path.write_text(path.read_text().replace("map.png", name))
        assert_array_equal(read_ros_map(path).cells, expected)
        target.replace(folder / "map.png")
        path = written(folder)
    path.write_text(path.read_text().replace("map.png", f'"{folder / "map.png"}"'))
    assert_array_equal(read_ros_map(path).cells, expected)
    monkeypatch.chdir(folder)
    assert_array_equal(read_grid("map.yaml").occupied, (expected == 100) | (expected == -1))


@pytest.mark.parametrize("key", GIVEN)
def test_a_key_that_is_missing_is_named(tmp_path, key):
    with pytest.raises(InvalidGeometry, match=f"has no {key}"):
        read_grid(written(tmp_path, **{key: None}))


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"origin": "[1, 2]"}, r"origin \(x, y, yaw\) must be 3 numbers, not \[1, 2\]"),
        ({"origin": "[1, 2, .nan]"}, r"origin \(x, y, yaw\) must be finite"),
        ({"origin": "1 2 3"}, r"origin \(x, y, yaw\) must be 3 numbers"),
        ({"origin": "[[1, 2], 3, 4]"}, r"origin \(x, y, yaw\) must be 3 numbers"),
        ({"resolution": "wide"}, "resolution must be a number, not 'wide'"),
        ({"resolution": "0"}, "resolution must be above 0 m"),
        ({"resolution": "-0.05"}, "resolution must be above 0 m"),
        ({"resolution": ".inf"}, "resolution must be finite"),
        ({"resolution": "true"}, "resolution must be a number, not True"),
        ({"negate": "maybe"}, "negate must be true, false, 1 or 0, not 'maybe'"),
        ({"negate": "2"}, "negate must be true, false, 1 or 0, not 2"),
        ({"negate": ""}, "negate must be true, false, 1 or 0, not None"),
        ({"negate": "[0]"}, "negate must be true, false, 1 or 0"),
        ({"mode": "binary"}, "mode must be one of trinary, scale, raw, not 'binary'"),
        ({"mode": ""}, "mode must be one of trinary, scale, raw"),
        ({"occupied_thresh": "high"}, "occupied_thresh must be a number"),
        ({"free_thresh": "{}"}, "free_thresh must be a number"),
        ({"image": ""}, "image must be the name of a file"),
        ({"image": "[map.png]"}, "image must be the name of a file"),
        ({"image": "gone.png"}, "cannot read .*gone.png"),
        ({"image": "."}, "cannot read"),
        ({"mod": "scale"}, "unknown key 'mod'; did you mean 'mode'"),
        ({"colour": "red"}, "unknown key 'colour'; known: image, resolution"),
    ],
)
def test_what_is_wrong_in_the_yaml_is_named_with_its_key(tmp_path, changed, said):
    path = written(tmp_path, **changed)
    with pytest.raises(InvalidGeometry, match=said):
        read_grid(path)


@pytest.mark.parametrize("text", ["", "- a\n- b\n", "map.png", "a: [", "a:\n\t- b", "a: *b", "a: !!python/none x"])
def test_what_is_no_yaml_of_a_map_is_named(tmp_path, text):
    (tmp_path / "map.yaml").write_text(text)
    with pytest.raises(InvalidGeometry, match=r"map\.yaml is not"):
        read_grid(tmp_path / "map.yaml")


# --- unknown cells, noise, size ---


@pytest.mark.parametrize("suffix", [".yaml", ".npy"])
def test_unknown_cells_are_as_the_reader_asks(tmp_path, suffix):
    """A wall with a door that nobody has looked through."""
    cells = np.zeros((9, 9), dtype=int)
    cells[:, 4], cells[6, 4] = 100, -1
    pixels = np.select([cells == 100, cells == 0], [0, 254], 205)[::-1]
    path = written(tmp_path, pixels, resolution="1", origin="[0, 0, 0]")
    if suffix == ".npy":
        path = tmp_path / "map.npy"
        np.save(path, cells)
    ends = ((1.5, 1.5), (7.5, 1.5))
    through = plan_path(load_scene(path, *ends, unknown="free"))
    assert through.length == pytest.approx(2 * np.hypot(2.5, 4.5) + 1)
    for scene in (load_scene(path, *ends, unknown="blocked"), load_scene(path, *ends)):
        with pytest.raises(NoPath):
            plan_path(scene)
    with pytest.raises(InvalidSetting, match=r"unknown must be one of 'blocked', 'free'"):
        load_scene(path, *ends, unknown="maybe")


def test_what_is_said_of_grids_is_refused_where_none_is():
    for option in ({"unknown": "free"}, {"resolution": 0.1}, {"threshold": 0.0}, {"specks": 2}):
        with pytest.raises(InvalidSetting, match=rf"{next(iter(option))}: only for an occupancy grid \(.npy, .yaml"):
            load_scene("ten_obstacles", **option)


def test_groups_of_few_cells_are_noise_if_one_says_so():
    cells = np.zeros((8, 8), dtype=int)
    cells[1, 1] = cells[4, 4] = cells[5, 5] = cells[4, 6] = 1  # alone; three that meet at corners
    grid = grid_of(cells)
    assert [int(grid.without_specks(n).occupied.sum()) for n in (1, 2, 3, 4)] == [4, 3, 3, 0]


def shortest_by_cells(occupied: np.ndarray, start: tuple[int, int], goal: tuple[int, int]) -> float:
    """Length, in cells, of the shortest path from centre to centre in eight directions, past no occupied corner."""
    rows, columns = occupied.shape
    free, number = ~occupied, np.arange(occupied.size).reshape(occupied.shape)
    one, other, lengths = [], [], []
    for dr, dc in ((0, 1), (1, 0), (1, 1), (1, -1)):
        a = (slice(0, rows - dr), slice(max(0, -dc), columns - max(0, dc)))
        b = (slice(dr, rows), slice(max(0, dc), columns + min(0, dc)))
        may = free[a] & free[b]
        if dr and dc:
            may = may & free[a[0], b[1]] & free[b[0], a[1]]
        one.append(number[a][may])
        other.append(number[b][may])
        lengths.append(np.full(may.sum(), np.hypot(dr, dc)))
    i, j, length = map(np.concatenate, (one, other, lengths))
    graph = coo_array((length, (i, j)), shape=(occupied.size, occupied.size)).tocsr()
    return float(dijkstra(graph, directed=False, indices=number[start])[number[goal]])


def test_a_large_map_is_planned_through_as_well_as_its_cells_allow():
    """300 x 300 cells of rough country; of 2,000 x 2,000 ``benchmarks/mobile.py`` tells."""
    height = ndimage.gaussian_filter(np.random.default_rng(1).standard_normal((300, 300)), 6)
    occupied = height > np.quantile(height, 0.7)
    occupied[:30, :30] = occupied[-30:, -30:] = False
    grid = grid_of(occupied, resolution=0.05)
    region = shapely.union_all(grid.polygons)
    assert region.area == pytest.approx(0.05**2 * occupied.sum(), rel=1e-9)
    scene = Scene((0.525, 0.525), (14.475, 14.475), grid.polygons, grid.bounds)
    plan = plan_path(scene)
    assert not shapely.LineString(plan.path.points).intersects(region.buffer(-1e-6))
    by_cells = 0.05 * shortest_by_cells(occupied, (10, 10), (289, 289))
    assert plan.length <= by_cells <= 1.09 * plan.length  # eight directions are 8.2 % too long at most
    wide = plan_path(PathProblem.of(scene, 0.2))
    assert plan.length < wide.length
    assert wide.clearance >= 0.2 - 1e-9


@pytest.mark.parametrize(("x", "y", "yaw"), [(0, 0, 0.3), (-300, 40, -2.5), (5e5, 5e6, 1.2), (5e5, 5e6, 0)])
def test_turning_and_moving_a_map_changes_no_length(x, y, yaw):
    """Cells that touch along edges and in corners, 5 cm wide; the last in projected coordinates of the whole earth."""
    found = 0
    for seed in range(12):
        occupied = np.random.default_rng(seed).random((12, 12)) < 0.35
        occupied[:2, :2] = occupied[-2:, -2:] = False
        lengths = []
        for origin in ((0, 0, 0), (x, y, yaw)):
            grid = grid_of(occupied, resolution=0.05, origin=origin)
            turn = 0.05 * np.array([[np.cos(origin[2]), -np.sin(origin[2])], [np.sin(origin[2]), np.cos(origin[2])]])
            start, goal = (turn @ (end, end) + origin[:2] for end in (0.5, 11.5))
            try:
                lengths.append(plan_path(Scene(start, goal, grid.polygons, grid.bounds)).length)
            except NoPath:
                lengths.append(np.inf)
        found += lengths[0] < np.inf
        assert lengths[1] == pytest.approx(lengths[0], abs=1e-4), seed
    assert found >= 4
