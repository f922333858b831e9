"""Maps of what can be reached: the same as pose by pose, whoever works on them, and after a stop."""

from __future__ import annotations

import re
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import pin_metaik as mik
from pin_metaik.collision import Box, Obstacle
from pin_metaik.errors import InvalidBounds, InvalidSetting
from pin_metaik.reachable import Grid, Reachability, reachability, save_reachability, spread_rotations
from pin_metaik.reachable.files import STATUSES
from tests.collision.worlds import robot_of
from tests.robots_under_test import chain_of

GRID = Grid((-0.6, -0.6, 0.1), (0.6, 0.6, 0.9), 0.4)


@pytest.fixture(scope="module")
def ur5_map() -> Reachability:
    return reachability(chain_of("ur5"), GRID, 8)


def test_a_map_says_what_single_searches_say(ur5_map: Reachability) -> None:
    chain = chain_of("ur5")
    assert ur5_map.status.shape == (4 * 4 * 3, 8)
    for i in range(0, len(ur5_map.positions), 7):
        for j in range(0, 8, 3):
            result = mik.solve_ik(chain, pin.SE3(ur5_map.orientations[j], ur5_map.positions[i]))
            assert STATUSES[ur5_map.status[i, j]] is result.status
            if result.success:
                J = result.problem.linearize(result.x)[1].T
                assert ur5_map.manipulability[i, j] == pytest.approx(np.sqrt(np.linalg.det(J @ J.T)), rel=1e-3)
            else:
                assert np.isnan(ur5_map.manipulability[i, j])
    assert ur5_map.done == 1.0
    assert 0.0 < ur5_map.share.mean() < 1.0
    assert (ur5_map.unreachable | ur5_map.reached).all()  # of six joints with a closed form everything is decided
    assert ((ur5_map.best > 0.0) == ur5_map.reached.any(axis=1)).all()


@pytest.mark.parametrize("ending", [".npz", ".parquet"])
def test_a_map_is_written_and_read(ur5_map: Reachability, tmp_path: Path, ending: str) -> None:
    again = Reachability.load(ur5_map.save(tmp_path / f"map{ending}"))
    for name in ("positions", "orientations", "status", "manipulability"):
        assert_array_equal(getattr(again, name), getattr(ur5_map, name))
        assert getattr(again, name).dtype == getattr(ur5_map, name).dtype
    assert again.shape == ur5_map.shape
    assert again.at(ur5_map.positions[5] + 0.01) == ur5_map.share[5]
    assert str(again) == str(ur5_map)
    (tmp_path / f"none{ending}").write_bytes(b"PK nothing")
    for file in (f"none{ending}", f"missing{ending}"):
        with pytest.raises(InvalidSetting, match="not a map"):
            Reachability.load(tmp_path / file)
    with pytest.raises(InvalidSetting, match=r"ends in \.npz or \.parquet"):
        ur5_map.save(tmp_path / "map.csv")


def test_a_map_as_parquet_is_a_table_of_poses(ur5_map: Reachability, tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    table = parquet.read_table(ur5_map.save(tmp_path / "map.parquet"))
    column = {name: table.column(name).to_numpy(zero_copy_only=False) for name in table.column_names}
    assert table.num_rows == ur5_map.status.size
    assert_array_equal(column["status"] == "SOLVED", ur5_map.reached.ravel())
    for i, axis in enumerate("xyz"):
        assert_array_equal(column[axis], ur5_map.positions[column["position"], i])
    k, m = column["position"], column["orientation"]
    assert_array_equal(column["manipulability"], ur5_map.manipulability[k, m])


def test_a_grid_around_a_chain_holds_all_that_it_reaches() -> None:
    chain, rng = chain_of("ur5"), np.random.default_rng(0)
    grid = Grid.around(chain, 0.1)
    tips = chain.poses(chain.box.sample(rng, 500))[:, 0, :3, 3]
    assert (tips > np.subtract(grid.lower, 0.1)).all() and (tips < np.add(grid.upper, 0.1)).all()
    assert_allclose(np.array(grid.lower) / 0.1, np.round(np.array(grid.lower) / 0.1), atol=1e-9)


@pytest.mark.slow
def test_the_browser_shows_a_map_with_the_robot_in_it(
    ur5_map: Reachability, browser: list[str], tmp_path: Path
) -> None:
    pytest.importorskip("viser")
    from pin_metaik.reachable.viewer import show_reachability

    world = mik.CollisionWorld(robot_of("ur5"))
    shown = show_reachability(ur5_map, world, port=0)
    log, page = tmp_path / "log", f"http://localhost:{shown.viewer.get_port()}"
    with log.open("w") as told:
        profile = [f"--user-data-dir={tmp_path / 'profile'}", "--window-size=500,340", "--enable-unsafe-swiftshader"]
        seen = subprocess.Popen([*browser, *profile, page], stdout=subprocess.DEVNULL, stderr=told)
        try:
            picture = shown.picture(320, 240, timeout=300.0).astype(float)
        finally:
            seen.terminate()
            seen.wait()
            shown.viewer.stop()
    coloured = picture.max(axis=2) - picture.min(axis=2) > 40.0
    grey = (picture.max(axis=2) < 200.0) & ~coloured
    assert 0.005 < coloured.mean() < 0.6  # cubes
    assert grey.mean() > 0.001  # the robot
    assert not re.findall(r"ERROR:CONSOLE.*", log.read_text())
    nothing = replace(ur5_map, status=np.zeros_like(ur5_map.status))
    with pytest.raises(InvalidSetting, match="reaches none"):
        show_reachability(nothing, world, port=0)


def test_work_that_was_stopped_goes_on_and_comes_to_the_same(ur5_map: Reachability, tmp_path: Path) -> None:
    chain = chain_of("ur5")
    several = Grid(GRID.lower, GRID.upper, 0.15)  # more parts than one
    begun = reachability(chain, several, 8, folder=tmp_path, watch=lambda at: True)
    assert 0.0 < begun.done < 1.0
    (_part,) = tmp_path.glob("part_*.npz")
    assert not (tmp_path / "reachability.npz").exists()
    (tmp_path / "part_000001.npz").write_bytes(b"cut off")
    told: list[float] = []
    whole = reachability(chain, several, 8, folder=tmp_path, watch=lambda at: told.append(at.done))
    assert told[0] > (begun.status > 0).sum()  # what was done is not done again
    assert whole.done == 1.0
    assert_array_equal(Reachability.load(tmp_path / "reachability.npz").status, whole.status)
    assert_array_equal(whole.status, reachability(chain, several, 8).status)
    for question in ({"orientations": 9}, {"orientations": 8, "rng": 4}):
        with pytest.raises(InvalidSetting, match="made with other arguments"):
            reachability(chain, several, folder=tmp_path, **question)


def test_processes_come_to_the_same_as_threads(ur5_map: Reachability) -> None:
    pytest.importorskip("joblib")
    other = reachability(chain_of("ur5"), GRID, 8, jobs=2)
    assert_array_equal(other.status, ur5_map.status)
    assert_array_equal(other.manipulability, ur5_map.manipulability)


@pytest.mark.slow
@pytest.mark.filterwarnings("default")  # of its own start and end
def test_a_dask_cluster_comes_to_the_same(ur5_map: Reachability) -> None:
    distributed = pytest.importorskip("distributed")
    pytest.importorskip("joblib")
    with distributed.LocalCluster(n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None) as here:
        other = reachability(chain_of("ur5"), GRID, 8, backend="dask", scheduler=here.scheduler_address)
    assert_array_equal(other.status, ur5_map.status)
    assert_array_equal(other.manipulability, ur5_map.manipulability)


def test_obstacles_and_positions_alone() -> None:
    chain = chain_of("ur5")
    block = Obstacle("block", Box((0.5, 0.5, 0.5)), (0.5, 0.5, 0.4))
    world = mik.CollisionWorld(robot_of("ur5"), [block])
    places = np.array([[0.5, 0.5, 0.4], [-0.4, -0.4, 0.4], [3.0, 0.0, 0.0]])
    few = mik.IKSolver(budget=mik.Budget(evaluations=2000))
    names = [STATUSES[n] for n in reachability(chain, places, world=world, solver=few).status[:, 0]]
    assert names[0] is not mik.IKStatus.SOLVED
    assert names[1:] == [mik.IKStatus.SOLVED, mik.IKStatus.UNREACHABLE]
    alone = reachability(chain, places)
    assert alone.reached[:, 0].tolist() == [True, True, False]
    assert alone.shape == (3, 1, 1)


def test_rotations_are_spread_evenly() -> None:
    rotations = spread_rotations(500)
    assert np.allclose(rotations @ rotations.transpose(0, 2, 1), np.eye(3))
    assert np.allclose(np.linalg.det(rotations), 1.0)
    turns = np.arccos(np.clip((np.einsum("aij,bij->ab", rotations, rotations) - 1.0) / 2.0, -1.0, 1.0))
    nearest = np.sort(turns, axis=1)[:, 1]
    assert nearest.min() > 0.15
    assert nearest.max() < 0.6


@pytest.mark.parametrize("listed", [False, True])
def test_a_picture_of_a_map(ur5_map: Reachability, tmp_path: Path, listed: bool) -> None:
    pytest.importorskip("matplotlib")
    shown = reachability(chain_of("ur5"), ur5_map.positions[:9], 4) if listed else ur5_map
    path = save_reachability(shown, tmp_path / "map.png", slices=2)
    assert path.stat().st_size > 10_000


def test_bad_input_is_told_by_name(tmp_path: Path) -> None:
    chain = chain_of("ur5")
    with pytest.raises(InvalidBounds, match="lower corner"):
        Grid((1.0, 0.0, 0.0), (0.0, 1.0, 1.0), 0.1)
    with pytest.raises(InvalidSetting, match="at most"):
        Grid((0.0, 0.0, 0.0), (10.0, 10.0, 10.0), 0.01)
    with pytest.raises(InvalidSetting, match="orientation 1"):
        reachability(chain, GRID, [np.eye(3), 2.0 * np.eye(3)])
    with pytest.raises(InvalidSetting, match="at least one position"):
        reachability(chain, np.empty((0, 3)))
    with pytest.raises(InvalidSetting, match="jobs"):
        reachability(chain, GRID, jobs=0)
    with pytest.raises(InvalidSetting, match="one frame"):
        reachability(mik.Chain(robot_of("ur5"), ["tool0", "forearm_link"]), GRID)
    with pytest.raises(InvalidSetting, match="scheduler"):
        reachability(chain, GRID, backend="dask")
