"""Files that people have: every key is read or named, and whatever a file holds ends in a scene or an error of ours."""

import io
import json
import warnings

import numpy as np
import pytest
import shapely
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from PIL import Image
from typer.testing import CliRunner

from pin_metaik import cli
from pin_metaik.errors import InvalidGeometry, InvalidSetting, MetaIKError, UnknownName
from pin_metaik.mobile import load_scene, load_vehicle, plan_path

SCENE = {
    "start": [0, 0],
    "goal": [5, 0],
    "obstacles": [[[2, -1], [3, -1], [3, 1.5], [2, 1.5]]],
    "bounds": [-1, -0.9, 6, 2],
}
FEATURES = {
    "type": "FeatureCollection",
    "features": [
        {"type": "Feature", "properties": {}, "geometry": json.loads(shapely.to_geojson(shapely.box(2, -1, 3, 1.5)))},
        {"type": "Feature", "properties": {}, "geometry": None},
    ],
}


def write(folder, content, name="scene.json"):
    (folder / name).write_text(content if isinstance(content, str) else json.dumps(content))
    return folder / name


def test_walls_are_walls_and_a_slip_of_the_pen_in_their_name_is_told(tmp_path):
    plan = plan_path(load_scene(write(tmp_path, SCENE)))
    assert plan.path.points[:, 1].min() >= -0.9
    slip = {("bound" if key == "bounds" else key): value for key, value in SCENE.items()}
    with pytest.raises(InvalidGeometry, match="unknown key 'bound'; did you mean 'bounds'"):
        load_scene(write(tmp_path, slip))


@pytest.mark.parametrize("key", ["robot_radius", "radius", "Start", "obstacle", "bbox", "colour", ""])
def test_any_key_that_nobody_would_read_is_named(tmp_path, key):
    with pytest.raises(InvalidGeometry, match=f"unknown key '{key}'; (did you mean|known: start, goal, obstacles)"):
        load_scene(write(tmp_path, {**SCENE, key: 1}))


def test_remarks_are_no_unknown_keys(tmp_path):
    scene = load_scene(write(tmp_path, {**SCENE, "name": "mine", "note": "by hand", "optimal_length": 1}))
    assert scene.name == "mine"


def test_geojson_may_have_members_of_its_own_but_no_slips_of_the_pen(tmp_path):
    own = {**FEATURES, "crs": {"type": "name"}, "bbox": [0, 0, 1, 1], "generator": "JOSM", "totalFeatures": 2}
    scene = load_scene(write(tmp_path, {**own, "start": [0, 0], "goal": [5, 0], "bounds": [-1, -0.9, 6, 2]}))
    assert (scene.bounds, len(scene.obstacles)) == ((-1, -0.9, 6, 2), 1)
    for slip in ("bound", "goals", "strat"):
        with pytest.raises(InvalidGeometry, match=f"unknown key '{slip}'; did you mean"):
            load_scene(write(tmp_path, {**own, slip: [0, 0]}), (0, 0), (5, 0))


@pytest.mark.parametrize("key", ["start", "goal"])
def test_ends_that_are_missing_are_told_for_python_and_for_the_command_line(tmp_path, key):
    path = write(tmp_path, {name: value for name, value in SCENE.items() if name != key})
    with pytest.raises(InvalidGeometry, match=rf"where the {key} is: give {key}=\(x, y\), on the command line --{key}"):
        load_scene(path)
    assert load_scene(path, **{key: (0.5, 0.5)})


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"start": "here"}, r"the start is a point \(x, y\), got 'here'"),
        ({"goal": [1]}, r"the goal is a point \(x, y\), got \[1\]"),
        ({"goal": {"x": 1, "z": 2}}, "the goal is a point"),
        ({"bounds": [0, 0, 1]}, "bounds are"),
        ({"bounds": [6, 2, -1, -1]}, "x_min < x_max"),
        ({"obstacles": 7}, "obstacles is 7: give vertices"),
        ({"obstacles": None}, "obstacles is None"),
        ({"obstacles": [[[0, 0], [1, 1]]]}, r"obstacles\[0\] is not a polygon: it takes at least three"),
        ({"obstacles": {"type": "Feature", "geometry": 3}}, "GeoJSON of type 3"),
    ],
)
def test_values_that_make_no_sense_are_named(tmp_path, changed, said):
    with pytest.raises(InvalidGeometry, match=said):
        load_scene(write(tmp_path, {**SCENE, **changed}))


@pytest.mark.parametrize("name", ["map.png", "map.pgm", "scene.toml", "scene.txt", "maps/site", "scene.json.bak"])
def test_a_file_of_no_known_kind_is_told_what_would_be(name):
    with pytest.raises(InvalidGeometry, match=rf"cannot read {name}: .*\.json.*\.geojson.*\.npy or the \.yaml"):
        load_scene(name, (0, 0), (1, 1))
    with pytest.raises(UnknownName, match=r"known: .*u_trap|did you mean 'u_trap'"):
        load_scene("u_trab")


def test_a_vehicle_has_no_unknown_keys_either(tmp_path):
    assert load_vehicle(write(tmp_path, {"v_max": 0.5}, "v.json")).v_max == 0.5
    for content, said in (
        ({"vmax": 0.5}, "unknown key 'vmax'; did you mean 'v_max'"),
        ({"v_max": "fast"}, "v_max must be a number"),
        ({"v_max": float("nan")}, "v_max must be finite"),
        ({"radius": -1}, "radius must be"),
        ([], "expected an object"),
    ):
        with pytest.raises(InvalidSetting, match=said):
            load_vehicle(write(tmp_path, content, "v.json"))


# --- the command line ---

MAP = b"{image: NAME, resolution: 1, origin: [0, 0, 0], negate: 0, occupied_thresh: 0.65, free_thresh: 0.2}"
BAD = {  # file: content
    "empty.json": b"",
    "null.json": b"null",
    "list.json": b"[1, 2]",
    "cut.json": b'{"start": [0, 0',
    "deep.json": b"[" * 100_000,
    "binary.json": b"\xff\xfe\x00",
    "key.json": json.dumps({**SCENE, "gaol": 1}).encode(),
    "nan.json": b'{"start": [0, 0], "goal": [9, 0], "obstacles": [[[NaN, 1], [2, 1], [2, 2]]]}',
    "crossed.json": b'{"start": [0, 0], "goal": [9, 0], "obstacles": [[[0, 0], [2, 2], [2, 0], [0, 2]]]}',
    "empty.geojson": b"{}",
    "circle.geojson": b'{"type": "Circle"}',
    "empty.wkt": b"",
    "curve.wkt": b"CIRCULARSTRING (0 0, 1 1, 2 0)",
    "cut.wkt": b"POLYGON ((0 0, 1 0",
    "empty.yaml": b"",
    "cut.yaml": b"image: [",
    "tab.yaml": b"image:\n\t- a",
    "object.yaml": b"!!python/object/apply:os.getcwd []",
    "gone.yaml": MAP.replace(b"NAME", b"gone.png"),
    "noise.yaml": MAP.replace(b"NAME", b"noise.png"),
    "noise.png": b"\x89PNG\r\n\x1a\nnoise",
    "empty.npy": b"",
    "cut.npy": b"\x93NUMPY\x01\x00",
    "header.npy": b"\x93NUMPY\x01\x00\x10\x00{'descr': ('''   ",
    "pickled.npy": b"\x80\x04K\x07.",
}


@pytest.fixture
def bad(tmp_path, monkeypatch):
    for name, content in BAD.items():
        (tmp_path / name).write_bytes(content)
    (tmp_path / "folder.json").mkdir()
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("name", [*BAD, "folder.json", "missing.json", "missing.yaml", "missing.wkt", ""])
def test_plan_with_a_bad_file_ends_in_one_line_that_names_it(bad, name, monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["pin-metaik", "plan", name, "--start", "0", "0", "--goal", "9", "0"])
    with pytest.raises(SystemExit) as end:
        cli.run()
    said = capsys.readouterr().err
    assert end.value.code == 2
    assert said.startswith("pin-metaik: ")
    assert said.count("\n") == 1
    assert name.partition(".")[0] in said or "obstacles[" in said


def test_plan_reads_grids_as_it_is_told(tmp_path):
    """A wall with a door that nobody has looked through, and a world with a speck in the way."""
    wall, speck = np.zeros((9, 9)), np.zeros((9, 9))
    wall[:, 4], wall[2, 4], speck[0, 4] = 50, -1, 1
    np.save(tmp_path / "wall.npy", wall)
    np.save(tmp_path / "speck.npy", speck)

    def plan(name, *options):
        ends = ("--start", "0.5", "0.25", "--goal", "4", "0.25", "--resolution", "0.5")
        done = CliRunner().invoke(cli.app, ["plan", str(tmp_path / name), *ends, "--json", *options])
        return json.loads(done.stdout)["path"]["length"] if done.exit_code == 0 else str(done.exception)

    assert "no path" in plan("wall.npy")
    assert plan("wall.npy", "--unknown", "free") == pytest.approx(2 * np.hypot(1.5, 0.75) + 0.5)
    assert plan("wall.npy", "--unknown", "free", "--threshold", "60") == pytest.approx(3.5)
    assert plan("speck.npy") == pytest.approx(2 * np.hypot(1.5, 0.25) + 0.5)
    assert plan("speck.npy", "--specks", "2") == pytest.approx(3.5)
    assert "unknown must be one of" in plan("wall.npy", "--unknown", "maybe")
    assert "which a random scene is not" in str(
        CliRunner().invoke(cli.app, ["plan", "random:1", "--specks", "2"]).exception
    )


def test_plan_takes_round_joins_where_mitred_ones_close_the_way(tmp_path):
    d = 0.6 / 2**0.5  # corners 0.60 m apart; a disc of radius 0.25 has 0.10 m to spare
    squares = [[(-3, -3), (0, -3), (0, 0), (-3, 0)], [(d, d), (3 + d, d), (3 + d, 3 + d), (d, 3 + d)]]
    scene = {"start": (-2, 2), "goal": (2, -2), "obstacles": squares, "bounds": (-3, -3, 3 + d, 3 + d)}
    done = CliRunner().invoke(cli.app, ["plan", str(write(tmp_path, scene)), "--radius", "0.25", "--json"])
    path = json.loads(done.stdout)["path"]
    assert (path["status"], path["join"]) == ("SHORTEST", "round")
    assert path["length"] == pytest.approx(5.6791, abs=1e-3)
    told = CliRunner().invoke(cli.app, ["plan", str(tmp_path / "scene.json"), "--radius", "0.25", "--join", "mitre"])
    assert "mitred corners of grown obstacles close every way" in str(told.exception)


# --- any bytes ---


def _seeds() -> dict[str, bytes]:
    grid, picture = io.BytesIO(), io.BytesIO()
    np.save(grid, np.eye(4))
    Image.fromarray(np.arange(63, dtype=np.uint8).reshape(7, 9)).save(picture, "PNG")
    yaml = "image: m.png\nresolution: 0.05\norigin: [-1, 2, 0.3]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.2\n"
    return {
        "m.yaml": yaml.encode(),
        "m.png": picture.getvalue(),
        "m.pgm": b"P2\n# c\n3 2\n255\n0 1 2\n3 4 255\n",
        "s.json": json.dumps(SCENE).encode(),
        "s.geojson": json.dumps(FEATURES).encode(),
        "s.wkt": b"POLYGON ((0 0, 2 0,\n 2 2, 0 0))\nPOINT (3 3)\nLINESTRING (5 5, 6 6)\n",
        "s.npy": grid.getvalue(),
    }


SEEDS = _seeds()
PIECES = [
    b"nan",
    b"inf",
    b"-1",
    b"1e999",
    b"null",
    b"[",
    b"}",
    b'"',
    b"99999999999",
    b"\xff",
    b"\0",
    b"*a",
    b": ",
    b"(",
]


@given(st.sampled_from(sorted(SEEDS)), st.data())
@settings(max_examples=250, deadline=None, derandomize=True, database=None, suppress_health_check=[*HealthCheck])
def test_whatever_bytes_a_file_holds_it_is_a_scene_or_an_error_of_ours(tmp_path_factory, name, data):
    folder = tmp_path_factory.getbasetemp() / "bytes"
    folder.mkdir(exist_ok=True)
    content = bytearray(SEEDS[name])
    for _ in range(data.draw(st.integers(1, 3))):
        at = data.draw(st.integers(0, len(content)))
        content[at : at + data.draw(st.integers(0, 9))] = data.draw(st.sampled_from(PIECES) | st.binary(max_size=3))
    (folder / name).write_bytes(content)
    opened = folder / name
    if name.endswith((".png", ".pgm")):
        opened = folder / "m.yaml"
        opened.write_bytes(SEEDS["m.yaml"].replace(b"m.png", name.encode()))
    elif name == "m.yaml":
        (folder / "m.png").write_bytes(SEEDS["m.png"])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            plan_path(load_scene(opened, (0, 0), (9, 9)))
        except MetaIKError as error:
            assert str(error)
