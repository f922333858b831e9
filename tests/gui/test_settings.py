"""What pages ask: the settings of what was chosen and no others, and platforms of both kinds."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np
import pytest

pytest.importorskip("viser")

from pin_metaik import stewart
from pin_metaik.gui.look.scale import colours
from pin_metaik.optimize import ALGORITHMS

OWN = {name: {field.name for field in fields(kind)} for name, kind in ALGORITHMS.items()}  # type: ignore[arg-type]


def test_only_the_settings_of_the_chosen_algorithm_are_asked_for(socket: Any) -> None:
    socket.set("Page", "Metaheuristics at work")
    socket.find("Beside it")
    every = set.union(*OWN.values())
    assert len(ALGORITHMS) == 9
    for name, own in OWN.items():
        for chosen in ("Algorithm", "Beside it"):
            socket.set(chosen, name)
        socket.wait_until(lambda own=own: every & set(socket.labels.values()) == own)


def test_a_platform_of_servos_is_begun_and_its_design_has_ranges_of_its_own(socket: Any, toolbox: Any) -> None:
    socket.set("Page", "Stewart platforms")
    socket.find("Begin with this type")
    assert {"shortest", "longest"} <= set(socket.labels.values())
    for label, value in (("Type", "6x3"), ("Legs that", "are rods moved by servos")):
        socket.set(label, value)
    socket.set("Radii, mm", (60.0, 40.0))
    socket.set("Horn and rod, mm", (20.0, 110.0))
    socket.set("Begin with this type", True)
    begun = stewart.new_servo_mechanism("6x3", 0.06, 0.04, 0.02, 0.11)
    (session,) = toolbox.tabs.values()
    toml = stewart.to_toml(begun)
    socket.wait_until(lambda: session.page is not None and session.page.kept()["mechanism"] == toml)
    socket.find("directions")
    labels = set(socket.labels.values())
    assert {"horn", "rod", "lowest", "highest", "speed"} <= labels
    assert not {"shortest", "longest"} & labels
    socket.see("servo angles")


def test_colours_of_the_scale_are_fixed_from_0_to_1_and_told_apart() -> None:
    shown = colours(np.linspace(-0.5, 1.5, 201)).astype(int)
    assert (shown[:51] == shown[0]).all() and (shown[150:] == shown[-1]).all()
    light = shown[50:151] @ [0.2126, 0.7152, 0.0722]
    assert (np.diff(light) > 0.0).all()  # brighter all the way, for every eye
