"""Arguments are read as their annotations promise, or refused by name with what would have worked."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from inspect import signature
from pathlib import Path
from typing import Any, Literal, TypeVar

import numpy as np
import pytest
from numpy.typing import ArrayLike, NDArray
from typing_extensions import TypeAliasType  # of typing itself since Python 3.12

from pin_metaik.arguments import array, checked, checked_as, instance, number, shown
from pin_metaik.errors import InvalidBounds, InvalidSetting


@checked
def door(
    count: int = 1,
    share: float | None = None,
    size: tuple[float, float, float] = (1.0, 1.0, 1.0),
    names: Iterable[str] = (),
    kind: Literal["a", "b"] = "a",
    X: NDArray[np.float64] | None = None,
    call: Callable[[int], int] | None = None,
    file: str | Path = "x",
    folder: Path | None = None,
    limits: Mapping[str, tuple[float, float]] | None = None,
    flag: bool = False,
    rows: Sequence[int] = (),
    rng: int | np.random.Generator | None = None,
    anything: ArrayLike | None = None,
) -> dict[str, Any]:
    """Give back what came in."""
    return dict(locals())


@pytest.mark.parametrize(
    ("given", "read"),
    [
        ({"count": np.int64(3)}, 3),
        ({"share": np.array(0.5)}, 0.5),
        ({"share": 2}, 2),
        ({"share": 2**53}, 2**53),
        ({"size": [1, 2, 3]}, (1, 2, 3)),
        ({"size": np.array([1.0, 2.0, 3.0])}, (1.0, 2.0, 3.0)),
        ({"names": (name for name in "ab")}, ("a", "b")),
        ({"kind": "c"}, "c"),  # what is in the set, the function knows
        ({"folder": "here"}, Path("here")),
        ({"limits": {"j": [0, 1]}}, {"j": (0, 1)}),
        ({"flag": np.True_}, True),
        ({"rows": range(3)}, (0, 1, 2)),
        ({"anything": "as it is"}, "as it is"),
    ],
)
def test_what_is_as_good_as_what_is_annotated_is_taken(given: dict[str, Any], read: object) -> None:
    (name,) = given
    assert door(**given)[name] == read


def test_a_number_is_never_one_that_makes_an_array_of_objects() -> None:
    for value in (10**30, -(2**64), Fraction(1, 3), 2**53):
        assert np.array([0.5, door(share=value)["share"]]).dtype == float


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"count": "x"}, "count: expected a whole number, got 'x'"),
        ({"count": True}, "a whole number, got True"),
        ({"count": 2.0}, "a whole number, got 2.0"),
        ({"share": "half"}, "a number or None, got 'half'"),
        ({"share": 10**400}, "a number or None, got a int"),
        ({"size": 3}, "three values, each a number, got 3"),
        ({"size": [1, 2]}, r"three values, each a number, got \[1, 2\]"),
        ({"names": "joint"}, r"a list, each entry a text, got 'joint'; of one, write \['joint'\]"),
        ({"kind": 3}, "one of 'a', 'b', got 3"),
        ({"X": "text"}, "an array of numbers or None"),
        ({"X": [[1], [1, 2]]}, "an array of numbers or None"),
        ({"call": 4}, "a function or None, got 4"),
        ({"call": int}, "a function or None"),
        ({"file": b"x"}, "a text or a path"),
        ({"file": "a\0b"}, "a text or a path"),
        ({"limits": {"j": 1}}, "a mapping, each key a text and each value two values"),
        ({"flag": "yes"}, "True or False, got 'yes'"),
        ({"rows": np.array(3)}, "a list, each entry a whole number"),
        ({"rng": "seed"}, r"a whole number or a Generator \(e.g. np.random.default_rng\(0\)\) or None"),
    ],
)
def test_what_is_something_else_is_named_with_what_would_have_worked(given: dict[str, Any], says: str) -> None:
    with pytest.raises(InvalidSetting, match=says):
        door(**given)


def test_arguments_by_position_are_read_too_and_missing_ones_are_pythons_own() -> None:
    with pytest.raises(InvalidSetting, match="count"):
        door("x")  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="unexpected keyword"):
        door(unknown=1)  # type: ignore[call-arg]


@checked_as(InvalidBounds)
@dataclass(frozen=True)
class Settings:
    """Fields are read as the arguments of the constructor."""

    ends: tuple[float, ...]
    later: Later | None = None


@dataclass
class Later:
    """Annotated above, before it was defined."""


def test_a_class_is_read_by_its_constructor_and_raises_its_own_error() -> None:
    assert Settings([1, 2]).ends == (1, 2)  # type: ignore[arg-type]
    assert Settings((1.0,), Later()).later is not None
    with pytest.raises(InvalidBounds, match="ends: expected a list, each entry a number"):
        Settings(3)  # type: ignore[arg-type]
    with pytest.raises(InvalidBounds, match="later: expected a Later or None"):
        Settings((1.0,), 3)  # type: ignore[arg-type]


def test_a_door_keeps_its_name_its_words_and_its_signature() -> None:
    assert door.__name__ == "door"
    assert door.__doc__ == "Give back what came in."
    assert list(signature(door).parameters)[:2] == ["count", "share"]


def test_an_array_is_of_its_shape_or_refused() -> None:
    given = np.zeros((2, 3))
    assert array("X", given, "k", 3) is given
    assert array("X", [1, 2, 3], "...", 3).shape == (3,)
    assert array("X", np.zeros((4, 5, 3)), "...", 3).shape == (4, 5, 3)
    assert array("x", 2, "...").shape == ()
    for value, says in [
        ([1, 2], r"X: expected shape \(k, 3\), got \(2,\)"),
        ("text", r"X: expected numbers of shape \(k, 3\), got 'text'"),
        ([[1, 2, np.nan]], "X: expected finite numbers"),
        ([[1, 2, 10**400]], "X: expected numbers"),
        ([[1, 2, 3], [4]], "X: expected numbers"),
    ]:
        with pytest.raises(InvalidBounds, match=says):
            array("X", value, "k", 3, error=InvalidBounds)
    assert np.isnan(array("X", [[1, 2, np.nan]], "k", 3, finite=False)).any()


def test_an_array_can_be_handed_to_a_compiled_loop() -> None:
    given = np.arange(6.0).reshape(2, 3).T
    given.flags.writeable = False
    made = array("X", given, 3, 2)
    assert made.flags.c_contiguous
    assert made.flags.writeable


def test_a_number_is_finite_and_an_instance_of_its_class() -> None:
    assert number("x", np.float32(0.5)) == 0.5
    for value in (np.nan, np.inf, 10**400, True, "1", None):
        with pytest.raises(InvalidSetting, match="x is a finite number"):
            number("x", value)
    with pytest.raises(InvalidSetting, match=r"rng: expected a Generator \(e.g. np.random.default_rng\(0\)\), got 3"):
        instance(np.random.Generator, rng=3)


def test_what_is_shown_of_a_value_is_short() -> None:
    class Odd:
        def __repr__(self) -> str:
            raise RuntimeError

    assert shown("x" * 1000) == "a str"
    assert shown(np.zeros((3, 4))) == "an array of shape (3, 4) and type float64"
    assert shown(Odd()) == "a Odd"
    assert shown(10**5000) == "a int"
    assert shown([1, 2]) == "[1, 2]"


T = TypeVar("T")
Row = TypeAliasType("Row", Sequence[T], type_params=(T,))
Numbers = TypeAliasType("Numbers", NDArray[np.float64])


@checked
def named(row: Row[int] = (), numbers: Numbers | None = None) -> tuple[object, object]:
    return row, numbers


def test_aliases_of_types_are_read_as_what_they_stand_for() -> None:  # NumPy's own are such aliases since 2.5
    row, numbers = named([1, np.int64(2)], [1, 2])  # type: ignore[arg-type]
    assert row == (1, 2) and isinstance(numbers, np.ndarray) and numbers.dtype == float
    with pytest.raises(InvalidSetting, match="row: expected a list, each entry a whole number"):
        named("ab")  # type: ignore[arg-type]
    with pytest.raises(InvalidSetting, match="numbers: expected an array of numbers or None"):
        named((), "ab")  # type: ignore[arg-type]
