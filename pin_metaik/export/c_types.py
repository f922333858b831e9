"""Types of C for what the kernels have: numbers, arrays of known shape, tuples, and named tuples of arrays.

An array is a pointer to its first entry, as C keeps rows one after the other. A tuple is a structure that is passed by
value.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, NamedTuple, TypeAlias

from pin_metaik.errors import CannotExport

FOREVER = "!"  # the origin of arrays that are never written


@dataclass(frozen=True)
class Scalar:
    """A number: its name in C, and a letter for the names of structures."""

    name: str
    letter: str


NUMBER, COMPLEX = Scalar("double", "D"), Scalar("Complex", "Z")
WHOLE, FLAG = Scalar("long", "L"), Scalar("int", "B")
NOTHING = Scalar("void", "")
WIDTHS = (FLAG, WHOLE, NUMBER, COMPLEX)  # each holds what the ones before it do


@dataclass(frozen=True)
class Array:
    """An array.

    Attributes:
        element: What it holds.
        shape: How many, by axis; None where it is not known, which only the first may be.
        origin: The parameter whose entries these are, which decides whether they are constant; "": they are not.
    """

    element: Scalar
    shape: tuple[int | None, ...]
    origin: str = field(default="", compare=False)

    @property
    def row(self) -> Array:
        """What one index leaves of it."""
        return Array(self.element, self.shape[1:], self.origin)

    @property
    def size(self) -> int:
        """How many entries one index skips."""
        return math.prod(length or 0 for length in self.shape[1:])

    @property
    def count(self) -> int:
        """How many entries it has."""
        if None in self.shape:
            raise CannotExport("an array of unknown length is not taken as a whole")
        return math.prod(length or 0 for length in self.shape)


@dataclass(frozen=True)
class Group:
    """A tuple of these."""

    kinds: tuple[Kind, ...]

    @property
    def even(self) -> bool:
        """Whether they are all of one type: then it holds an array of them."""
        return len(set(self.kinds)) == 1

    def member(self, whole: str, k: int | str) -> str:
        """The one numbered k of a value of this type."""
        return f"{whole}.v[{k}]" if self.even else f"{whole}.m{k}"


@dataclass(frozen=True)
class Structure:
    """A named tuple."""

    name: str
    fields: tuple[tuple[str, Kind], ...]

    def __getitem__(self, name: str) -> Kind:
        return dict(self.fields)[name]


Kind: TypeAlias = Scalar | Array | Group | Structure


class Value(NamedTuple):
    """An expression in C, its type, what it is where that is known beforehand, and how tightly it holds together."""

    text: str
    kind: Kind
    known: Any = None
    rank: int = 0

    def under(self, rank: int) -> str:
        """It as an operand, in parentheses if it holds together less than this."""
        return self.text if self.rank <= rank else f"({self.text})"


ATOM, SIGN, PRODUCT, SUM, COMPARISON, CHOICE = range(6)  # ranks, the tightest first


def wider(a: Kind, b: Kind) -> Kind:
    """The type that holds values of both."""
    if isinstance(a, Scalar) and isinstance(b, Scalar):
        return WIDTHS[max(WIDTHS.index(a), WIDTHS.index(b))]
    if isinstance(a, Group) and isinstance(b, Group) and len(a.kinds) == len(b.kinds):
        return Group(tuple(wider(one, other) for one, other in zip(a.kinds, b.kinds, strict=True)))
    if a != b:
        raise CannotExport(f"no type of C holds both {a} and {b}")
    return a


def literal(value: Any) -> Value:
    """A number that is known, as an expression."""
    match value:
        case bool():
            return Value(str(int(value)), FLAG, value)
        case int():
            return Value(str(value), WHOLE, value, ATOM if value >= 0 else SIGN)
        case float():
            text = "INFINITY" if math.isinf(value) else repr(abs(value))
            return Value(text if value >= 0.0 else f"-{text}", NUMBER, value, ATOM if value >= 0.0 else SIGN)
        case complex():
            return Value(f"complex_of({value.real!r}, {value.imag!r})", COMPLEX, value)
    raise CannotExport(f"no C is known for {value!r}")
