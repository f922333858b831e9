from pathlib import Path

import pytest

import pin_metaik as mik
from pin_metaik.errors import InvalidModel, UnknownName
from tests.collision.worlds import configurations, robot_of, world_of


def test_neighbours_and_links_that_never_touch_are_not_checked() -> None:
    pairs = mik.CollisionWorld(robot_of("panda"), srdf=False).pairs
    assert pairs["panda_link3", "panda_link4"] == "Adjacent"
    assert pairs["panda_link1", "panda_link3"] == "Never"
    assert pairs["panda_hand", "panda_link1"] == ""
    assert pairs["panda_link5", "panda_link7"] == ""  # touch in 7 % of the configurations: the SRDF exempts them


def test_the_robots_own_srdf_is_respected_unless_told_otherwise() -> None:
    assert world_of("panda").pairs["panda_link5", "panda_link7"] == "Default"


def test_links_that_touch_by_construction_are_found() -> None:
    assert mik.CollisionWorld(robot_of("rv7fl")).pairs["link_2", "link_4"] == "Always"


@pytest.mark.parametrize("name", ["panda", "ur5", "xarm7"])
def test_links_left_out_as_never_touching_do_not(name: str) -> None:
    world = mik.CollisionWorld(robot_of(name), srdf=False)
    never = [pair for pair, reason in world.disabled.items() if reason == "Never"]
    assert never
    for pair in never:
        world.check(*pair)
    for q in configurations(name, 500, seed=7):
        assert not {tuple(sorted(c[:2])) for c in world.pairs_in_collision(q)} & set(never)


def test_what_is_written_can_be_changed_and_read_back(tmp_path: Path) -> None:
    world = world_of("ur5")
    path = tmp_path / "ur5.srdf"
    world.write_srdf(path)
    assert mik.CollisionWorld(robot_of("ur5"), srdf=path).disabled == world.disabled
    text = path.read_text()
    assert '<disable_collisions link1="base_link" link2="shoulder_link" reason=' in text
    path.write_text(text.replace("</robot>", '<disable_collisions link1="ee_link" link2="base_link"/></robot>'))
    assert mik.CollisionWorld(robot_of("ur5"), srdf=path).disabled["base_link", "ee_link"] == "SRDF"


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ('<robot name="ur5"><disable_collisions link1="base_link" link2="elbow"/></robot>', UnknownName),
        ('<robot name="ur5"><disable_collisions link1="base_link"/></robot>', InvalidModel),
        ("<robot", InvalidModel),
    ],
)
def test_an_srdf_that_makes_no_sense_is_refused(tmp_path: Path, text: str, error: type[Exception]) -> None:
    path = tmp_path / "ur5.srdf"
    path.write_text(text)
    with pytest.raises(error):
        mik.CollisionWorld(robot_of("ur5"), srdf=path)


def test_an_srdf_that_is_missing_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidModel, match="cannot read"):
        mik.CollisionWorld(robot_of("ur5"), srdf=tmp_path / "ur5.srdf")
