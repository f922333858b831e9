"""What pages keep, in files and addresses; what is typed."""

from __future__ import annotations

import base64
import zlib
from dataclasses import fields

import pytest

from pin_metaik.errors import InvalidSetting, MetaIKError
from pin_metaik.gui.forms import meanings, text_of, value_of
from pin_metaik.gui.gate import LONGEST_HEAD, STATE
from pin_metaik.gui.kept import LARGEST, from_address, from_text, plain_of, state_of, to_address, to_text
from pin_metaik.gui.pages.arms.state import ArmsState
from pin_metaik.gui.pages.heuristics.state import PAPER, HeuristicsState
from pin_metaik.gui.pages.paths.state import PathsState
from pin_metaik.gui.pages.platforms.state import PlatformsState
from pin_metaik.optimize import ALGORITHMS
from pin_metaik.stewart import load_mechanism, to_toml

STATES = [
    ArmsState(robot="ur5", target=(0.1, 0.2, 0.3, 0.0, 0.0, 0.0, 1.0), q=(0.0,) * 6, obstacles=({"name": "a"},)),
    *(make() for make in PAPER.values()),
    HeuristicsState(algorithm="de", settings={"F": 0.7}),
    PathsState(radius=0.5, algorithm="sfla"),
    PlatformsState(mechanism=to_toml(load_mechanism("stroke_100")), xyz=(0.0, 0.0, 0.2)),
]


@pytest.mark.parametrize("state", STATES)
def test_a_state_comes_back_the_same_from_a_file_and_from_an_address(state: object) -> None:
    values = {"page": plain_of(state)}
    for page, pages in (from_text(to_text("page", values), "a file"), from_address(to_address("page", values)) or ()):
        assert page == "page" and state_of(type(state), pages["page"], "it") == state
    assert len(to_address("page", values)) < LONGEST_HEAD / 2


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[]",
        "{",
        "null",
        '{"format": "pin_metaik toolbox 1"}',
        '{"format": "other", "page": "a", "pages": {}}',
        "[" * 10**5,
    ],
)
def test_what_is_no_state_is_told(text: str) -> None:
    with pytest.raises(InvalidSetting):
        from_text(text, "a file")


def test_an_address_that_is_damaged_or_unpacks_to_too_much_is_told() -> None:
    bomb = base64.urlsafe_b64encode(zlib.compress(b" " * (LARGEST + 1000), 9)).decode()
    for path in (STATE + "abc", STATE + "!!!!", STATE + bomb):
        with pytest.raises(InvalidSetting):
            from_address(path)
    assert from_address("/") is None


@pytest.mark.parametrize(
    ("kind", "values"),
    [
        (ArmsState, {"robot": 3}),
        (ArmsState, {"robbot": "ur5"}),
        (ArmsState, {"target": [1.0]}),
        (ArmsState, {"drawn": "sideways"}),
        (HeuristicsState, {"algorithm": "gow"}),
        (HeuristicsState, {"settings": {"wolves": 3}}),
        (HeuristicsState, {"iterations": 10**12}),
        (PathsState, {"scene": {"obstacles": "many"}}),
        (PathsState, {"radius": -1.0}),
        (PlatformsState, {"xyz": [1.0]}),
    ],
)
def test_values_that_make_no_sense_are_told_by_name(kind: type, values: dict[str, object]) -> None:
    with pytest.raises(MetaIKError):
        state_of(kind, values, "it")


@pytest.mark.parametrize("value", [3, 0.25, -1e-9, "best", (0.1, 0.2), (0, (1.0, 2.0), (2.5, 3.0)), None])
def test_what_is_typed_reads_back(value: object) -> None:
    assert value_of("it", "" if value is None else text_of(value)) == value
    with pytest.raises(InvalidSetting, match="it: a number"):
        value_of("it", "0.1..x")


def test_every_setting_of_every_algorithm_says_what_it_means() -> None:
    for kind in ALGORITHMS.values():
        assert set(meanings(kind)) >= {field.name for field in fields(kind)}, kind  # type: ignore[arg-type]
