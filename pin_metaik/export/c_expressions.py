"""Expressions of the kernels, in Python, to C."""

from __future__ import annotations

import ast
import builtins
import cmath
import inspect
import math
from collections.abc import Callable, Mapping
from typing import Any, Protocol

import numpy as np

from pin_metaik.errors import CannotExport
from pin_metaik.export.c_types import (
    ATOM,
    CHOICE,
    COMPARISON,
    COMPLEX,
    FLAG,
    FOREVER,
    NUMBER,
    PRODUCT,
    SIGN,
    SUM,
    WHOLE,
    Array,
    Group,
    Kind,
    Scalar,
    Structure,
    Value,
    literal,
    wider,
)
from pin_metaik.export.parsed import source_of

OPERATORS: dict[type[ast.AST], str] = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.And: "&&", ast.Or: "||",
    ast.Eq: "==", ast.NotEq: "!=", ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=",
    ast.USub: "-", ast.Not: "!",
}  # fmt: skip
CALLS: dict[Any, tuple[str, Scalar]] = {
    math.sqrt: ("sqrt", NUMBER), math.exp: ("exp", NUMBER), math.cos: ("cos", NUMBER), math.sin: ("sin", NUMBER),
    math.atan2: ("atan2", NUMBER), math.copysign: ("copysign", NUMBER), math.isfinite: ("isfinite", FLAG),
    cmath.sqrt: ("csqrt", COMPLEX), cmath.log: ("clog", COMPLEX), cmath.acos: ("cacos", COMPLEX),
    np.round: ("nearbyint", NUMBER), np.ceil: ("ceil", NUMBER), np.floor: ("floor", NUMBER),
    np.int64: ("(long)", WHOLE), float: ("(double)", NUMBER),
}  # fmt: skip
EXTREMES = {min: "lesser", max: "greater"}
PARTS = {"real": ("creal", NUMBER), "imag": ("cimag", NUMBER), "conjugate": ("conj", COMPLEX)}
ELEMENTS = {np.complex128: COMPLEX, np.int64: WHOLE, np.float64: NUMBER}


class Program(Protocol):
    """What expressions need of the program that they belong to."""

    def structure(self, kind: Kind) -> str:
        """The name of a type, whose definition is written."""

    def typed(self, kind: Kind, name: str) -> str:
        """The declaration of a variable."""

    def named(self, called: type, kinds: list[Kind]) -> Structure:
        """The type of a named tuple with fields of these types."""

    def call(self, function: Callable[..., Any], kinds: list[Kind]) -> tuple[str, Kind, list[bool]]:
        """Name and result of a function for arguments of these types, and whether it writes to each."""


class Expressions:
    """Expressions of one function.

    Attributes:
        program: What they are part of.
        scope: What names mean outside of the function.
        names: The variables so far.
        written: Parameters whose entries are written.
    """

    def __init__(self, program: Program, scope: Mapping[str, Any], names: dict[str, Value], written: set[str]) -> None:
        self.program, self.scope, self.names, self.written = program, scope, names, written

    def room(self, kind: Array) -> Value:
        """A new array in the function."""
        raise NotImplementedError

    def inlined(self, function: Callable[..., Any], given: list[Value]) -> Value:
        """What a function makes that gives arrays of its own."""
        raise NotImplementedError

    def value(self, node: ast.expr) -> Value:
        """An expression."""
        match node:
            case ast.Constant(value=constant):
                return literal(constant)
            case ast.Name(id=name) if name in self.names:
                return self.names[name]
            case ast.Name() | ast.Attribute() if (known := self.outside(node)) is not None:
                return known if isinstance(known, Value) else literal(known)
            case ast.Attribute(value=whole, attr=name):
                return self._attribute(self.value(whole), name)
            case ast.Subscript(value=whole, slice=index):
                return self._entry(self.value(whole), index)
            case ast.Tuple(elts=elements):
                parts = [self.value(one) for one in elements]
                all_known = tuple(one.known for one in parts)
                return self.group(parts, None if None in all_known else all_known)
            case ast.Call(func=function, args=arguments, keywords=[]):
                return self._call(function, arguments)
            case ast.UnaryOp(op=op, operand=operand):
                inner = self.value(operand)
                if isinstance(op, ast.USub) and inner.known is not None:
                    return literal(-inner.known)
                kind = FLAG if isinstance(op, ast.Not) else inner.kind
                return Value(symbol(op) + inner.under(ATOM), kind, rank=SIGN)
            case ast.BinOp(left=left, op=op, right=right):
                return self.binary(self.value(left), op, self.value(right))
            case ast.BoolOp(op=op, values=values):
                flags = [self.value(one) for one in values]
                if all(one.kind == FLAG for one in flags):
                    return Value(f" {symbol(op)} ".join(one.under(SIGN) for one in flags), FLAG, rank=COMPARISON)
            case ast.Compare(left=left, ops=ops, comparators=others):
                return self._compared([self.value(one) for one in (left, *others)], ops)
            case ast.IfExp(test=test, body=body, orelse=orelse):
                a, b = self.value(body), self.value(orelse)
                kind = wider(a.kind, b.kind)
                chosen = f"{self.value(test).under(SIGN)} ? {self.held(a, kind)} : {self.held(b, kind)}"
                return Value(chosen, kind, rank=CHOICE)
        raise CannotExport(f"no C is known for {ast.unparse(node)!r}")

    def outside(self, node: ast.expr) -> Any:
        """A number or function that a name has outside of the function; None if it is a value within."""
        match node:
            case ast.Name(id=name) if name not in self.names:
                found = self.scope.get(name, getattr(builtins, name, None))
            case ast.Attribute(value=ast.Name(id=module), attr=name) if inspect.ismodule(self.scope.get(module)):
                found = getattr(self.scope[module], name)
            case _:
                return None
        return self._of_known(found) if isinstance(found, tuple) else found

    def _of_known(self, known: Any) -> Value:
        """A number or a tuple of numbers that is known."""
        return self.group([literal(one) for one in known], known) if isinstance(known, tuple) else literal(known)

    def group(self, parts: list[Value], known: Any = None) -> Value:
        """A tuple."""
        kind = Group(tuple(one.kind for one in parts))
        return Value(self.filled(kind, [one.text for one in parts]), kind, known)

    def held(self, value: Value, kind: Kind) -> str:
        """A value as another type that holds it: C converts numbers by itself, but no structures."""
        if value.kind == kind or isinstance(kind, Scalar):
            if wider(value.kind, kind) != kind:
                raise CannotExport(f"{value.text} does not fit into {kind}")
            return value.text
        raise CannotExport(f"{value.text} is not of type {kind}")

    def filled(self, kind: Group | Structure, texts: list[str]) -> str:
        """A structure with these values."""
        inside = ", ".join(texts)
        name = self.program.structure(kind)
        return f"({name}){{{{{inside}}}}}" if isinstance(kind, Group) and kind.even else f"({name}){{{inside}}}"

    def _attribute(self, whole: Value, name: str) -> Value:
        match whole.kind:
            case Structure() as fields:
                return Value(f"{whole.text}.{name}", fields[name])
            case Array(shape=shape) if name == "shape":
                return self.group([literal(length) for length in shape], shape)
            case Scalar() if name in PARTS:
                part, kind = PARTS[name]
                return Value(f"{part}({whole.text})", kind)
        raise CannotExport(f"no C is known for {name!r} of {whole.text}")

    def _entry(self, whole: Value, index: ast.expr) -> Value:
        """An entry of a tuple or an array, or a row of it, or what a slice leaves of it."""
        if isinstance(whole.kind, Group):
            return self._one_of(whole, whole.kind, index)
        if not isinstance(whole.kind, Array):
            raise CannotExport(f"no C is known for entries of {whole.text}")
        if isinstance(index, ast.Slice):
            return self._slice(whole, whole.kind, index)
        given = self.value(index)
        if isinstance(given.known, tuple):
            places = [literal(one) for one in given.known]
        else:
            places = [self.value(one) for one in index.elts] if isinstance(index, ast.Tuple) else [given]
        kind, offset = whole.kind, literal(0)
        for place in places:
            offset = self.binary(offset, ast.Add(), self.binary(place, ast.Mult(), literal(kind.size)))
            kind = kind.row
        if kind.shape:
            return whole._replace(kind=kind) if offset.known == 0 else self.moved(whole, offset, kind)
        return Value(f"{whole.under(ATOM)}[{offset.text}]", kind.element)

    def _one_of(self, whole: Value, kind: Group, index: ast.expr) -> Value:
        """A member of a tuple, or some of one that is known."""
        if isinstance(index, ast.Slice):
            first, last, step = (None if one is None else self.value(one).known for one in _parts(index))
            if whole.known is None:
                raise CannotExport(f"no C is known for a slice of {whole.text}")
            return self._of_known(whole.known[first:last:step])
        at = self.value(index)
        if at.known is None and not kind.even:
            raise CannotExport(f"which of {whole.text} {at.text} takes is not known beforehand")
        if at.known is None or whole.known is None:
            return Value(kind.member(whole.under(ATOM), at.text), kind.kinds[at.known or 0])
        return self._of_known(whole.known[at.known])

    def _slice(self, whole: Value, kind: Array, index: ast.Slice) -> Value:
        first = 0 if index.lower is None else self.value(index.lower).known
        last = kind.shape[0] if index.upper is None else self.value(index.upper).known
        if first is None or last is None or index.step is not None:
            raise CannotExport(f"a slice of {whole.text} has bounds that are not known beforehand")
        part = Array(kind.element, (last - first, *kind.shape[1:]), kind.origin)
        return self.moved(whole, literal(first * kind.size), part) if first else whole._replace(kind=part)

    def moved(self, whole: Value, offset: Value, kind: Array) -> Value:
        """What begins so many entries further on."""
        return Value(f"{whole.under(SUM)} + {offset.under(PRODUCT)}", kind, rank=SUM)

    def binary(self, a: Value, op: ast.operator, b: Value) -> Value:
        """Two values with an operator between them; as a number, where both are known."""
        if a.known is not None and b.known is not None:
            text = ast.unparse(ast.BinOp(ast.Name("a"), op, ast.Name("b")))
            return literal(eval(text, {"a": a.known, "b": b.known}))
        kind = wider(a.kind, b.kind)
        if kind == WHOLE and isinstance(op, ast.Mult | ast.Add):
            neutral = 1 if isinstance(op, ast.Mult) else 0
            if neutral in (a.known, b.known):
                return b if a.known == neutral else a
        match op:
            case ast.Mod() if kind == WHOLE:
                return Value(f"modulo({a.text}, {b.text})", WHOLE)
            case ast.FloorDiv() if kind == WHOLE:
                return Value(f"quotient({a.text}, {b.text})", WHOLE)
            case ast.Pow() if kind == NUMBER:
                return Value(f"pow({a.text}, {b.text})", NUMBER)
            case ast.Mult() if a.kind == b.kind == COMPLEX:
                return Value(f"times({a.text}, {b.text})", COMPLEX)
            case ast.Div() if kind == WHOLE:
                return Value(f"(double){a.under(ATOM)} / {b.under(SIGN)}", NUMBER, rank=PRODUCT)
        if isinstance(op, ast.BitAnd):
            return Value(f"{a.under(SIGN)} & {b.under(SIGN)}", kind, rank=COMPARISON)
        rank = PRODUCT if isinstance(op, ast.Mult | ast.Div) else SUM
        return Value(f"{a.under(rank)} {symbol(op)} {b.under(rank - 1)}", kind, rank=rank)

    def _compared(self, values: list[Value], ops: list[ast.cmpop]) -> Value:
        pairs = zip(values, ops, values[1:], strict=False)
        parts = [f"{a.under(SUM)} {symbol(op)} {b.under(SUM)}" for a, op, b in pairs]
        return Value(" && ".join(parts), FLAG, rank=COMPARISON)

    def _call(self, function: ast.expr, arguments: list[ast.expr]) -> Value:
        called = self.outside(function)
        if called is None:
            if isinstance(function, ast.Attribute) and function.attr in PARTS:
                return self._attribute(self.value(function.value), function.attr)
            raise CannotExport(f"no C is known for {ast.unparse(function)!r}")
        if called is np.empty:
            shape = self.value(arguments[0]).known
            element = self.outside(arguments[1]) if len(arguments) > 1 else np.float64
            return self.room(Array(ELEMENTS[element], shape if isinstance(shape, tuple) else (shape,)))
        given = [self.value(one) for one in arguments]
        if called is abs:
            return Value(f"fabs({given[0].text})", NUMBER)
        if called is complex:
            return Value(f"complex_of({given[0].text}, {given[1].text})", COMPLEX) if len(given) > 1 else given[0]
        if called in EXTREMES:
            text = given[0].text
            for one in given[1:]:
                text = f"{EXTREMES[called]}({text}, {one.text})"
            return Value(text, NUMBER)
        if called in CALLS:
            name, kind = CALLS[called]
            return Value(f"{name}({', '.join(one.text for one in given)})", kind)
        if hasattr(called, "_fields"):
            return self._structure(called, given)
        return self._own(called, given)

    def _structure(self, called: type, given: list[Value]) -> Value:
        """A named tuple. Arrays of parameters that it takes count as written, unless the class is one of constants."""
        kind = self.program.named(called, [one.kind for one in given])
        for (_, wanted), one in zip(kind.fields, given, strict=True):
            if isinstance(wanted, Array) and not wanted.origin:
                self.write(one)
        return Value(self.filled(kind, [one.text for one in given]), kind)

    def _own(self, called: Callable[..., Any], given: list[Value]) -> Value:
        if gives_arrays(called):
            return self.inlined(called, given)
        name, kind, writes = self.program.call(called, [one.kind for one in given])
        for one, written in zip(given, writes, strict=True):
            if written:
                self.write(one)
        return Value(f"{name}({', '.join(one.text for one in given)})", kind)

    def write(self, value: Value) -> None:
        """Note that entries of an array are written."""
        if isinstance(value.kind, Array):
            if value.kind.origin == FOREVER:
                raise CannotExport(f"{value.text} is constant")
            self.written.add(value.kind.origin)


def symbol(op: ast.AST) -> str:
    """An operator in C."""
    if type(op) not in OPERATORS:
        raise CannotExport(f"no C is known for the operator {type(op).__name__}")
    return OPERATORS[type(op)]


def _parts(index: ast.Slice) -> tuple[ast.expr | None, ast.expr | None, ast.expr | None]:
    return index.lower, index.upper, index.step


def gives_arrays(function: Callable[..., Any]) -> bool:
    """Whether a function makes arrays and gives them, which a function of C cannot."""
    tree, scope = source_of(function)
    return isinstance(tree.returns, ast.Name) and hasattr(scope.get(tree.returns.id), "_fields")
