"""What reads files takes odd ones, or says in one line what is wrong; and the worst that were found, one by one."""

from __future__ import annotations

import contextlib
import io
import json
import zipfile
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from apart import address_space, room
from fuzz import elsewhere, fuzz
from fuzz_readers import readers
from fuzz_seeds import DAE, MESHES, MESHES_MJCF, MJCF, OBJ, PLY, URDF, images

import pin_metaik as mik
from pin_metaik import collision, learn, mobile
from pin_metaik.cli.goals import read_goals
from pin_metaik.cli.reachable import read_targets
from pin_metaik.collision.scene import read_points
from pin_metaik.compare import read_results
from pin_metaik.compare.folder.manifest import Manifest
from pin_metaik.compare.folder.store import ROWS, Appender, read_rows
from pin_metaik.compare.trials.lookup import method_of
from pin_metaik.errors import (
    MOST,
    InvalidGeometry,
    InvalidModel,
    InvalidSetting,
    InvalidTable,
    InvalidTarget,
    MetaIKError,
)
from pin_metaik.gui.look.pieces import pieces_of
from pin_metaik.mobile.motion.trajectory import Phase, Trajectory, load_trajectory
from pin_metaik.mobile.world.images import read_image
from pin_metaik.stewart import read_mechanism, read_trajectory
from tests.compare.suites import SMALL

INPUTS = 25  # of each reader; hundreds of thousands in the benchmark


def test_odd_files_and_command_lines_lead_to_a_result_or_an_error_of_ours() -> None:
    with elsewhere():
        faults = {name: found for name, one in readers().items() if (found := fuzz(one, range(INPUTS)).faults)}
    assert not faults


@pytest.mark.parametrize("text", ["x" * 10**6, "\x1b[31mred\x1b[0m\nnext line", "\ud800", "ok"])
def test_a_message_is_one_line_that_terminals_take(text: str) -> None:
    error = MetaIKError(f"no robot named {text}")
    assert str(error).isprintable()
    assert len(str(error)) <= MOST
    assert str(error).startswith("no robot named")


@pytest.mark.parametrize(
    ("name", "content", "error", "says"),
    [
        ("s.json", "[" * 500 + "]" * 500, InvalidGeometry, "nested too deeply"),
        ("s.json", '{"obstacle": [{"name": "a", "shape": "box", "size": [1, 1, 1' + "0" * 400 + "]}]}", InvalidGeometry,
         "more than 308 digits"),
        ("s.toml", f"obstacle = 0x{'f' * 4000}", InvalidGeometry, "more than 308 digits"),
    ],
)  # fmt: skip
def test_values_that_nothing_can_be_done_with_are_refused_where_they_are_read(
    name: str, content: str, error: type[MetaIKError], says: str, tmp_path: Path
) -> None:
    (tmp_path / name).write_text(content)
    with pytest.raises(error, match=says):
        collision.load_scene(tmp_path / name)


def test_a_table_with_numbers_beyond_all_robots_is_refused(tmp_path: Path) -> None:
    text = mik.load_robot("rv7fl").source.read_text()
    number = next(line for line in text.splitlines() if line.strip().startswith("a = ") or "a = " in line)
    before, _, after = number.partition("a = ")
    huge = f"{before}a = 1e200{after[len(after.split(',')[0]) :]}"
    (tmp_path / "r.toml").write_text(text.replace(number, huge, 1))
    with pytest.raises(InvalidTable, match="is beyond 1e"):
        mik.load_robot(tmp_path / "r.toml")


@pytest.mark.parametrize("number", ["1e400", "-1e9999999", f"1e{'9' * 18}", f"1e{'9' * 55}"])
def test_a_decimal_that_no_float_holds_is_refused(number: str, tmp_path: Path) -> None:
    (tmp_path / "m.toml").write_text(f'name = "m"\nradius = {number}\n')
    with pytest.raises(InvalidTable, match="a number of more than 308 digits"):
        read_mechanism(tmp_path / "m.toml")


def test_aliases_that_stand_for_billions_of_values_are_refused_at_once(tmp_path: Path) -> None:
    lines = [f"{b}: &{b} [{', '.join([f'*{a}'] * 9)}]" for a, b in zip("abcdefgh", "bcdefghi", strict=True)]
    (tmp_path / "map.yaml").write_text("\n".join(["a: &a [x, x, x]", *lines, "image: *i"]))
    with pytest.raises(InvalidGeometry, match="aliases stand for too many values"):
        mobile.load_scene(tmp_path / "map.yaml", (0, 0), (1, 1))


def test_an_image_that_is_small_and_says_it_has_billions_of_pixels_is_refused(tmp_path: Path) -> None:
    from PIL import Image

    Image.new("1", (60_000, 1_000)).save(tmp_path / "map.png")
    (tmp_path / "map.yaml").write_text(
        json.dumps({"image": "map.png", "resolution": 0.1, "origin": [0, 0, 0], "negate": 0, "occupied_thresh": 0.65,
                    "free_thresh": 0.2})
    )  # fmt: skip
    assert (tmp_path / "map.png").stat().st_size < 100_000
    with pytest.raises(InvalidGeometry, match="60000 x 1000 pixels are too many"):
        mobile.load_scene(tmp_path / "map.yaml", (0, 0), (1, 1))


def test_arrays_that_are_damaged_or_unpack_to_gigabytes_are_refused(tmp_path: Path) -> None:
    with (
        zipfile.ZipFile(tmp_path / "bomb.npz", "w", zipfile.ZIP_DEFLATED) as archive,
        archive.open("w.npy", "w") as file,
    ):
        for _ in range(1_100):
            file.write(bytes(1 << 20))
    good = io.BytesIO()
    np.save(good, np.eye(3))
    for name in ("torn.npy", "torn.npz"):
        (tmp_path / name).write_bytes(good.getvalue()[:60])
    (tmp_path / "vast.npy").write_bytes(good.getvalue().replace(b"(3, 3)", b"(3, 10000000000000)"))
    with pytest.raises(InvalidSetting, match="unpacked it has more than 1,024 MiB"):
        learn.load_regressor(tmp_path / "bomb.npz")
    with pytest.raises(InvalidSetting, match="not a map"):
        mik.Reachability.load(tmp_path / "torn.npz")
    for name in ("torn.npy", "vast.npy"):
        with pytest.raises(InvalidGeometry, match=r"is not a \.npy file of points"):
            read_points(tmp_path / name)


def test_a_mesh_in_ply_is_read_as_its_like_in_obj_and_wrong_corners_do_not_end_the_process(tmp_path: Path) -> None:
    (tmp_path / "m.obj").write_bytes(OBJ)
    (tmp_path / "m.ply").write_bytes(PLY)
    header = PLY.partition(b"end_header\n")[0].replace(b"ascii", b"binary_big_endian") + b"end_header\n"
    vertices, triangles = np.vstack([np.zeros(3), np.eye(3)]), [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    rows = b"".join(b"\x03" + np.array(face, ">i4").tobytes() for face in triangles)
    (tmp_path / "b.ply").write_bytes(header + vertices.astype(">f4").tobytes() + rows)
    text, binary = collision.Mesh.read(tmp_path / "m.ply", 0.5), collision.Mesh.read(tmp_path / "b.ply", 0.5)
    for mesh in (text, binary):
        np.testing.assert_array_equal(mesh.vertices, 0.5 * vertices)
        np.testing.assert_array_equal(mesh.triangles, triangles)
    volume = coal_volume(collision.Mesh.read(tmp_path / "m.obj", 0.5))
    assert coal_volume(text) == pytest.approx(volume, abs=1e-12)
    (tmp_path / "m.ply").write_bytes(PLY.replace(b"3 1 2 3", b"3 1 2 9"))
    with pytest.raises(InvalidGeometry, match="indices outside its 4 vertices"):
        collision.Mesh.read(tmp_path / "m.ply")
    (tmp_path / "r.urdf").write_bytes(URDF.replace(b"m.obj", b"m.ply"))
    with pytest.raises(InvalidModel, match="indices outside its 4 vertices"):
        _ = mik.load_robot(tmp_path / "r.urdf").visual_model


@pytest.mark.parametrize(
    ("good", "odd", "says"),
    [
        (
            b"0 0 0\n1",
            b"0\x0c0 0\n1",
            "something else than numbers",
        ),  # where coal's reader ends a line
        (b"0 0 0\n1", b"0\x000 0\n1", "something else than numbers"),
        (b"end_header\n", b"end_header\x00\n", "header is not whole"),
        (b"end_header\n", b"comment end_header\n", "header is not whole"),
        (b"float x\n", b"float x\x0b\n", "header is not whole"),
        (b"float x\n", b"float x y\n", "header has a line 'property float x y'"),
        (b"3 1 2 3", b"3e0 1 2 3", "a whole number is not written as one"),
        (b"3 1 2 3", b"3 1 2 0_3", "something else than numbers"),
    ],
)
def test_what_coals_reader_understands_in_another_way_is_no_ply(
    good: bytes, odd: bytes, says: str, tmp_path: Path
) -> None:
    (tmp_path / "m.ply").write_bytes(PLY.replace(good, odd))
    with pytest.raises(InvalidGeometry, match=says):
        collision.Mesh.read(tmp_path / "m.ply")


def test_an_archive_of_arrays_holds_nothing_else(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "map.npz", "w") as archive:
        archive.writestr("status.npy", b"\0")
    with pytest.raises(InvalidSetting, match="'status' is no array"):
        mik.Reachability.load(tmp_path / "map.npz")


def test_mjcf_names_no_mesh_that_would_end_the_process(tmp_path: Path) -> None:
    (tmp_path / "meshes").mkdir()
    (tmp_path / "meshes" / "odd.ply").write_bytes(PLY.replace(b"3 1 2 3", b"3 1 2 9"))
    text = MESHES_MJCF.replace(b"<asset>", b'<compiler meshdir="meshes"/><asset>') % b"odd.ply"
    for content in (text, MESHES_MJCF % b"meshes/odd.ply"):
        (tmp_path / "r.xml").write_bytes(content)
        with pytest.raises(InvalidModel, match="indices outside its 4 vertices"):
            _ = mik.load_robot(tmp_path / "r.xml").visual_model
    (tmp_path / "r.xml").write_bytes(MESHES_MJCF.replace(b"<mujoco>", b'<mujoco model="a\xb3">') % b"")
    with pytest.raises(InvalidModel, match="is not MJCF that can be read"):
        mik.load_robot(tmp_path / "r.xml")


@pytest.mark.parametrize(
    ("good", "odd", "says"),
    [
        (b"<p>0 2 1", b"<p>0 2 x", "<p> has 'x' where a whole number stands"),
        (b"<p>0 2 1", b"<p>0 2 -1e308", "<p> has '-1e308' where a whole number stands"),
        (b'<triangles count="4"', b'<triangles count="4294967296"', "count of <triangles> is '4294967296'"),
        (b'stride="3"', b'stride="-3"', "stride of <accessor> is '-3'"),
        (b"</COLLADA>", b"", "no mesh in COLLADA: no element found"),
        (b"<node ", b"<node>" * 200 + b"<node ", "nested too deeply"),
    ],
)
def test_a_mesh_in_collada_that_would_never_end_is_refused(good: bytes, odd: bytes, says: str, tmp_path: Path) -> None:
    (tmp_path / "m.dae").write_bytes(DAE)
    (tmp_path / "m.obj").write_bytes(OBJ)
    mesh = collision.Mesh.read(tmp_path / "m.dae")
    assert coal_volume(mesh) == pytest.approx(coal_volume(collision.Mesh.read(tmp_path / "m.obj")), rel=1e-6)
    for name in ("m.dae", "m.other"):  # coal's reader knows it by its first element, too
        (tmp_path / name).write_bytes(DAE.replace(good, odd))
        with pytest.raises(InvalidGeometry, match=says):
            collision.Mesh.read(tmp_path / name)


def test_a_mesh_that_only_coal_can_read_is_drawn(tmp_path: Path) -> None:
    (tmp_path / "odd.obj").write_bytes(OBJ.replace(b"v 0 0 1", b"v 0< 0 1"))
    (tmp_path / "r.urdf").write_bytes(MESHES % b"odd.obj")
    (piece,) = pieces_of(mik.load_robot(tmp_path / "r.urdf"), "meshes")
    assert len(piece.triangles) >= 4


def coal_volume(mesh: collision.Mesh) -> float:
    a, b, c = (mesh.vertices[mesh.triangles[:, i]] for i in range(3))
    return float((np.cross(a, b) * c).sum() / 6.0)


def test_robots_whose_elements_or_names_no_parser_takes_are_refused(tmp_path: Path) -> None:
    (tmp_path / "r.urdf").write_bytes(URDF.replace(b"</robot>", b"<x>" * 500 + b"</x>" * 500 + b"</robot>"))
    with pytest.raises(InvalidModel, match="nested too deeply"):
        mik.load_robot(tmp_path / "r.urdf")
    (tmp_path / "r.urdf").write_bytes(URDF.replace(b'<parent link="base"/>', b'<parent link="arm"/>'))
    with pytest.raises(InvalidModel, match="joined in a circle, without a root: arm, hand, tool, tip"):
        mik.load_robot(tmp_path / "r.urdf")
    (tmp_path / "r.xml").write_bytes(MJCF.replace(b'class="c" size', b'class="other" size'))
    with pytest.raises(InvalidModel, match=r"is not MJCF that can be read|cannot be loaded"):
        _ = mik.load_robot(tmp_path / "r.xml").collision_model
    (tmp_path / "r.xml").write_bytes(MJCF.replace(b'<body name="b"', b'<body name="\xff"'))
    with pytest.raises(InvalidModel, match="is not MJCF that can be read"):
        mik.load_robot(tmp_path / "r.xml")


def test_geojson_that_holds_what_is_no_object_is_refused(tmp_path: Path) -> None:
    (tmp_path / "p.geojson").write_text('{"type": "FeatureCollection", "features": ["Feature"]}')
    with pytest.raises(InvalidGeometry, match="is GeoJSON of type 'Feature'"):
        mobile.load_scene(tmp_path / "p.geojson", (0, 0), (1, 1))


@pytest.mark.parametrize("content", [b"x,y,z\n\xff,1,2\n", b"1,2,inf\n", b'"' + b"x" * 200_000 + b'"\n'])
def test_tables_that_are_no_text_or_no_finite_numbers_are_refused(content: bytes, tmp_path: Path) -> None:
    (tmp_path / "t.csv").write_bytes(content)
    for read in (lambda path: read_targets(path, False), read_trajectory):
        with pytest.raises(InvalidTarget, match=r"t\.csv"):
            read(tmp_path / "t.csv")


def test_files_without_an_end_are_not_read_for_ever(tmp_path: Path) -> None:
    (tmp_path / "endless.urdf").symlink_to("/dev/zero")
    with pytest.raises(InvalidModel, match="it has more than 256 MiB"):
        mik.load_robot(tmp_path / "endless.urdf")


def test_an_image_has_no_more_bytes_than_there_are(tmp_path: Path) -> None:
    from PIL import Image

    Image.new("L", (4, 3)).save(tmp_path / "map.png")
    whole = (tmp_path / "map.png").read_bytes()
    at = whole.index(b"IDAT") - 4
    (tmp_path / "map.png").write_bytes(whole[:at] + b"\xff\xff\xff\xff" + whole[at + 4 :])
    with contextlib.suppress(InvalidGeometry), room(address_space() + (1 << 30)):
        read_image(tmp_path / "map.png")  # no MemoryError


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("goal = 3", "is a table with a kind"),
        ('[[goal]]\nkind = "posture"\njoints = {a = {b = 1}}', "joint 'a': expected numbers of shape"),
        ('[[goal]]\nkind = "posture"\njoints = {a = [[1, 2], [3]]}', "joint 'a': expected numbers of shape"),
        ('[[goal]]\nkind = "posture"\njoints = {a = "up"}', "joint 'a': expected numbers of shape"),
    ],
)
def test_goals_of_the_wrong_kind_are_refused(text: str, says: str, tmp_path: Path) -> None:
    (tmp_path / "g.toml").write_text(text)
    with pytest.raises(InvalidTarget, match=says):
        read_goals([], [], tmp_path / "g.toml")


def test_a_phase_lasts_no_less_than_nothing(tmp_path: Path) -> None:
    (tmp_path / "t.json").write_text('{"start": [0, 0, 0], "v": 1, "phases": [[-1e308, 0, 0, 0]]}')
    with pytest.raises(InvalidSetting, match="a phase lasts 0 s or longer"):
        load_trajectory(tmp_path / "t.json")


def test_motions_are_of_floats_whatever_they_are_written_as(tmp_path: Path) -> None:
    (tmp_path / "t.json").write_text(f'{{"start": [0, 0, 0], "v": {10**30}, "phases": [[{2**70}, 0, 0, 0]]}}')
    motion = load_trajectory(tmp_path / "t.json")
    assert motion.end == pytest.approx((2**70 * 1e30, 0.0, 0.0))
    whole = Trajectory([Phase(2**70, 0, 0, 1)], (0, 0, 0), 10**30)
    assert whole.at([0.0, 1.0]).table.dtype == whole.moved(np.zeros(1), np.ones(1)).travel.dtype == float


@pytest.mark.parametrize("name", [":sphere", ".a:b", "a..b:c", "\ud800:c"])
def test_what_is_no_name_of_a_module_is_refused(name: str) -> None:
    with pytest.raises(InvalidSetting, match="is not the name of a module"):
        method_of(name)


def test_a_damaged_map_in_parquet_is_refused(tmp_path: Path) -> None:
    robot = mik.load_robot("asr_twodof")
    mik.reachability(mik.Chain(robot, robot.frame), np.array([[0.1, 0.1, 0.1]])).save(tmp_path / "m.parquet")
    whole = (tmp_path / "m.parquet").read_bytes()
    for content in (whole[:-30], whole.replace(b"reachability", b"reachabilitx"), b"PAR1" + b"[" * 400):
        (tmp_path / "m.parquet").write_bytes(content)
        with pytest.raises(InvalidSetting, match=r"m\.parquet is not a map"):
            mik.Reachability.load(tmp_path / "m.parquet")


def test_an_image_whose_pixels_are_beyond_all_files_is_refused(tmp_path: Path) -> None:
    whole = images()[4]
    place = whole.index((273).to_bytes(2, "little") + b"\4\0")  # where its pixels are, in four bytes
    (tmp_path / "m.tif").write_bytes(whole[: place + 2] + b"\x10" + whole[place + 3 :])  # in eight
    with pytest.raises(InvalidGeometry, match="cannot be read as an image"):
        read_image(tmp_path / "m.tif")


def test_a_grid_beyond_all_numbers_is_refused(tmp_path: Path) -> None:
    np.save(tmp_path / "g.npy", np.eye(3))
    with pytest.raises(InvalidGeometry, match=r"an occupancy grid is within 1e\+100"):
        mobile.load_scene(tmp_path / "g.npy", (0, 0), (1, 1), resolution=1e300)


@pytest.mark.parametrize("path", ["../elsewhere/r.urdf", "/etc/passwd", 3])
def test_a_comparison_reads_robots_from_nowhere_but_its_folder(path: object) -> None:
    values = {**Manifest.from_suite(SMALL).to_json(), "files": {"ur5": path}}
    with pytest.raises(InvalidSetting, match="is kept in the folder"):
        Manifest.from_json(json.loads(json.dumps(values)))


@pytest.mark.parametrize("change", [{"robot": ["ur5"]}, {"evaluations": {}}, {"task": "one"}, {"x": 3}])
def test_a_row_with_values_of_another_kind_is_none(change: dict[str, object], tmp_path: Path) -> None:
    row = {"robot": "ur5", "case": "a", "method": "b", "task": 0, "seed": 0, "budget": 1, "solved": True, "met": True,
           "claimed": True, "status": "SOLVED", "error": None, "position_error": 0.0, "orientation_error": 0.0,
           "displacement": 0, "evaluations": 1, "x": [0, 1.5], "curve": None, "seconds": 0.1}  # fmt: skip
    (tmp_path / ROWS).write_text(json.dumps(row) + "\n")
    (trial,) = read_rows(tmp_path)
    assert trial.x == (0, 1.5)
    (tmp_path / ROWS).write_text(json.dumps({**row, **change}) + "\n")
    with pytest.raises(InvalidSetting, match=r"line 1 of .* is not a row"):
        read_rows(tmp_path)
    with pytest.raises(InvalidSetting, match="holds no comparison"):
        read_results(tmp_path)
    with Appender(tmp_path) as file:
        file.add([trial])
    assert (tmp_path / ROWS).read_bytes().count(b"\n") == 2


def test_joints_that_a_chain_does_not_move_stand_inside_their_limits() -> None:
    model = pin.Model()
    kinds = (pin.JointModelTranslation(), pin.JointModelSphericalZYX(), pin.JointModelFreeFlyer(), pin.JointModelRZ())
    for kind in kinds:  # all on the world: only the last one moves the tip
        joint = model.addJoint(0, kind, pin.SE3.Identity(), f"joint_{model.njoints}")
    model.lowerPositionLimit, model.upperPositionLimit = np.full(model.nq, 0.5), np.full(model.nq, 0.9)
    model.addFrame(pin.Frame("tip", joint, 0, pin.SE3(np.eye(3), np.array([0.3, 0.0, 0.0])), pin.FrameType.OP_FRAME))
    reference = mik.Chain(model, "tip").reference
    assert reference[:9].tolist() == [0.5] * 9  # two joints of three, and where the floating one is
    assert reference[9:13].tolist() == [0.0, 0.0, 0.0, 1.0]  # which way it points has no limits
    assert reference[13] == 0.5
