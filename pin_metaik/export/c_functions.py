"""Statements of the kernels, in Python, to C."""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping
from typing import Any

from pin_metaik.errors import CannotExport
from pin_metaik.export.c_expressions import ELEMENTS, Expressions, Program, symbol
from pin_metaik.export.c_types import ATOM, COMPLEX, NOTHING, WHOLE, Array, Group, Kind, Value, literal
from pin_metaik.export.parsed import source_of

INDENT = "    "


class Body(Expressions):
    """The statements of one function.

    Attributes:
        lines: Its text.
        ahead: What is declared at its beginning.
        result: What it gives; None as long as it has not returned.
    """

    def __init__(
        self,
        program: Program,
        tree: ast.FunctionDef,
        scope: Mapping[str, Any],
        names: dict[str, Value],
        outer: Body | None = None,
    ) -> None:
        super().__init__(program, scope, names, set() if outer is None else outer.written)
        self.lines: list[str] = [] if outer is None else outer.lines
        self.ahead: list[str] = [] if outer is None else outer.ahead
        self.taken: set[str] = {one.text for one in names.values()} if outer is None else outer.taken
        self.indent: str = INDENT if outer is None else outer.indent
        self.result: Kind | None = None
        self.given: Value | None = None  # what an inlined function gives
        self.outer = outer
        self.blocks: list[list[ast.stmt]] = [tree.body]
        self.occurrences = _occurrences(tree.body)
        self.read = _occurrences(tree.body, ast.Load)

    def run(self, statements: list[ast.stmt]) -> None:
        """Translate statements in a row."""
        for one in statements:
            self.add(one)

    def add(self, statement: ast.stmt) -> None:
        """Translate a statement."""
        match statement:
            case ast.Expr(value=ast.Constant()):
                pass  # what the function is for
            case ast.Expr(value=value):
                self.write_line(f"{self.value(value).text};")
            case ast.Return(value=value):
                self._return(value)
            case ast.Assign(targets=targets, value=value):
                self._assign(targets, value)
            case ast.AugAssign(target=target, op=op, value=value):
                self._change(target, op, self.value(value))
            case ast.If():
                self._if(statement)
            case ast.For(target=ast.Name(id=name), iter=over, body=body, orelse=[]):
                self._for(name, over, body)
            case ast.While(test=test, body=body, orelse=[]):
                self._block(f"while ({self.value(test).text}) {{", body)
                self.write_line("}")
            case ast.Break():
                self.write_line("break;")
            case ast.Continue():
                self.write_line("continue;")
            case _:
                raise CannotExport(f"no C is known for {ast.unparse(statement)!r}")

    def write_line(self, text: str) -> None:
        """Add a line."""
        self.lines.append(self.indent + text)

    def room(self, kind: Array) -> Value:
        """A new array in the function."""
        name = self._new("room")
        self.write_line(f"{kind.element.name} {name}[{max(1, kind.count)}];")
        return Value(name, kind)

    def inlined(self, function: Callable[..., Any], given: list[Value]) -> Value:
        """What a function makes that gives arrays of its own."""
        tree, scope = source_of(function)
        names = {argument.arg: one for argument, one in zip(tree.args.args, given, strict=True)}
        inner = Body(self.program, tree, scope, names, self)
        inner.run(tree.body)
        assert inner.given is not None
        return inner.given

    def _return(self, node: ast.expr | None) -> None:
        if node is None:
            self.result = NOTHING
            self.write_line("return;")
            return
        if self.outer is not None:
            self.given = self.value(node)
            return
        if isinstance(node, ast.Tuple):
            parts = [self.value(one) for one in node.elts]
            self.result = self.result or Group(tuple(one.kind for one in parts))
            assert isinstance(self.result, Group)
            texts = [self.held(one, kind) for one, kind in zip(parts, self.result.kinds, strict=True)]
            self.write_line(f"return {self.filled(self.result, texts)};")
            return
        value = self.value(node)
        self.result = self.result or value.kind
        self.write_line(f"return {self.held(value, self.result)};")

    def _assign(self, targets: list[ast.expr], node: ast.expr) -> None:
        if isinstance(targets[0], ast.Name) and (kind := self.outside(node)) in ELEMENTS:  # a name for a type
            self.scope = {**self.scope, targets[0].id: kind}
            return
        if len(targets) > 1 or not isinstance(targets[0], ast.Tuple):
            value = self.value(node)
            for target in targets:
                self._set(target, value)
            return
        names = targets[0].elts
        if isinstance(node, ast.Tuple):
            parts = [self.value(one) for one in node.elts]
            if _depends(names, node.elts):  # all are read before one is written
                parts = [self._kept(part) for part in parts]
        else:
            whole = self.value(node)
            tuple_kind = whole.kind
            if not isinstance(tuple_kind, Group):
                raise CannotExport(f"{ast.unparse(node)!r} is no tuple")
            whole = whole if isinstance(node, ast.Name) else self._kept(whole)
            parts = [Value(tuple_kind.member(whole.text, k), kind) for k, kind in enumerate(tuple_kind.kinds)]
        for target, part in zip(names, parts, strict=True):
            if not (isinstance(target, ast.Name) and not self.read.get(target.id)):
                self._set(target, part)

    def _kept(self, value: Value) -> Value:
        """A value in a variable of its own."""
        name = self._new("held")
        self.write_line(f"{self.program.typed(value.kind, name)} = {value.text};")
        return Value(name, value.kind)

    def _set(self, target: ast.expr, value: Value) -> None:
        """Assign to a variable, an entry, or all of an array."""
        if not isinstance(target, ast.Name):
            self._set_entry(target, value)
            return
        name = target.id
        if not self.read.get(name):
            self.write_line(f"(void)({value.text});")
            return
        if name in self.names:
            variable = self.names[name]
            self.write_line(f"{variable.text} = {self.held(value, variable.kind)};")
            return
        text = self._new(name, name)
        declared = self.program.typed(value.kind, text)
        self.names[name] = Value(text, value.kind)
        if _occurrences(self.blocks[-1]).get(name) == self.occurrences[name]:
            self.write_line(f"{declared} = {value.text};")
        else:
            self.ahead.append(f"{INDENT}{declared};")
            self.write_line(f"{text} = {value.text};")

    def _set_entry(self, target: ast.expr, value: Value) -> None:
        place = self.value(target)
        self._write_to(target)
        if isinstance(place.kind, Array):  # a whole array, entry by entry
            at = self._new("at")
            if not isinstance(value.kind, Array) or value.kind.shape != place.kind.shape:
                raise CannotExport(f"{value.text} has not the shape of {place.text}")
            self.write_line(f"for (long {at} = 0; {at} < {place.kind.count}; {at}++) {{")
            self.write_line(f"{INDENT}{place.under(ATOM)}[{at}] = {value.under(ATOM)}[{at}];")
            self.write_line("}")
            return
        self.write_line(f"{place.text} = {self.held(value, place.kind)};")

    def _write_to(self, target: ast.expr) -> None:
        assert isinstance(target, ast.Subscript)
        self.write(self.value(target.value))

    def _change(self, target: ast.expr, op: ast.operator, value: Value) -> None:
        place = self.value(target)
        if not isinstance(target, ast.Name):
            self._write_to(target)
        changed = self.held(self.binary(place, op, value), place.kind)
        if isinstance(op, ast.Add | ast.Sub | ast.Div) or (isinstance(op, ast.Mult) and value.kind != COMPLEX):
            self.write_line(f"{place.text} {symbol(op)}= {value.text};")
        else:
            self.write_line(f"{place.text} = {changed};")

    def _if(self, statement: ast.If) -> None:
        self._block(f"if ({self.value(statement.test).text}) {{", statement.body)
        rest = statement.orelse
        while rest:
            match rest:
                case [ast.If(test=test, body=body, orelse=orelse)]:
                    self._block(f"}} else if ({self.value(test).text}) {{", body)
                    rest = orelse
                case _:
                    self._block("} else {", rest)
                    rest = []
        self.write_line("}")

    def _block(self, head: str, statements: list[ast.stmt]) -> None:
        self.write_line(head)
        self.blocks.append(statements)
        self.indent += INDENT
        self.run(statements)
        self.indent = self.indent[: -len(INDENT)]
        self.blocks.pop()

    def _for(self, name: str, over: ast.expr, body: list[ast.stmt]) -> None:
        match over:
            case ast.Call(func=ast.Name(id="range"), args=arguments):
                given = [self.value(one) for one in arguments]
                first, last = (literal(0), given[0]) if len(given) == 1 else (given[0], given[1])
                step = given[2].known if len(given) == 3 else 1
                way = {1: ("<", "++"), -1: (">", "--")}[step]
                head = f"for (long {name} = {first.text}; {name} {way[0]} {last.text}; {name}{way[1]}) {{"
                self._loop(name, Value(name, WHOLE), head, [], body)
            case _:
                values, at = self.value(over), self._new("at")
                match values.kind:
                    case Group() as kind if kind.even:
                        count, one, entry = len(kind.kinds), kind.kinds[0], kind.member(self._kept(values).text, at)
                    case Array(shape=(int() as count,), element=one):
                        entry = f"{values.under(ATOM)}[{at}]"
                    case _:
                        raise CannotExport(f"no C is known for a loop over {ast.unparse(over)!r}")
                head = f"for (long {at} = 0; {at} < {count}; {at}++) {{"
                self._loop(name, Value(name, one), head, [f"{self.program.typed(one, name)} = {entry};"], body)

    def _loop(self, name: str, variable: Value, head: str, first: list[str], body: list[ast.stmt]) -> None:
        """A loop whose variable is its own."""
        before = self.names.get(name)
        self.names[name] = variable
        self.write_line(head)
        self.blocks.append(body)
        self.indent += INDENT
        for line in first:
            self.write_line(line)
        self.run(body)
        self.indent = self.indent[: -len(INDENT)]
        self.blocks.pop()
        self.write_line("}")
        del self.names[name]
        if before is not None:
            self.names[name] = before

    def _new(self, name: str, wanted: str = "") -> str:
        """A name that nothing else in the function has."""
        number = 1
        text = wanted or f"{name}_1"
        while text in self.taken:
            number += 1
            text = f"{name}_{number}"
        self.taken.add(text)
        return text


def _occurrences(statements: list[ast.stmt], context: type[ast.expr_context] = ast.expr_context) -> dict[str, int]:
    """How often each name stands in statements."""
    count: dict[str, int] = {}
    for statement in statements:
        for node in ast.walk(statement):
            if isinstance(node, ast.Name) and isinstance(node.ctx, context):
                count[node.id] = count.get(node.id, 0) + 1
    return count


def _depends(targets: list[ast.expr], values: list[ast.expr]) -> bool:
    """Whether something that is assigned to is read for what is assigned after it."""
    assigned: set[str] = set()
    for target, value in zip(targets, values, strict=True):
        if assigned & {node.id for node in ast.walk(value) if isinstance(node, ast.Name)}:
            return True
        whole = target
        while isinstance(whole, ast.Subscript | ast.Attribute):
            whole = whole.value
        assert isinstance(whole, ast.Name)
        assigned.add(whole.id)
    return False
