import builtins
from dataclasses import replace

import numpy as np
import pytest

from pin_metaik.errors import MissingExtra
from pin_metaik.stewart import Grid, LegLimits, Mechanism, design, draw, draw_history, pose_at, save_picture
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
    real = builtins.__import__

    def without(name, *args, **kwargs):
        if name.startswith("matplotlib"):
            raise ImportError(name)
        return real(name, *args, **kwargs)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(MissingExtra, match=r"a picture needs .*\[plots\]"):
        draw(reference())
