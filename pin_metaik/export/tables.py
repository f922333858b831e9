"""Numbers of one arm as constants in C."""

from __future__ import annotations

import textwrap
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pin_metaik.export.c_types import COMPLEX, NUMBER, WHOLE, Array, Kind

ELEMENTS = {"f": NUMBER, "i": WHOLE, "c": COMPLEX}
WIDTH = 120


class Table(NamedTuple):
    """An argument of a function: an array, or a number as one without axes."""

    name: str
    values: NDArray[Any]

    @property
    def kind(self) -> Kind:
        """Its type."""
        element = ELEMENTS[self.values.dtype.kind]
        return Array(element, self.values.shape) if self.values.ndim else element


def tables_of(fields: Any) -> list[Table]:
    """The fields of a named tuple, by their names in capitals."""
    return [Table(name.upper(), np.asarray(value)) for name, value in fields._asdict().items()]


def as_declared(table: Table) -> str:
    """The definition of a constant, arrays row after row."""
    numbers = [_number(one) for one in np.ravel(table.values).tolist()]
    element = ELEMENTS[table.values.dtype.kind].name
    if not table.values.ndim:
        return f"static const {element} {table.name} = {numbers[0]};"
    inside = textwrap.fill(", ".join(numbers) or "0", WIDTH, initial_indent="    ", subsequent_indent="    ")
    return f"static const {element} {table.name}[{max(1, len(numbers))}] = {{\n{inside}\n}};"


def _number(value: complex) -> str:
    return f"{value.real!r}{value.imag:+}*_Complex_I" if isinstance(value, complex) else repr(value)
