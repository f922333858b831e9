"""Odd arguments at every public door: what comes back is a result or a ``MetaIKError``, never anything else.

    python benchmarks/door.py [--calls 20000] [--drawn 2000] [--seed 0] [--only NAME] [--out PAGE]

Every function, constructor and method that the public modules offer is called as ``door_calls.py`` has it, with one
argument, or several, replaced by something odd: another type, another shape, nothing, NaN, a number far too large.
"""

from __future__ import annotations

import argparse
import contextlib
import datetime
import enum
import functools
import inspect
import itertools
import os
import platform
import tempfile
import time
import traceback
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

import hypothesis
import numpy as np
import pinocchio as pin
from apart import Hangs, alarm, apart, room
from door_calls import CALLS, MODULES, OWNERS, PATIENT, POSE, REGISTRIES, chain, scene
from hypothesis import strategies as st

import pin_metaik as mik
from pin_metaik.errors import MetaIKError

LATE = 15.0  # s of processor time; a call that takes longer hangs
ROOM = 12 << 30  # bytes of address space: what asks for more gets a MemoryError instead of the machine

INNER = {(f"refine.{kind}", step) for kind in ("LM", "QP", "SDLS", "Newton", "Transpose") for step in ("step", "steps")}
"""Methods that the loop of a refiner calls thousands of times, and nobody else: they trust it."""

ODD: tuple[Callable[[], Any], ...] = (
    lambda: None,
    lambda: True,
    lambda: False,
    lambda: 0,
    lambda: -1,
    lambda: 3,
    lambda: 10**12,
    lambda: 10**400,
    lambda: 0.5,
    lambda: -1e300,
    lambda: 1e308,
    lambda: float("nan"),
    lambda: float("inf"),
    lambda: 1 + 2j,
    lambda: "",
    lambda: "ur5",
    lambda: "no/such/file.toml",
    lambda: "a\0b",
    lambda: b"ur5",
    list,
    lambda: [[]],
    dict,
    lambda: {"ur5": 1},
    lambda: {1: (2, 3)},
    lambda: set("ab"),
    lambda: (),
    lambda: (None, None),
    lambda: [float("nan")] * 3,
    lambda: [1, 2],
    lambda: [[1, 2], [3]],
    lambda: [[1.0, 2.0, 3.0]],
    lambda: ["a", "b", "c"],
    lambda: ["a", 1, None],
    lambda: np.zeros(0),
    lambda: np.zeros((2, 3)),
    lambda: np.zeros((0, 4, 4)),
    lambda: np.full(6, np.nan),
    lambda: np.full((4, 4), np.inf),
    lambda: 2.0 * np.eye(4),
    lambda: np.zeros(6, dtype=complex),
    lambda: np.array(["a", "b"]),
    lambda: np.array([object()], dtype=object),
    lambda: np.float64(2.5),
    lambda: np.int64(7),
    lambda: np.array(3),
    lambda: lambda *_: None,
    lambda: object(),
    lambda: object,
    lambda: iter([1, 2]),
    lambda: range(3),
    lambda: Path("no/such/folder"),
    lambda: Path(),
    lambda: pin.SE3.Identity(),
    lambda: pin.Quaternion.Identity(),
    chain,
    scene,
    lambda: mik.load_robot("rv7fl"),
    lambda: datetime.date(2026, 1, 1),
)


def drawn() -> st.SearchStrategy[Any]:
    """Odd values without a list: numbers, words, arrays and what holds them."""
    numbers = st.one_of(st.integers(-(2**70), 2**70), st.floats(), st.booleans(), st.complex_numbers())
    shapes = st.lists(st.integers(0, 7), max_size=3).map(tuple)
    arrays = st.builds(lambda shape, fill: np.full(shape, fill), shapes, st.floats())
    plain = st.one_of(st.none(), numbers, st.text(max_size=8), st.binary(max_size=4), arrays)
    return st.one_of(
        plain,
        st.lists(plain, max_size=7),
        st.lists(numbers, max_size=7).map(tuple),
        st.dictionaries(st.one_of(st.text(max_size=4), st.integers()), plain, max_size=3),
        st.lists(st.lists(st.floats(), max_size=4), max_size=4),
        st.sampled_from(ODD).map(lambda make: make()),
    )


@dataclass(frozen=True)
class Door:
    """Something public that can be called.

    Attributes:
        name: Its entry in ``CALLS``.
        owner: Whose method it is, an entry of ``OWNERS``; "" for functions and constructors.
        attribute: Of that owner.
        function: What is called, where there is no owner.
    """

    name: str
    owner: str
    attribute: str
    function: Callable[..., Any] | None

    def call(self, arguments: dict[str, Any]) -> object:
        """Call it; of what comes back lazily, take all."""
        function = (
            self.function
            if self.function is not None
            else getattr(OWNERS[self.name if self.name in OWNERS else self.owner](), self.attribute)
        )
        result = function(**arguments)
        return list(result) if inspect.isgenerator(result) else result


def doors() -> dict[str, Door]:
    """Everything that the public modules offer and that a user calls, by its name in ``CALLS``."""
    found: dict[str, Door] = {}
    seen: set[int] = set()
    for place, module in MODULES.items():
        for name in module.__all__:
            thing = getattr(module, name)
            if id(thing) in seen or not callable(thing):
                continue
            seen.add(id(thing))
            for door in _of(f"{place}.{name}", thing):
                found[door.name] = door
    for registry, entries in REGISTRIES.items():
        for key, thing in entries.items():
            if inspect.isclass(thing) and id(thing) not in seen:
                found[f"{registry}.{key}"] = Door(f"{registry}.{key}", "", "", thing)
    return found


def parameters(door: Door) -> set[str]:
    """Names of all that a door takes."""
    function = door.function
    if function is None:
        place, kind, attribute = door.name.split(".")
        function = getattr(getattr(MODULES[place], kind), attribute)
    several = (inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD)
    taken = {
        name for name, parameter in inspect.signature(function).parameters.items() if parameter.kind not in several
    }
    return taken - {"self"}


def _of(name: str, thing: Any) -> Iterator[Door]:
    """A function; or of a class its constructor and methods. What is made for a user to read needs no constructor."""
    if not inspect.isclass(thing):
        yield Door(name, "", "", thing)
        return
    if issubclass(thing, (enum.Enum, BaseException, tuple)) or getattr(thing, "_is_protocol", False):
        return
    if name in CALLS or "__post_init__" in vars(thing) or not hasattr(thing, "__dataclass_fields__"):
        yield Door(name, "", "", thing)
    for attribute, member in vars(thing).items():
        fields = getattr(thing, "__dataclass_fields__", {})
        if attribute in fields or (name, attribute) in INNER or (attribute.startswith("_") and attribute != "__call__"):
            continue
        if isinstance(member, (staticmethod, classmethod)):
            yield Door(f"{name}.{attribute}", "", "", getattr(thing, attribute))
        elif inspect.isfunction(member):
            yield Door(f"{name}.{attribute}", name, attribute, None)


Call = tuple[Door, dict[str, Any]]
"""A door, and what is put in the place of some of its arguments."""


@dataclass(frozen=True)
class Fault:
    """A call that raised something else, or did not come back."""

    door: str
    changed: str
    error: str
    trace: str

    def __str__(self) -> str:
        return f"{self.door}({self.changed}): {self.error.splitlines()[0]}"


@dataclass(frozen=True)
class Knock:
    """What came of a call.

    Attributes:
        seconds: Time taken, s.
        refused: Whether it was a ``MetaIKError``.
        fault: What else it raised, if it did.
    """

    seconds: float
    refused: bool
    fault: Fault | None = None


def knock(door: Door, odd: dict[str, Any]) -> Knock:
    """Call a door with some arguments replaced."""
    began = time.perf_counter()
    error = _raised(door, odd)
    seconds = time.perf_counter() - began
    if error is None or isinstance(error, MetaIKError):
        return Knock(seconds, error is not None)
    said = f"hangs for {LATE:g} s" if isinstance(error, Hangs) else f"{type(error).__name__}: {error}"
    return Knock(seconds, False, Fault(door.name, changed(odd), said, "".join(traceback.format_exception(error))))


def changed(odd: dict[str, Any]) -> str:
    """The arguments that were replaced."""
    return ", ".join(f"{name}={_shown(value)}" for name, value in odd.items())


def _raised(door: Door, odd: dict[str, Any]) -> BaseException | None:
    """What a call raises."""
    try:
        with alarm(LATE), warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            door.call({**CALLS[door.name](), **odd})
    except (Exception, Hangs) as error:
        return error
    return None


def applicable(parameter: str, value: object) -> bool:
    """Whether this is odd there: a search that may take for ever is allowed to."""
    big = isinstance(value, (int, float)) and abs(value) > 1e6
    return not (parameter in PATIENT and big)


def draw(data: st.DataObject) -> Call:
    """A door, and odd values for one to three of its arguments, as hypothesis draws them."""
    door, names = data.draw(st.sampled_from(_with_arguments()), label="door")
    chosen = data.draw(st.lists(st.sampled_from(names), min_size=1, max_size=3, unique=True), label="arguments")
    odd = {name: data.draw(drawn(), label=name) for name in chosen}
    return door, {name: value for name, value in odd.items() if applicable(name, value)}


@functools.cache
def _with_arguments() -> list[tuple[Door, list[str]]]:
    """Every door that takes arguments, and their names."""
    return [(door, sorted(taken)) for door in doors().values() if (taken := CALLS[door.name]())]


def listed(every: int = 1) -> Iterator[Call]:
    """Every argument of every door replaced by every odd value of the list, one at a time; or every so many of that."""
    places = ((door, parameter) for door in doors().values() for parameter in CALLS[door.name]())
    for (door, parameter), make in itertools.islice(itertools.product(places, ODD), 0, None, every):
        value = make()
        if applicable(parameter, value):
            yield door, {parameter: value}


def _shown(value: object) -> str:
    try:
        text = repr(value).replace("\n", " ")
    except ValueError:  # an integer of more digits than Python prints
        text = "an integer too long to print"
    return text if len(text) < 80 else text[:77] + "..."


def warm_up() -> None:
    """Make every good call once, and what takes other compiled loops: nothing is compiled while the alarm is set."""
    for name, door in doors().items():
        door.call(dict(CALLS[name]()))
    for target in ([0.3, 0.3, 0.4], mik.Target(POSE, orientation_tolerance=[0.1, 0.1, 0.1])):
        for solve in (mik.solve_ik, mik.solve_ik_all):
            solve(chain(), target)
        mik.solve_ik_batch(chain(), [target])


@contextlib.contextmanager
def elsewhere() -> Iterator[None]:
    """In a folder of its own, with bounded memory, and nothing printed."""
    before = Path.cwd()
    with tempfile.TemporaryDirectory() as folder, room(ROOM):
        os.chdir(folder)
        try:
            yield
        finally:
            os.chdir(before)


def sweep(todo: list[Call]) -> list[Knock]:
    """Knock at all of them in processes of their own: what kills one is a fault, and the next goes on behind it."""

    def ended(i: int, how: str) -> Knock:
        door, odd = todo[i]
        return Knock(0.0, False, Fault(door.name, changed(odd), how, ""))

    return apart(len(todo), lambda i: knock(*todo[i]), ended, 10.0 * LATE)


def drawn_calls(count: int, seed: int) -> list[Call]:
    """Calls with several arguments replaced, as hypothesis draws them."""
    found: list[Call] = []
    if not count:
        return found

    @hypothesis.seed(seed)
    @hypothesis.settings(
        max_examples=count, deadline=None, database=None, suppress_health_check=[*hypothesis.HealthCheck]
    )
    @hypothesis.given(st.data())
    def collect(data: st.DataObject) -> None:
        found.append(draw(data))

    collect()
    return found


def page(todo: list[Call], done: list[Knock], command: str) -> Iterator[str]:
    """The page on a sweep, line by line."""
    names = ("pin", "numpy", "hypothesis")
    versions = ", ".join(f"{name} {version(name)}" for name in names)
    machine = f"{os.cpu_count()}-core {platform.machine()}, shared, Python {platform.python_version()}, {versions}"
    faults = [knock.fault for knock in done if knock.fault is not None]
    hangs = sum("hangs" in fault.error for fault in faults)
    seconds = sorted(knock.seconds for knock in done)
    middle = seconds[len(seconds) // 2]
    yield "# Odd arguments to every public function"
    yield f"`{command}`, {datetime.date.today()}, {machine}."
    yield (
        f"{len(todo):,} calls of {len(doors())} public functions, constructors and methods with odd arguments: "
        f"**{len(faults)} exceptions outside the family of `MetaIKError`, {hangs} of them hangs** (longer than "
        f"{LATE:g} s). The longest call took {1e3 * seconds[-1]:.0f} ms, the median {1e3 * middle:.2f} ms."
    )
    table = ["| module | functions | calls | results | refused | faults |", "|---|---|---|---|---|---|"]
    by_module: dict[str, list[int]] = {}
    for i, (door, _) in enumerate(todo):
        by_module.setdefault(door.name.partition(".")[0], []).append(i)
    for module, calls in by_module.items():
        refused = sum(done[i].refused for i in calls)
        wrong = sum(done[i].fault is not None for i in calls)
        names_ = {todo[i][0].name for i in calls}
        cells = [len(names_), len(calls), len(calls) - refused - wrong, refused, wrong]
        table.append(f"| {module} | {' | '.join(f'{n:,}' for n in cells)} |")
    yield "\n".join(table)
    if faults:
        yield "\n".join(f"- `{fault}`" for fault in faults)


def main() -> None:
    """Knock, count, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--calls", type=int, default=20_000, help="of the list: one argument replaced")
    parser.add_argument("--drawn", type=int, default=2_000, help="drawn by hypothesis: one to three replaced")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", default="", help="doors whose name holds this")
    parser.add_argument("--out", type=Path)
    options = parser.parse_args()
    out = None if options.out is None else options.out.absolute()
    rng = np.random.default_rng(options.seed)
    with elsewhere():
        warm_up()
        todo = [*listed()]
        if options.calls < len(todo):
            todo = [todo[i] for i in np.sort(rng.choice(len(todo), options.calls, replace=False))]
        todo = [call for call in (*todo, *drawn_calls(options.drawn, options.seed)) if options.only in call[0].name]
        done = sweep(todo)
    command = f"python benchmarks/door.py --calls {options.calls} --drawn {options.drawn} --seed {options.seed}"
    text = "\n\n".join(page(todo, done, command)) + "\n"
    print(text)
    if out is not None:
        out.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
