"""Odd arguments at every public door: what comes back is a result or a ``MetaIKError``, never anything else.

    python benchmarks/door.py [--calls 20000] [--seed 0] [--out PAGE]

Every function, constructor and method that the public modules offer is called as ``door_calls.py`` has it, with one
argument, or several, replaced by something odd: another type, another shape, nothing, NaN, a number far too large.
"""

from __future__ import annotations

import argparse
import contextlib
import datetime
import enum
import inspect
import os
import pickle
import resource
import signal
import tempfile
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
from door_calls import CALLS, MODULES, OWNERS, PATIENT, REGISTRIES, chain, scene
from hypothesis import strategies as st

import pin_metaik as mik
from pin_metaik.errors import MetaIKError

LATE = 5.0  # s; a call that takes longer hangs
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


class Hangs(BaseException):
    """A call that did not come back in time."""


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


@dataclass(frozen=True)
class Fault:
    """A call that raised something else, or did not come back."""

    door: str
    changed: str
    error: str
    trace: str

    def __str__(self) -> str:
        return f"{self.door}({self.changed}): {self.error.splitlines()[0]}"


def knock(door: Door, odd: dict[str, Any]) -> Fault | None:
    """Call a door with some arguments replaced; None for a result or a ``MetaIKError``."""
    changed = ", ".join(f"{name}={_shown(value)}" for name, value in odd.items())
    error = _raised(door, odd)
    if isinstance(error, Hangs):
        error = _raised(door, odd)  # the first time it may have compiled
    if error is None or isinstance(error, MetaIKError):
        return None
    said = f"hangs for {LATE:g} s" if isinstance(error, Hangs) else f"{type(error).__name__}: {error}"
    return Fault(door.name, changed, said, "".join(traceback.format_exception(error)))


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


@contextlib.contextmanager
def alarm(seconds: float) -> Iterator[None]:
    """Raise ``Hangs`` in what takes longer."""

    def ring(*_: object) -> None:
        raise Hangs

    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def listed() -> Iterator[tuple[Door, dict[str, Any]]]:
    """Every argument of every door replaced by every odd value of the list, one at a time."""
    for door in doors().values():
        for parameter in CALLS[door.name]():
            for make in ODD:
                value = make()
                if applicable(parameter, value):
                    yield door, {parameter: value}


def _shown(value: object) -> str:
    try:
        text = repr(value).replace("\n", " ")
    except ValueError:  # an integer of more digits than Python prints
        text = "an integer too long to print"
    return text if len(text) < 80 else text[:77] + "..."


@contextlib.contextmanager
def elsewhere() -> Iterator[None]:
    """In a folder of its own, with bounded memory, and nothing printed."""
    before = Path.cwd()
    limits = resource.getrlimit(resource.RLIMIT_AS)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        resource.setrlimit(resource.RLIMIT_AS, (ROOM, limits[1]))
        try:
            yield
        finally:
            resource.setrlimit(resource.RLIMIT_AS, limits)
            os.chdir(before)


def sweep(todo: list[tuple[Door, dict[str, Any]]], report: Callable[[Fault], None]) -> None:
    """Knock at all of them in processes of their own: what kills one is a fault, and the next goes on behind it."""
    at = 0
    while at < len(todo):
        reader, writer = os.pipe()
        child = os.fork()
        if child == 0:
            os.close(reader)
            with os.fdopen(writer, "wb") as out:
                for i in range(at, len(todo)):
                    pickle.dump((i, None), out)
                    out.flush()
                    fault = knock(*todo[i])
                    if fault is not None:
                        pickle.dump((i, fault), out)
                        out.flush()
            os._exit(0)
        os.close(writer)
        with os.fdopen(reader, "rb") as back, contextlib.suppress(EOFError):
            while True:
                at, fault = pickle.load(back)
                if fault is not None:
                    report(fault)
        _, status = os.waitpid(child, 0)
        if status:
            door, odd = todo[at]
            changed = ", ".join(f"{name}={_shown(value)}" for name, value in odd.items())
            report(Fault(door.name, changed, f"the process ends with status {status}", ""))
        at += 1


def main() -> None:
    """Knock, count, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--calls", type=int, default=20_000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", default="")
    parser.add_argument("--out", type=Path)
    options = parser.parse_args()
    rng = np.random.default_rng(options.seed)
    with elsewhere():
        for door in doors().values():  # compiles what there is to compile, and finds calls that are not good
            if options.only in door.name:
                door.call(dict(CALLS[door.name]()))
        todo = [entry for entry in listed() if options.only in entry[0].name]
        if options.calls < len(todo):
            todo = [todo[i] for i in np.sort(rng.choice(len(todo), options.calls, replace=False))]
        faults, began = list[Fault](), time.perf_counter()
        sweep(todo, faults.append)
        seconds = time.perf_counter() - began
    for fault in faults:
        print(fault)
    print(len(todo), "calls", len(faults), "faults", f"{seconds:.1f} s")
    print(Counter(f.door for f in faults).most_common(400))


if __name__ == "__main__":
    main()
