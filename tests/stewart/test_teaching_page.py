"""The numbers of docs/teaching_stewart.md, and of docs/servo_platforms.md, computed again."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from pin_metaik import stewart
from pin_metaik.stewart import Dexterity, Geometry, pose_at
from tests.stewart.cases import reference, similar_hexagons

PAGE = (Path(__file__).parents[2] / "docs" / "teaching_stewart.md").read_text(encoding="utf-8")
HOME = pose_at((0.0, 0.0, 0.37))
HEXAPOD = reference().geometry


def said(*words: str) -> None:
    """What a page says, whatever its lines."""
    for each in words:
        assert each in " ".join(PAGE.split())


def test_legs_and_dexterity_at_home():
    assert_allclose(1e3 * stewart.leg_lengths(HEXAPOD, HOME), 409.68, atol=0.005)
    nu = [float(stewart.conditioning(HEXAPOD, HOME, Dexterity(length=length))) for length in (0.001, 0.01, 0.12, 1.0)]
    said("409.68 mm each", "{:.4f}, {:.4f}, {:.4f} and {:.4f}".format(*nu))
    best = stewart.best_length(HEXAPOD, HOME)
    said(f"L = {1e3 * best:.1f} mm with {stewart.conditioning(HEXAPOD, HOME, Dexterity(length=best)):.4f}")


def test_where_legs_no_longer_hold():
    (met,) = stewart.crossings(HEXAPOD, stewart.straight(HOME, pose_at((0, 0, 0.37), (0, 0, 2.0)), 1.0))
    said(f"at {np.degrees(np.arctan2(met.pose[1, 0], met.pose[0, 0])):.2f} degrees")
    lengths, J = stewart.leg_lengths(HEXAPOD, met.pose), stewart.jacobian(HEXAPOD, met.pose)
    for motion in (J[:, 5], J[:, 2]):  # turning, rising
        assert_allclose(lengths * motion, lengths[0] * motion[0], rtol=1e-6)


def test_similar_hexagons_and_how_they_are_mended():
    A, _ = stewart.velocity_equation(similar_hexagons(), HOME)
    assert (np.linalg.svd(A)[1] < 1e-12).sum() == 3
    regular, apart = np.radians(np.arange(0, 360, 60)), np.radians([-20, 20, 100, 140, 220, 260])
    straight = tuple((i, i) for i in range(6))
    shifted = Geometry(0.25, 0.12, regular, regular, tuple((i, (i + 1) % 6) for i in range(6)))
    turned = Geometry(0.25, 0.12, regular, regular + np.radians(30), straight)
    assert [float(stewart.conditioning(each, HOME)) for each in (shifted, turned)] == [0.0, 0.0]
    paired = stewart.conditioning(Geometry(0.25, 0.12, regular - np.radians(30), apart, straight), HOME)
    said(f"nu is {paired:.3f}")


def test_how_many_poses():
    lengths = stewart.leg_lengths(HEXAPOD, pose_at((0.03, -0.02, 0.38), np.radians((5, -8, 12))))
    found = stewart.all_forward(HEXAPOD, lengths)
    assert (len(found), int((found.poses[:, 2, 3] > 0).sum()), found.complete) == (12, 6, True)
    said("12, six above the base")


def test_servos_on_their_way_up():
    geometry = stewart.load_mechanism("servo_sg90").geometry
    level = [
        np.degrees(stewart.inverse(geometry, pose_at((0, 0, 0.115)), branch).coordinates[0, 0]) for branch in (1, -1)
    ]
    said("{:.2f} and {:.2f} degrees".format(*level))
    at = [pose_at((0.0, 0.0, height)) for height in (0.110, 0.115, 0.130, 0.1313)]
    speeds = [np.degrees(0.01 * stewart.jacobian(geometry, pose)[0, 2]) for pose in at]
    said("{:.0f} degrees a second at 110 mm, {:.0f} at 115, {:.0f} at 130 and {:.0f} at 131.3".format(*speeds))
    shares = [stewart.transmission(geometry, pose)[0] for pose in at]
    said(f"falls from {shares[1]:.2f} to {shares[3]:.2f}")


def test_what_weights_lead_to():
    mechanism = stewart.load_mechanism("stroke_100")
    scores = []
    for weights in ((1.0, 0.0), (0.78, 0.22), (0.5, 0.5), (0.0, 1.0)):
        task = replace(mechanism.task, weights=weights, evaluations=1200)
        scores.append(stewart.design(replace(mechanism, task=task)).score)
    assert [score.dexterity for score in scores] == pytest.approx([0.94, 0.94, 0.93, 0.18], abs=0.01)
    assert [100 * score.workspace for score in scores] == pytest.approx([5, 10, 11, 43], abs=1.0)
    said("Dexterities 0.94, 0.94, 0.93 and 0.18", "10, 11 and 43 %")


def test_level_heights_of_the_platforms_of_servos():
    page = (Path(__file__).parents[2] / "docs" / "servo_platforms.md").read_text(encoding="utf-8")
    for name, digits in (("servo_sg90", 2), ("servo_esp32", 6)):
        height = 1e3 * stewart.forward(stewart.load_mechanism(name).geometry, np.zeros(6)).pose[2, 3]
        assert f"| {height:.{digits}f} |" in page
