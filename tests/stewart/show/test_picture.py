from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from pin_metaik.errors import MissingExtra
from pin_metaik.stewart import (
    Grid,
    LegLimits,
    Mechanism,
    design,
    draw,
    draw_above,
    draw_history,
    draw_motion,
    follow,
    leg_vectors,
    load_mechanism,
    pose_at,
    save_picture,
    singularities,
    straight,
    survey,
)
from pin_metaik.stewart.show.picture import legs_at
from tests.stewart.cases import reference, similar_hexagons, stroke

pytest.importorskip("matplotlib")
PNG = b"\x89PNG"


def with_grid(mechanism, **changes):
    return replace(mechanism, grid=Grid(**changes))


def test_a_mechanism_and_its_workspace_are_drawn(tmp_path):
    mechanism = with_grid(reference(), counts=(10, 10, 10))
    figure = draw(mechanism, mechanism.survey())
    assert len(figure.axes) == 3  # mechanism, workspace, colour bar
    assert "GDI 0.6" in figure.axes[1].get_title()
    assert save_picture(figure, tmp_path / "m.png").read_bytes().startswith(PNG)


def test_a_mechanism_is_drawn_alone_and_at_a_pose(tmp_path):
    figure = draw(stroke(100), pose=pose_at((0.02, 0, 0.24), (0.1, 0, 0.2)))
    assert len(figure.axes) == 1
    assert save_picture(figure, tmp_path / "m.svg").read_text().startswith("<?xml")


def test_orientations_and_singular_workspaces_are_drawn(tmp_path):
    tilting = with_grid(reference(), counts=(5, 5, 5), steps=(3, 1, 1), roll=(-0.1, 0.1))
    save_picture(draw(tilting, tilting.survey()), tmp_path / "tilting.png")
    singular = Mechanism("similar", similar_hexagons(), LegLimits(0.35, 0.47), Grid((5, 5, 5)))
    figure = draw(singular, singular.survey())
    assert "no GDI: singular" in figure.axes[1].get_title()
    save_picture(figure, tmp_path / "singular.png")
    single = with_grid(
        reference(), counts=(1, 1, 1), x=(0, 0), y=(0, 0), z=(0.37, 0.37), steps=(3, 1, 1), roll=(-0.1, 0.1)
    )
    figure = draw(single, single.survey())
    assert figure.axes[1].get_xlabel() == "roll (deg)"
    save_picture(figure, tmp_path / "single.png")


def test_the_history_of_a_design_is_drawn(tmp_path):
    mechanism = stroke(50)
    found = design(replace(mechanism, task=replace(mechanism.task, evaluations=180)))
    figure = draw_history(found)
    x, y = figure.axes[0].lines[0].get_data()
    assert x[-1] == 180
    assert (np.diff(y) >= 0).all()


def test_without_matplotlib_the_extra_is_named(monkeypatch):
    monkeypatch.setattr("pin_metaik.lookup.find_spec", lambda package: None)
    with pytest.raises(MissingExtra, match=r"a picture needs .*\[plots\]"):
        draw(reference())


def test_legs_are_drawn_from_joint_to_joint_by_way_of_their_horns_or_cylinders():
    for mechanism, height in ((reference(), 0.37), (load_mechanism("servo_sg90"), 0.115)):
        pose = pose_at((0.003, 0.0, height), (0.02, 0.0, 0.05))
        legs = legs_at(mechanism, pose)
        geometry = mechanism.geometry
        assert_allclose(legs[:, 0], geometry.b)
        assert_allclose(legs[:, 2], geometry.b + leg_vectors(geometry, pose)[0], atol=1e-12)
        if geometry.servos is not None:
            assert_allclose(np.linalg.norm(legs[:, 1] - legs[:, 0], axis=1), geometry.servos.horn)
            assert_allclose(np.linalg.norm(legs[:, 2] - legs[:, 1], axis=1), geometry.servos.rod)


def test_servos_their_workspace_and_their_motion_are_drawn(tmp_path):
    mechanism = replace(load_mechanism("servo_sg90"), grid=Grid((10, 10, 10)))
    figure = draw(mechanism, mechanism.survey())
    assert "GDI" in figure.axes[1].get_title()
    save_picture(figure, tmp_path / "servos.png")
    save_picture(draw_above(mechanism), tmp_path / "above.png")
    motion = follow(mechanism.geometry, straight(pose_at((0, 0, 0.115)), pose_at((0, 0, 0.15)), 1.0), mechanism.limits)
    figure = draw_motion(motion, mechanism)
    assert figure.axes[0].get_ylabel() == "angle of servos (deg)"
    save_picture(figure, tmp_path / "motion.png")


def test_where_det_J_changes_sign_is_drawn_in_red():
    turning = with_grid(reference(), counts=(1, 1, 1), steps=(3, 3, 9), **dict.fromkeys(("roll", "pitch"), (-0.3, 0.3)))
    turning = replace(turning, grid=replace(turning.grid, x=(0, 0), y=(0, 0), z=(0.37, 0.37), yaw=(-2.0, 2.0)))
    workspace = survey(turning.geometry, LegLimits(0.2, 0.6), turning.grid)
    axes = draw(turning, workspace).axes[1]
    assert "det J changes sign" in axes.get_title()
    (points,) = [each for each in axes.collections if hasattr(each, "_offsets3d")]
    drawn = np.column_stack(points._offsets3d)
    assert len(drawn) == len(singularities(workspace).crossings) > 0
    assert_allclose(np.abs(drawn[:, 2]), 90.0, atol=20.0)  # degrees of yaw
