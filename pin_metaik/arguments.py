"""Arguments of public functions, converted to the types of their annotations, or refused with what would have worked.

The types of a public function's arguments are written once, in its annotations. ``checked`` applies them: lists become
the annotated tuples and arrays, strings become paths, and anything else is refused before any work begins. Ranges and
shapes, which depend on more than one argument, are checked in the function's first lines, with ``array`` below and the
checks of ``optimize.settings``.
"""

from __future__ import annotations

import contextlib
import math
import operator
import types
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from collections.abc import Set as AbstractSet
from functools import wraps
from inspect import signature
from numbers import Real
from pathlib import Path
from typing import Any, Literal, TypeVar, Union, cast, get_args, get_origin, get_type_hints

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.errors import InvalidSetting, MetaIKError

Door = TypeVar("Door", bound=Callable[..., Any])
Read = Callable[[Any], Any]

LONGEST = 60  # characters of a value in a message
EXACT = 2**53  # whole numbers up to it are floats, too; with much larger ones NumPy would make arrays of objects
COUNTS = ("no", "one", "two", "three", "four", "five", "six")

MAKING = {  # what to write where one of these is asked for
    "Box": "mik.Box(lower, upper), the box of a search",
    "Budget": "mik.Budget(evaluations=2000)",
    "Chain": "mik.Chain(robot, robot.frame)",
    "CollisionWorld": "mik.CollisionWorld(robot, obstacles)",
    "DesignTask": "stewart.DesignTask(ranges)",
    "Generator": "np.random.default_rng(0)",
    "Geometry": "mechanism.geometry",
    "IKProblem": "mik.IKProblem.of(chain, target)",
    "IKSolver": "mik.IKSolver('gwo', 'dls')",
    "LegLimits": "mechanism.limits",
    "Mechanism": "stewart.load_mechanism('stroke_100')",
    "Metaheuristic": "mik.ALGORITHMS['gwo']()",
    "Model": "robot.model",
    "MotionLimits": "mik.MotionLimits.of(chain)",
    "Obstacle": "collision.Obstacle(name, shape, pose)",
    "PathProblem": "mobile.PathProblem.of(scene)",
    "Robot": "mik.load_robot('panda')",
    "Scene": "mobile.load_scene('ten_obstacles')",
    "Suite": "compare.Suite(robots, cases, methods)",
    "TimedPath": "path.timed()",
    "SynchroDrive": "mobile.NOMAD_200",
    "Workspace": "mechanism.survey()",
}


class _Unlike(Exception):
    """A value is not what an annotation says."""


def checked_as(error: type[MetaIKError]) -> Callable[[Door], Door]:
    """A decorator for a function, or for a class by its constructor: arguments are read by their annotations first.

    Every call costs some microseconds; what is called in inner loops looks at its arguments itself.

    Args:
        error: What an argument raises that is not what its annotation says; the message names it.
    """

    def decorate(door: Door) -> Door:
        if not isinstance(door, type):
            return _reading(door, error)
        door.__init__ = _reading(door.__init__, error)  # type: ignore[misc]  # the constructor is the door of a class
        return cast(Door, door)

    return decorate


checked = checked_as(InvalidSetting)


def _reading(door: Door, error: type[MetaIKError]) -> Door:
    names = tuple(signature(door).parameters)
    readers: dict[str, tuple[Read, Any]] = {}

    @wraps(door)
    def reading(*args: Any, **kwargs: Any) -> Any:
        if not readers:  # late: annotations may name what is defined further down
            readers.update({name: (_reader(hint), hint) for name, hint in _hints(door).items()})
        given = [_read(name, value, readers, error) for name, value in zip(names, args, strict=False)]
        named = {name: _read(name, value, readers, error) for name, value in kwargs.items()}
        return door(*given, *args[len(given) :], **named)

    return cast(Door, reading)


def instance(kind: Any, **given: object) -> None:
    """Make sure that arguments are of a class, or of one of several: ``instance(Chain, chain=chain)``.

    Raises:
        InvalidSetting: One of them is not; the message says how one gets one.
    """
    for name, value in given.items():
        if not isinstance(value, kind):
            raise InvalidSetting(f"{name}: expected {_words(kind)}, got {shown(value)}")


def number(name: str, value: object, error: type[MetaIKError] = InvalidSetting) -> float:
    """An argument as a finite number.

    Raises:
        MetaIKError: Of the class ``error``: it is none.
    """
    try:
        finite = _number(value)
    except _Unlike:
        finite = math.nan
    if not math.isfinite(finite):
        raise error(f"{name} is a finite number, got {shown(value)}")
    return finite


def array(
    name: str, value: ArrayLike, *shape: int | str, error: type[MetaIKError] = InvalidSetting, finite: bool = True
) -> NDArray[np.float64]:
    """An argument as an array of floats of a shape: itself, if it is one already.

    Args:
        name: What to call it.
        value: Any numbers.
        shape: Lengths; a word stands for any length, ``"..."`` in front for any leading axes.
        error: What to raise.
        finite: Whether NaN and infinity are refused.

    Raises:
        MetaIKError: Of the class ``error``: not numbers, not finite, or of another shape.
    """
    if type(value) is np.ndarray and value.dtype.char == "d" and value.flags.carray:  # what loops hand on
        have = value.shape
        some = type(shape[0]) is str and have[1 - len(shape) :] == shape[1:] and (shape[0] == "..." or value.ndim == 2)
        if (have == shape or some) and (not finite or math.isfinite(np.add.reduce(value, axis=None))):
            return value
    try:
        numbers = np.asarray(value, dtype=float, order="C")
    except (TypeError, ValueError, OverflowError):
        raise error(f"{name}: expected numbers of shape {_shape(shape)}, got {shown(value)}") from None
    if numbers.shape != shape and not _fits(numbers.shape, shape):
        raise error(f"{name}: expected shape {_shape(shape)}, got {numbers.shape}")
    if finite and not math.isfinite(np.add.reduce(numbers, axis=None)) and not np.isfinite(numbers).all():
        raise error(f"{name}: expected finite numbers, got {shown(value)}")
    return numbers if numbers.flags.writeable else numbers.copy()  # compiled loops take no others


def _shape(shape: tuple[int | str, ...]) -> str:
    return f"({', '.join(map(str, shape))}{',' if len(shape) == 1 else ''})"


def _fits(have: tuple[int, ...], shape: tuple[int | str, ...]) -> bool:
    """Whether an array of the shape ``have`` is of a shape as ``array`` takes it."""
    if shape[:1] == ("...",):
        shape, have = shape[1:], have[len(have) - len(shape) + 1 :] if len(have) >= len(shape) - 1 else ()
    return len(have) == len(shape) and all(isinstance(n, str) or n == m for n, m in zip(shape, have, strict=True))


def shown(value: object) -> str:
    """A value for a message: short, and with its type where that is not plain to see."""
    if isinstance(value, (np.ndarray, np.generic)) and np.ndim(value):
        return f"an array of shape {np.shape(value)} and type {value.dtype}"
    try:
        text = " ".join(repr(value).split())
    except Exception:  # of anybody's class, or a whole number of more digits than Python prints
        return f"a {type(value).__name__}"
    if len(text) > LONGEST:
        return f"a {type(value).__name__}"
    plain = value is None or isinstance(value, (bool, int, float, str, list, tuple, dict, type))
    return text if plain or type(value).__name__ in text else f"{text} (a {type(value).__name__})"


def _read(name: str, value: Any, readers: Mapping[str, tuple[Read, Any]], error: type[MetaIKError]) -> Any:
    if name not in readers:
        return value
    read, hint = readers[name]
    try:
        return read(value)
    except _Unlike as unlike:
        advice = f"; {unlike}" if str(unlike) else ""
        raise error(f"{name}: expected {_words(hint)}, got {shown(value)}{advice}") from None


def _hints(door: Callable[..., Any]) -> dict[str, Any]:
    """What the annotations of arguments say; those of an optional package, known to type checkers only, say nothing."""
    found: dict[str, Any] = {}
    for name, text in door.__annotations__.items():
        with contextlib.suppress(NameError):
            found |= get_type_hints(types.SimpleNamespace(__annotations__={name: text}), door.__globals__)
    return found


def _reader(hint: Any) -> Read:
    """What reads a value as an annotation has it."""
    hint = _meant(hint)
    origin, inside = get_origin(hint), get_args(hint)
    if _free(hint):
        return _anything
    if origin in (Union, types.UnionType):
        return _either([_reader(one) for one in inside])
    if origin is Literal:
        return _one_of(inside)
    if origin is tuple:
        return _tuple([_reader(one) for one in inside if one is not ...], repeated=inside[-1:] == (...,))
    if origin in (list, Sequence, Iterable, Collection):
        return _row(_reader(inside[0]), list if origin is list else tuple)
    if origin in (dict, Mapping):
        return _mapping(*map(_reader, inside))
    if origin is np.ndarray:
        return _array(get_args(inside[1])[0])
    kind = hint if origin is None else origin
    plain = PLAIN.get(kind)
    return plain if plain is not None else _instance(kind)


def _meant(hint: Any) -> Any:
    """What an annotation stands for, if it is a ``type`` of Python 3.12 or later, as NumPy's are since 2.5."""
    origin = get_origin(hint)
    value = getattr(hint if origin is None else origin, "__value__", None)
    if value is None:
        return hint
    return _meant(value if origin is None else value[get_args(hint)])


def _free(hint: Any) -> bool:
    """Whether an annotation takes anything, or what only the function itself can tell: poses and other numbers."""
    hint = _meant(hint)
    if hint is Any or hint is object or isinstance(hint, TypeVar):
        return True
    if get_origin(hint) in (Union, types.UnionType):
        return any(_free(one) for one in get_args(hint))
    kind = get_origin(hint) or hint
    return (getattr(kind, "_is_protocol", False) and not getattr(kind, "_is_runtime_protocol", False)) or (
        getattr(kind, "__name__", "") in ("_SupportsArray", "_NestedSequence", "_Buffer", "Buffer")
    )


def _anything(value: Any) -> Any:
    return value


def _nothing(value: Any) -> None:
    if value is not None:
        raise _Unlike


def _whole(value: Any) -> int:
    if isinstance(value, (bool, np.bool_)):
        raise _Unlike
    try:
        return operator.index(value)
    except TypeError:
        raise _Unlike from None


def _number(value: Any) -> float:
    if isinstance(value, (bool, np.bool_)) or not (isinstance(value, Real) or _scalar(value)):
        raise _Unlike
    try:
        real = float(value)
    except (OverflowError, TypeError, ValueError):
        raise _Unlike from None
    return value if type(value) is int and abs(value) <= EXACT else real


def _scalar(value: Any) -> bool:
    return isinstance(value, np.ndarray) and value.ndim == 0 and value.dtype.kind in "iuf"


def _flag(value: Any) -> bool:
    if isinstance(value, (bool, np.bool_)) or (type(value) is int and value in (0, 1)):
        return bool(value)
    raise _Unlike


def _text(value: Any) -> str:
    if not isinstance(value, str) or "\0" in value:  # no name and no path has a zero byte
        raise _Unlike
    return value


def _path(value: Any) -> Path:
    return value if isinstance(value, Path) else Path(_text(value))


def _called(value: Any) -> Any:
    if not callable(value) or isinstance(value, type):
        raise _Unlike
    return value


PLAIN: dict[Any, Read] = {
    type(None): _nothing,
    None: _nothing,
    bool: _flag,
    int: _whole,
    float: _number,
    str: _text,
    Path: _path,
    Callable: _called,
}


def _either(readers: Sequence[Read]) -> Read:
    def read(value: Any) -> Any:
        for one in readers:
            try:
                return one(value)
            except _Unlike:
                continue
        raise _Unlike

    return read


def _one_of(values: tuple[Any, ...]) -> Read:
    """A closed set is the function's own to know; here it is seen to that a member can be looked for."""
    kinds = tuple({type(value) for value in values})

    def read(value: Any) -> Any:
        if not isinstance(value, kinds):
            raise _Unlike
        return value

    return read


def _items(value: Any) -> list[Any]:
    """What is in a list or the like; a text is one thing, and a mapping has no order that is meant."""
    if isinstance(value, str):
        raise _Unlike(f"of one, write [{value!r}]")
    if isinstance(value, (bytes, Mapping, type)) or not isinstance(value, Iterable):
        raise _Unlike
    try:
        return list(value)
    except Exception:  # an array without axes, or anybody's class that is not what it seems
        raise _Unlike from None


def _tuple(readers: Sequence[Read], repeated: bool) -> Read:
    def read(value: Any) -> tuple[Any, ...]:
        items = _items(value)
        if repeated:
            return tuple(readers[0](item) for item in items)
        if len(items) != len(readers):
            raise _Unlike
        return tuple(one(item) for one, item in zip(readers, items, strict=True))

    return read


def _row(reader: Read, made: Callable[[Iterable[Any]], Any]) -> Read:
    def read(value: Any) -> Any:
        return made(reader(item) for item in _items(value))

    return read


def _mapping(key: Read, entry: Read) -> Read:
    def read(value: Any) -> dict[Any, Any]:
        if not isinstance(value, Mapping):
            raise _Unlike
        return {key(k): entry(v) for k, v in value.items()}

    return read


def _array(kind: Any) -> Read:
    char = np.dtype(kind).char

    def read(value: Any) -> Any:
        if isinstance(value, np.ndarray) and value.dtype.char == char:
            return value
        try:
            numbers = np.asarray(value)
            if numbers.dtype.kind not in "biuf" or (kind is np.bool_ and numbers.dtype.kind != "b" and numbers.size):
                raise _Unlike
            if kind is np.int64 and numbers.dtype.kind == "f" and numbers.size:
                raise _Unlike
            return numbers.astype(kind)
        except (TypeError, ValueError, OverflowError):
            raise _Unlike from None

    return read


def _instance(kind: Any) -> Read:
    collects = kind.__module__ == "collections.abc"  # a text is one thing, though it holds letters

    def read(value: Any) -> Any:
        if not isinstance(value, kind) or (collects and isinstance(value, (str, bytes))):
            raise _Unlike
        return value

    return read


NAMES: dict[Any, str] = {
    type(None): "None",
    None: "None",
    bool: "True or False",
    int: "a whole number",
    float: "a number",
    str: "a text",
    Path: "a path",
    Callable: "a function",
}


def _words(hint: Any) -> str:
    """An annotation in words."""
    hint = _meant(hint)
    origin, inside = get_origin(hint), get_args(hint)
    if origin in (Union, types.UnionType):
        return " or ".join(dict.fromkeys(_words(one) for one in inside))
    if isinstance(hint, tuple):  # of classes, as isinstance takes it
        return " or ".join(map(_words, hint))
    if origin is Literal:
        return f"one of {', '.join(map(repr, inside))}"
    if origin is tuple and inside[-1:] != (...,):
        same = len(set(inside)) == 1
        return f"{COUNTS[len(inside)]} values, each {_words(inside[0])}" if same else f"{COUNTS[len(inside)]} values"
    if origin in (tuple, list, Sequence, Iterable, Collection, AbstractSet):
        return f"a list, each entry {_words(inside[0])}"
    if origin in (dict, Mapping):
        return f"a mapping, each key {_words(inside[0])} and each value {_words(inside[1])}"
    if origin is np.ndarray:
        return "an array of numbers"
    kind = origin or hint
    if kind in NAMES:
        return NAMES[kind]
    making = MAKING.get(kind.__name__)
    article = "an" if kind.__name__[0] in "AEIOU" else "a"
    return f"{article} {kind.__name__}{f' (e.g. {making})' if making else ''}"
