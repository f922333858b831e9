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
    with pytest.raises(MetaIKError):
        load_scene(path)


def test_a_scene_that_is_missing_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidGeometry, match="cannot read"):
        load_scene(tmp_path / "scene.toml")
