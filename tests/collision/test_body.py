from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import pin_metaik as mik
from pin_metaik.collision import body, simplify
from pin_metaik.collision.body import VisualGeometry, robot_bodies
from pin_metaik.errors import InvalidGeometry, InvalidModel
from tests.collision.test_mesh import CORNERS, CUBE, write
from tests.collision.worlds import robot_of

URDF = """<robot name="two"><link name="a">{a}</link><link name="b">{b}</link><link name="c">{a}</link>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="k" type="revolute"><origin xyz="0 0 5"/><parent link="b"/><child link="c"/><axis xyz="0 1 0"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"""
MESH = '<collision><geometry><mesh filename="{}"/></geometry></collision>'
BOX = '<collision><geometry><box size="{}"/></geometry></collision>'


def robot(folder: Path, a: str, b: str) -> mik.Robot:
    path = folder / "two.urdf"
    path.write_text(URDF.format(a=a, b=b))
    return mik.load_robot(path)


@pytest.mark.parametrize("bad", [np.nan, np.inf, 1e300])
def test_a_mesh_of_a_robot_that_is_not_finite_is_refused_by_its_link(tmp_path: Path, bad: float) -> None:
    corners = CORNERS.copy()
    corners[3, 1] = bad
    write(tmp_path / "bad.obj", corners, CUBE)
    with pytest.raises(InvalidGeometry, match=r"link 'b' of two has vertices that are not finite"):
        mik.CollisionWorld(robot(tmp_path, BOX.format("1 1 1"), MESH.format("bad.obj")))


@pytest.mark.parametrize("bad", ["-1", "nan", "inf", "-inf", "1e400"])
def test_a_size_of_a_robot_that_is_none_is_refused_by_its_link(tmp_path: Path, bad: str) -> None:
    ball, tube = '<sphere radius="{}"/>', '<cylinder radius="{}" length="1"/>'
    for shape in (
        BOX.format(f"1 {bad} 1"),
        *(BOX.replace('<box size="{}"/>', one).format(bad) for one in (ball, tube)),
    ):
        with pytest.raises(InvalidModel, match="link 'b'"):
            mik.CollisionWorld(robot(tmp_path, BOX.format("1 1 1"), shape))


def test_a_flat_mesh_of_a_robot_is_a_sheet_that_collides(tmp_path: Path) -> None:
    write(tmp_path / "flat.obj", CORNERS * [1.0, 1.0, 0.0], CUBE)
    world = mik.CollisionWorld(robot(tmp_path, BOX.format("1 1 1"), MESH.format("flat.obj")))
    world.add(mik.collision.Obstacle("wall", mik.collision.Box((0.1, 0.1, 4.0)), (0.5, 0.5, 1.9)))
    world.allow("wall", "a")
    assert [contact[:2] for contact in world.pairs_in_collision(np.zeros(2))] == [("b", "wall")]


def test_a_robot_that_has_only_looks_is_checked_by_them_and_a_warning_says_so(tmp_path: Path) -> None:
    seen = BOX.replace("collision", "visual").format("1 1 1")
    with pytest.warns(VisualGeometry, match="two has no collision geometry: its visual geometry is checked"):
        world = mik.CollisionWorld(robot(tmp_path, seen, seen))
    assert world.names == ("a", "b", "c")


def test_what_a_robot_looks_like_is_not_checked_where_that_is_not_wanted(tmp_path: Path) -> None:
    seen = BOX.replace("collision", "visual").format("1 1 1")
    with pytest.raises(
        InvalidGeometry, match="two has no collision geometry, and visual=False leaves out its visual geometry"
    ):
        mik.CollisionWorld(robot(tmp_path, seen, seen), visual=False)
    assert mik.CollisionWorld(robot(tmp_path, BOX.format("1 1 1"), seen), visual=False).names == ("a", "c")


def test_a_robot_without_any_geometry_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidGeometry, match="two has no collision geometry and no visual geometry"):
        mik.CollisionWorld(robot(tmp_path, "", ""))


def test_capsules_are_fitted_only_where_they_are_checked(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("PIN_METAIK_CACHE", str(tmp_path))
    fitted = []
    monkeypatch.setattr(simplify, "fit_capsule", lambda points: fitted.append(1) or (np.zeros((2, 3)), 1.0))
    for level in ("none", "convex"):
        robot_bodies(robot_of("ur5"), level)  # type: ignore[arg-type]
    assert not fitted
    robot_bodies(robot_of("ur5"), "capsule")
    assert len(fitted) == 7


def test_the_first_world_of_a_robot_says_what_it_does(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("PIN_METAIK_CACHE", str(tmp_path))
    monkeypatch.setattr("pin_metaik.notice.WAIT", 0.0)
    robot_bodies(replace(robot_of("ur5"), name="my arm"), "convex")
    assert f"pin_metaik: simplifying 7 meshes of my arm, once; kept in {tmp_path} ...\n" in capsys.readouterr().err
    assert body.where_kept() == f"kept in {tmp_path}"
