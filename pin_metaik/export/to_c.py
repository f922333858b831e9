"""Functions of the kernels, in Python, to C99.

They are translated as they are called, like numba does: each for the types of its arguments, with the shapes of arrays
in them, and those that it calls before it. Constants are written as numbers. Arrays that a function makes lie on the
stack; those of a function that gives a named tuple of new arrays belong to its caller.
"""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Callable
from typing import Any

from pin_metaik.errors import CannotExport
from pin_metaik.export.c_functions import INDENT, Body
from pin_metaik.export.c_types import FOREVER, NOTHING, Array, Group, Kind, Scalar, Structure, Value
from pin_metaik.export.parsed import source_of

HELPERS = {  # what C has no operator for, or has it at the price of infinities that do not occur
    "complex_of": """static Complex complex_of(double real, double imag)
{
    union { double parts[2]; Complex z; } both = {{real, imag}};
    return both.z;
}""",
    "times": """static Complex times(Complex a, Complex b)
{
    double p = creal(a), q = cimag(a), r = creal(b), s = cimag(b);
    return complex_of(p * r - q * s, p * s + q * r);
}""",
    "lesser": """static double lesser(double a, double b)
{
    return b < a ? b : a;
}""",
    "greater": """static double greater(double a, double b)
{
    return b > a ? b : a;
}""",
    "modulo": """static long modulo(long a, long b)
{
    return (a % b + b) % b;
}""",
    "quotient": """static long quotient(long a, long b)
{
    return (a - (a % b + b) % b) / b;
}""",
}
COMPLEX_HEADER = """#include <complex.h>
#undef complex /* names of variables and fields below */
#undef I

typedef double _Complex Complex;
"""


class Translation:
    """One program, as its functions are translated.

    Attributes:
        constant: Named tuples whose arrays are never written.
        structures: The definitions of structures, by name.
        functions: Name and result of each function, and whether it writes to its arguments, by it and their types.
        code: The functions, those that are called before those that call them.
    """

    def __init__(self, constant: tuple[type, ...]) -> None:
        self.constant = constant
        self.structures: dict[str, str] = {}
        self.functions: dict[tuple[Callable[..., Any], tuple[Kind, ...]], tuple[str, Kind, list[bool]]] = {}
        self.code: list[str] = []
        self.named_so: Counter[str] = Counter()

    @property
    def text(self) -> str:
        """All of it, with what it needs before it."""
        body = "\n\n".join(self.code)
        for name, definition in reversed(self.structures.items()):
            body = f"{definition}\n\n{body}" if re.search(rf"\b{name}\b", body) else body
        used = {name for name in HELPERS if re.search(rf"\b{name}\(", body)}
        used |= {"complex_of"} if "times" in used else set()
        head = ["#include <math.h>", COMPLEX_HEADER] if "Complex" in body else ["#include <math.h>\n"]
        return "\n".join(head) + "\n" + "\n\n".join([*(HELPERS[name] for name in HELPERS if name in used), body])

    def structure(self, kind: Kind) -> str:
        """The name of a type, whose definition is written."""
        match kind:
            case Scalar(name=name):
                return name
            case Group(kinds=kinds):
                name = _name(kind)
                members = (
                    [f"{self.structure(kinds[0])} v[{len(kinds)}];"]
                    if kind.even
                    else [f"{self.typed(one, f'm{k}')};" for k, one in enumerate(kinds)]
                )
            case Structure(name=name, fields=fields):
                members = [f"{_marked(self.typed(one, field), set())};" for field, one in fields]
            case _:
                raise CannotExport(f"no structure is {kind}")
        definition = f"typedef struct {{\n{''.join(f'{INDENT}{member}{chr(10)}' for member in members)}}} {name};"
        if self.structures.setdefault(name, definition) != definition:
            raise CannotExport(f"there are two structures {name!r}")
        return name

    def typed(self, kind: Kind, name: str) -> str:
        """The declaration of a variable; of an array with a mark for its origin, which tells whether it is constant."""
        if isinstance(kind, Array):
            return f"@{kind.origin}@{kind.element.name} *{name}"
        return f"{self.structure(kind)} {name}"

    def named(self, called: type, kinds: list[Kind]) -> Structure:
        """The type of a named tuple with fields of these types."""
        origin = FOREVER if called in self.constant else ""
        own = [Array(kind.element, kind.shape, origin) if isinstance(kind, Array) else kind for kind in kinds]
        names: tuple[str, ...] = called._fields  # type: ignore[attr-defined]
        return Structure(called.__name__, tuple(zip(names, own, strict=True)))

    def call(self, function: Callable[..., Any], kinds: list[Kind]) -> tuple[str, Kind, list[bool]]:
        """Name and result of a function for arguments of these types, and whether it writes to each."""
        key = function, tuple(kinds)
        if key not in self.functions:
            self.functions[key] = self._translated(function, kinds)
        return self.functions[key]

    def _translated(self, function: Callable[..., Any], kinds: list[Kind]) -> tuple[str, Kind, list[bool]]:
        tree, scope = source_of(function)
        parameters = [argument.arg for argument in tree.args.args]
        own = [
            Array(kind.element, kind.shape, name) if isinstance(kind, Array) else kind
            for name, kind in zip(parameters, kinds, strict=True)
        ]
        names = {name: Value(name, kind) for name, kind in zip(parameters, own, strict=True)}
        body = Body(self, tree, scope, names)
        body.run(tree.body)
        result = body.result or NOTHING
        given = ", ".join(self.typed(kind, name) for name, kind in zip(parameters, own, strict=True))
        unused = [f"{INDENT}(void){name};" for name in parameters if not body.read.get(name)]
        self.named_so[tree.name] += 1
        number = self.named_so[tree.name]
        name = tree.name if number == 1 else f"{tree.name}_{number}"
        text = [f"static {self.structure(result)} {name}({given})", "{", *unused, *body.ahead, *body.lines, "}"]
        self.code.append(_comment(tree) + _marked("\n".join(text), body.written))
        return name, result, [parameter in body.written for parameter in parameters]


def _name(kind: Kind) -> str:
    """A name for a tuple, of what it holds: D3 for three numbers, D3x2 for two of these."""
    match kind:
        case Scalar(letter=letter):
            return letter
        case Group(kinds=kinds) if kind.even:
            first = _name(kinds[0])
            return f"{first}x{len(kinds)}" if isinstance(kinds[0], Group) else f"{first}{len(kinds)}"
        case Group(kinds=kinds):
            return "_".join(["Of", *map(_name, kinds)])
    raise CannotExport(f"a tuple of {kind} has no name")


def _marked(text: str, written: set[str]) -> str:
    """Text with the marks of arrays resolved: what belongs to a parameter is constant, unless that is written to."""
    return re.sub(r"@(.*?)@", lambda mark: "" if mark[1] == "" or mark[1] in written else "const ", text)


def _comment(tree: ast.FunctionDef) -> str:
    lines = (ast.get_docstring(tree) or "").splitlines()
    return "/* " + "\n".join([*lines[:1], *(f" * {line}".rstrip() for line in lines[1:])]) + " */\n"
