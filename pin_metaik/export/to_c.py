"""Functions of plain numbers and tuples, in Python, to C.

They have what the closed form of an arm has: tuples of numbers, which become structures of an array; tuples of these
and flags, which become structures with a member each; assignments, also of several at once; if, return, and
expressions.
"""

from __future__ import annotations

import ast
from collections.abc import Mapping
from typing import Any

from pin_metaik.errors import CannotExport

NUMBER, FLAG, WHOLE = "double", "int", "long"
MATH = {"math.sqrt": "sqrt", "math.atan2": "atan2", "math.copysign": "copysign", "min": "fmin", "max": "fmax"}
MATH |= {"np.round": "nearbyint", "np.ceil": "ceil", "np.floor": "floor", "float": "", "abs": "fabs"}
OPERATORS: dict[type[ast.AST], str] = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.BitAnd: "&", ast.USub: "-", ast.And: "&&",
    ast.Or: "||", ast.Eq: "==", ast.NotEq: "!=", ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Not: "!",
}  # fmt: skip
NAMES = {"float": NUMBER, "bool": FLAG, "int": WHOLE, "Vector": "T3", "Turn": "T2"}
LENGTHS = {"pose": "T12", "guess": "T6", "x": "T6"}  # of what is annotated as numbers, by name


class Translation:
    """One program, as its functions are translated.

    Attributes:
        numbers: The value of each constant, by the expression that names it, such as ``form[LEVEL]``.
        returns: The type that each function gives, by name.
        structures: The definitions of structures, by name.
        code: The functions.
    """

    def __init__(self, numbers: Mapping[str, Any]) -> None:
        self.numbers = numbers
        self.returns: dict[str, str] = {"cos_sin": "T2", "vector": "T3"}
        self.structures = {f"T{n}": f"typedef struct {{ double v[{n}]; }} T{n};" for n in (2, 3, 6, 12)}
        self.code: list[str] = []

    def add(self, function: ast.FunctionDef) -> None:
        """Translate a function; those that it calls come before it."""
        names = [argument.arg for argument in function.args.args]
        kinds = [self._named(argument.annotation, argument.arg) for argument in function.args.args]
        known = {name: kind for name, kind in zip(names, kinds, strict=True) if kind}
        result = self._named(function.returns, "angles" if function.name == "branch" else "")
        self.returns[function.name] = result
        body = Body(self, dict(known), result)
        for statement in function.body[1:]:  # the first is what it is for
            body.add(statement)
        given = ", ".join(f"{kind} {name}" for name, kind in known.items())
        note = f"/* {ast.get_docstring(function)} */"
        self.code.append("\n".join([note, f"static {result} {function.name}({given})", "{", *body.lines, "}"]))

    def _named(self, annotation: ast.expr | None, name: str) -> str:
        """The type of an annotation; none for the closed form, whose numbers are known."""
        if isinstance(annotation, ast.Subscript):  # tuple[...]
            assert isinstance(annotation.slice, ast.Tuple)
            return self.structure([self._named(one, name) for one in annotation.slice.elts])
        assert isinstance(annotation, ast.Name)
        if annotation.id == "Floats":
            return ""
        return LENGTHS.get(name, "T6") if annotation.id == "Numbers" else NAMES[annotation.id]

    def structure(self, kinds: list[str]) -> str:
        """The type of a tuple of values of these types."""
        if all(kind == NUMBER for kind in kinds):
            return f"T{len(kinds)}"
        name = "S_" + "_".join(kinds)
        members = " ".join(f"{kind} m{k};" for k, kind in enumerate(kinds))
        self.structures[name] = f"typedef struct {{ {members} }} {name};"
        return name


class Body:
    """The statements of one function."""

    def __init__(self, program: Translation, known: dict[str, str], result: str) -> None:
        self.program, self.known, self.result = program, known, result
        self.lines = [f"    (void){name};" for name in known]
        self.spare = 0

    def add(self, statement: ast.stmt, indent: str = "    ") -> None:
        """Translate a statement."""
        match statement:
            case ast.Return(value=ast.expr() as value):
                self.lines.append(f"{indent}return {self.value(value)[0]};")
            case ast.Assign(targets=[target], value=value):
                self._assign(target, value, indent)
            case ast.If(test=test, body=body, orelse=orelse):
                for name in _assigned([*body, *orelse]):
                    self._declare_ahead(name, [*body, *orelse], indent)
                self.lines.append(f"{indent}if ({self.value(test)[0]}) {{")
                for one in body:
                    self.add(one, indent + "    ")
                if orelse:
                    self.lines.append(f"{indent}}} else {{")
                for one in orelse:
                    self.add(one, indent + "    ")
                self.lines.append(f"{indent}}}")
            case _:
                raise CannotExport(f"no C is known for {ast.unparse(statement)!r}")

    def _declare_ahead(self, name: str, statements: list[ast.stmt], indent: str) -> None:
        """Declare what a branch assigns, unless it is known: its type is that of the first assignment."""
        if name in self.known:
            return
        trial = Body(self.program, dict(self.known), self.result)
        for statement in statements:
            trial.add(statement)
            if name in trial.known:
                break
        self.known[name] = trial.known[name]
        self.lines.append(f"{indent}{self.known[name]} {name};")

    def _assign(self, target: ast.expr, value: ast.expr, indent: str) -> None:
        if isinstance(target, ast.Name):
            self._set(target.id, *self.value(value), indent)
            return
        assert isinstance(target, ast.Tuple)
        if isinstance(value, ast.Tuple):
            parts = [self.value(one) for one in value.elts]
        else:
            text, kind = self.value(value)
            whole = self._spare(text, kind, indent)
            parts = [self._member(whole, kind, k) for k in range(len(target.elts))]
        held = [(self._spare(text, kind, indent), kind) for text, kind in parts]  # all are read before one is written
        for one, (text, kind) in zip(target.elts, held, strict=True):
            assert isinstance(one, ast.Name)
            self._set(one.id, text, kind, indent)

    def _set(self, name: str, text: str, kind: str, indent: str) -> None:
        declared = "" if name in self.known else f"{kind} "
        self.known.setdefault(name, kind)
        self.lines.append(f"{indent}{declared}{name} = {text};")

    def _spare(self, text: str, kind: str, indent: str) -> str:
        self.spare += 1
        self.lines.append(f"{indent}{kind} s{self.spare}_{len(indent)} = {text};")
        return f"s{self.spare}_{len(indent)}"

    def _member(self, whole: str, kind: str, k: int) -> tuple[str, str]:
        if kind.startswith("T"):
            return f"{whole}.v[{k}]", NUMBER
        fields = self.program.structures[kind].partition("{ ")[2].partition(" }")[0].split("; ")
        return f"{whole}.m{k}", fields[k].split(" ")[0]

    def value(self, node: ast.expr) -> tuple[str, str]:
        """An expression, and its type."""
        text = ast.unparse(node)
        if text in self.program.numbers:
            return _literal(self.program.numbers[text])
        match node:
            case ast.Constant(value=bool() as flag):
                return str(int(flag)), FLAG
            case ast.Constant(value=int() as whole):
                return str(whole), WHOLE
            case ast.Constant(value=float() as number):
                return repr(number), NUMBER
            case ast.Name(id=name):
                return name, self.known[name]
            case ast.Subscript(value=ast.Name(id=name), slice=ast.Constant(value=int() as k)):
                return self._member(name, self.known[name], k)
            case ast.Tuple(elts=elements):
                parts = [self.value(one) for one in elements]
                kind = self.program.structure([kind for _, kind in parts])
                inside = ", ".join(text for text, _ in parts)
                return f"({kind}){{{{{inside}}}}}" if kind[0] == "T" else f"({kind}){{{inside}}}", kind
            case ast.Call(func=function, args=arguments):
                return self._call(ast.unparse(function), arguments)
            case ast.UnaryOp(op=op, operand=operand):
                text, kind = self.value(operand)
                return f"({OPERATORS[type(op)]}{text})", kind
            case ast.BinOp(left=left, op=op, right=right):
                (a, kind), (b, other) = self.value(left), self.value(right)
                return f"({a} {OPERATORS[type(op)]} {b})", NUMBER if NUMBER in (kind, other) else kind
            case ast.BoolOp(op=op, values=values):
                return "(" + f" {OPERATORS[type(op)]} ".join(self.value(one)[0] for one in values) + ")", FLAG
            case ast.Compare(left=left, ops=[op], comparators=[right]):
                return f"({self.value(left)[0]} {OPERATORS[type(op)]} {self.value(right)[0]})", FLAG
            case ast.IfExp(test=test, body=body, orelse=orelse):
                text, kind = self.value(body)
                return f"({self.value(test)[0]} ? {text} : {self.value(orelse)[0]})", kind
        raise CannotExport(f"no C is known for {ast.unparse(node)!r}")

    def _call(self, name: str, arguments: list[ast.expr]) -> tuple[str, str]:
        given = ", ".join(self.value(one)[0] for one in arguments if ast.unparse(one) != "form")
        if name in MATH:
            return f"{MATH[name]}({given})", NUMBER
        return f"{name}({given})", self.program.returns[name]


def _assigned(statements: list[ast.stmt]) -> list[str]:
    """Names that statements give a value, in their order."""
    stored = [
        node.id
        for statement in statements
        for node in ast.walk(statement)
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)
    ]
    return list(dict.fromkeys(stored))


def _literal(value: Any) -> tuple[str, str]:
    """A constant in C: a number, or a tuple of them."""
    if isinstance(value, tuple):
        return f"(T{len(value)}){{{{{', '.join(repr(float(one)) for one in value)}}}}}", f"T{len(value)}"
    return repr(float(value)), NUMBER
