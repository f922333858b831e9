"""Mechanisms moved by servos as TOML, and their motion as CSV."""

import csv
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from pin_metaik.errors import InvalidGeometry, InvalidTable
from pin_metaik.stewart import (
    DesignTask,
    Mechanism,
    Ranges,
    ServoLimits,
    follow,
    load_mechanism,
    pose_at,
    save_mechanism,
    save_motion,
    straight,
    to_toml,
)
from tests.stewart.cases import general_servos

SG90 = to_toml(load_mechanism("servo_sg90"))


def written(tmp_path, text):
    path = tmp_path / "m.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_servos_of_every_kind_are_saved_and_loaded_to_the_last_bit(tmp_path):
    limits = ServoLimits(-1.3, 1.1, base_angle=0.7, platform_angle=0.6, distance=0.004, home=(0, 0, 0.12), speed=9.5)
    for branches in (1, -1, (1, -1, 1, 1, -1, 1)):
        geometry = general_servos(branches)
        mechanism = Mechanism("general", geometry, limits, task=DesignTask(Ranges(horn=(0.01, 0.03), rod=0.12)))
        path = save_mechanism(mechanism, tmp_path / "general.toml")
        assert load_mechanism(path) == mechanism
        assert to_toml(load_mechanism(path)) == path.read_text(encoding="utf-8")
    level = replace(geometry, servos=replace(geometry.servos, zeros=None))
    assert load_mechanism(save_mechanism(replace(mechanism, geometry=level), path)).geometry == level


@pytest.mark.parametrize(
    ("old", "new", "error", "message"),
    [
        ("lowest = -80", "lowest = 90", InvalidGeometry, "lie between -pi and pi, the lowest first"),
        ("horn = 15", "horn = 0", InvalidGeometry, "the horn of a servo is longer than zero"),
        ("horn = 15", "", InvalidTable, "servos: horn is missing"),
        ("horn = 15", "horn = [15, 16]", InvalidGeometry, "horn of servos: 2 for 6 axes"),
        ("rod = 120", "rood = 120", InvalidTable, "unknown key 'rood'; did you mean 'rod'"),
        ("directions = [-150, ", "directions = [", InvalidGeometry, "servos have 5 axes for 6 legs"),
        ("directions = [-150", "# [-150", InvalidGeometry, "either directions or axes"),
        ("lowest = -80", "branches = 2\nlowest = -80", InvalidGeometry, "branches of servos are 1 or -1, got 2"),
        ("lowest = -80", "branches = 1.5\nlowest = -80", InvalidTable, "is not a whole number"),
        ("platform = [1", "shortest = 3\nplatform = [1", InvalidTable, "legs: unknown key 'shortest'"),
        (
            "directions = [-150, 150, -30, -90, 90, 30]",
            "axes = [[0, 0, 1], [1, 0, 0], [1, 0, 0], [1, 0, 0], [1, 0, 0], [1, 0, 0]]",
            InvalidGeometry,
            "axis of servo 1 is vertical: give zeros",
        ),
    ],
)
def test_what_is_wrong_with_servos_is_named(tmp_path, old, new, error, message):
    assert old in SG90
    with pytest.raises(error, match=message):
        load_mechanism(written(tmp_path, SG90.replace(old, new, 1)))


def test_axes_square_to_the_base_or_anywhere_give_the_same_platform(tmp_path):
    servos = load_mechanism("servo_sg90").geometry.servos
    as_vectors = replace(servos, directions=(), axes=tuple(map(tuple, servos.frames[:, 2].tolist())))
    assert_allclose(as_vectors.frames, servos.frames, atol=1e-15)


def test_angles_over_time_are_written_in_degrees(tmp_path):
    mechanism = load_mechanism("servo_sg90")
    motion = follow(mechanism.geometry, straight(pose_at((0, 0, 0.115)), pose_at((0, 0, 0.15)), 1.0, 21))
    with save_motion(motion, tmp_path / "legs.csv", 0.001).open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == ["time", *(f"a{i}" for i in range(1, 7)), *(f"w{i}" for i in range(1, 7)), "nu", "state"]
    angles = [[float(row[f"a{i}"]) for i in range(1, 7)] for row in rows]
    assert_allclose(np.radians(angles), motion.coordinates, atol=1e-9)
    assert (rows[0]["state"], rows[-1]["state"]) == ("positive", "too_long")
