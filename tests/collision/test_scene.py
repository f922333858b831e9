import json
import tomllib
from pathlib import Path

import pytest

from pin_metaik.collision import Box, load_scene, scene_names
from pin_metaik.errors import InvalidGeometry, MetaIKError, UnknownName

SCENE = """
[[obstacle]]
name = "box"
shape = "box"
size = [0.1, 0.2, 0.3]
position = [1.0, 2.0, 3.0]
rpy = [0.0, 0.0, 1.5707963267948966]
touching = ["base_link"]
"""


@pytest.mark.parametrize("name", scene_names())
def test_every_scene_of_the_package_loads(name: str) -> None:
    assert len(load_scene(name)) >= 3


def test_a_scene_is_read_as_written(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    (box,) = load_scene(path)
    assert (box.name, box.shape, box.touching) == ("box", Box((0.1, 0.2, 0.3)), ("base_link",))
    assert box.pose.translation.tolist() == [1.0, 2.0, 3.0]
    assert box.pose.rotation[1, 0] == pytest.approx(1.0)


def test_an_unknown_scene_is_told_with_those_known() -> None:
    with pytest.raises(UnknownName, match="known: narrow_box, shelf, table"):
        load_scene("kitchen")


@pytest.mark.parametrize(
    "text",
    [
        "obstacle = 3",
        "[[obstacle]",
        '[[obstacle]]\nname = "a"',
        '[[obstacle]]\nname = "a"\nshape = "torus"',
        '[[obstacle]]\nname = "a"\nshape = "box"',
        '[[obstacle]]\nname = "a"\nshape = "box"\nradius = 1.0',
        '[[obstacle]]\nname = "a"\nshape = "sphere"\nradius = -1.0',
        '[[obstacle]]\nname = "a"\nshape = "sphere"\nradius = 1.0\nposition = [nan, 0.0, 0.0]',
        '[[obstacle]]\nname = "a"\nshape = "sphere"\nradius = 1.0\nrpy = [0.0, 0.0]',
        '[[obstacle]]\nname = "a"\nshape = "mesh"\nfile = "missing.stl"',
        '[[obstacle]]\nname = "a"\nshape = "mesh"',
    ],
)
def test_scenes_that_make_no_sense_are_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(text)
    with pytest.raises(MetaIKError, match=r"scene\.toml"):
        load_scene(path)


def test_a_scene_that_is_missing_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidGeometry, match="cannot read"):
        load_scene(tmp_path / "scene.toml")


def test_a_scene_in_json_is_the_same(tmp_path: Path) -> None:
    (tmp_path / "scene.toml").write_text(SCENE)
    (tmp_path / "scene.json").write_text(json.dumps(tomllib.loads(SCENE)))
    (one,), (other,) = load_scene(tmp_path / "scene.toml"), load_scene(tmp_path / "scene.json")
    assert (one.name, one.shape, one.pose, one.touching) == (other.name, other.shape, other.pose, other.touching)


@pytest.mark.parametrize(
    ("wrong", "right", "message"),
    [
        ("touching", "touchin", r"obstacle 1, 'box', a box, named 'touchin'; did you mean 'touching'\?"),
        ("size", "sise", r"obstacle 1, 'box', a box, named 'sise'; did you mean 'size'\?"),
        ("rpy", "rpi", r"named 'rpi'; did you mean 'rpy'\?"),
        ("size =", "size = [1, 1, 1]\nscale =", "named 'scale'"),
        ("[[obstacle]]", "units = 'mm'\n[[obstacle]]", r"no key of .*scene\.toml named 'units'"),
        ('"box"\nsize', '"bocks"\nsize', "no shape of .*, named 'bocks'; did you mean 'box'"),
        ("[0.1, 0.2, 0.3]", "[0.1, 0.2]", "size of a box is three lengths"),
        ("[0.1, 0.2, 0.3]", "'large'", "size of a box is three lengths"),
        ("[0.1, 0.2, 0.3]", "[0.1, 0.2, nan]", "size of a box is three lengths"),
        ("size = [0.1, 0.2, 0.3]", "", "a box needs size"),
        ("[1.0, 2.0, 3.0]", "['1', 2.0, 3.0]", "position is three numbers"),
        ("[1.0, 2.0, 3.0]", "[true, 2.0, 3.0]", "position is three numbers"),
        ('["base_link"]', '"base_link"', "touching of 'box' is a list of names"),
        ('["base_link"]', "[1]", "touching of 'box' is a list of names"),
        ('name = "box"', "name = 3", "its name is a text"),
    ],
)
def test_what_a_scene_says_wrong_is_named(tmp_path: Path, wrong: str, right: str, message: str) -> None:
    assert wrong in SCENE
    path = tmp_path / "scene.toml"
    path.write_text(SCENE.replace(wrong, right, 1))
    with pytest.raises(MetaIKError, match=message):
        load_scene(path)


@pytest.mark.parametrize(
    "text", ["[]", "3", "{", '{"obstacle": []', '{"obstacle": [], "obstacle": []}', '{"obstacle": [3]}', "[" * 100_000]
)
def test_json_that_is_no_scene_is_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "scene.json"
    path.write_text(text)
    with pytest.raises(InvalidGeometry, match=r"scene\.json"):
        load_scene(path)


@pytest.mark.parametrize(
    "source", [3, None, ["shelf"], {"obstacle": []}, Path("scene.yaml"), "~nobody-so/a.toml", "a\0.toml"]
)
def test_what_is_no_file_of_a_scene_is_refused(source: object) -> None:
    with pytest.raises(InvalidGeometry, match=r"scene|toml"):
        load_scene(source)  # type: ignore[arg-type]
