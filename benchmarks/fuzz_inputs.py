"""Odd files from good ones: trees with odd values and structure, in any syntax, and bytes that were changed.

A tree is what JSON, TOML and YAML hold, or XML as ``[tag, {attribute: text}, [child or text, ...]]``. Everything is
decided by a ``random.Random``: the same number, the same file.
"""

from __future__ import annotations

import copy
import json
import math
import re
import tomllib
from collections.abc import Callable, Sequence
from random import Random
from typing import Any
from xml.dom import minidom
from xml.sax.saxutils import escape, quoteattr

Tree = Any
DEEP = 3_000  # levels of a tree that no parser's recursion should trust
LONG = 30_000  # characters
HUGE, NESTED = "a whole number of 5000 digits", "lists in lists"
"""What stands in a tree for values that Python would not write."""

ODD: tuple[Callable[[], Tree], ...] = (
    lambda: None,
    lambda: True,
    lambda: 0,
    lambda: -1,
    lambda: 3,
    lambda: 1e-320,
    lambda: 1e308,
    lambda: -1e308,
    lambda: 1e18,
    lambda: 10**9,
    lambda: 2**63,
    lambda: 10**400,
    lambda: HUGE,
    lambda: NESTED,
    lambda: math.nan,
    lambda: math.inf,
    lambda: "",
    lambda: " ",
    lambda: "nan",
    lambda: "1e999",
    lambda: "1,5",
    lambda: "x" * LONG,
    lambda: "é\u202e\U0001f600",
    lambda: "\ud800",
    lambda: "a\0b",
    lambda: "\x1b[31m\n",
    lambda: "../../../../../../etc/passwd",
    lambda: "/dev/zero",
    lambda: "~nobody/x",
    lambda: "package://a/../../b.stl",
    lambda: "${pi}",
    lambda: "%s{0}",
    list,
    dict,
    lambda: [[]],
    lambda: [1, 2],
    lambda: [[1, 2], [3]],
    lambda: [0.0] * 3,
    lambda: list(range(1000)),
    lambda: {"a": {"b": 1}},
)
NUMBER = re.compile(rb"[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?")
NUMBERS = (
    b"0",
    b"-1",
    b"1e308",
    b"-1e308",
    b"1e-320",
    b"nan",
    b"inf",
    b"4294967296",
    b"1e999",
    b"9" * 5000,
    b"0x1F",
    b"",
)
PIECES = (
    b"\0",
    b"\xff",
    b"\xef\xbb\xbf",
    b"\r",
    b"\n",
    b"<",
    b">",
    b'"',
    b"{",
    b"}",
    b"[",
    b"]",
    b"<!--",
    b"]]>",
    b"&a;",
)


def odd_tree(tree: Tree, rnd: Random) -> Tree:
    """A copy of a tree with one to four changes."""
    root = [copy.deepcopy(tree)]
    for _ in range(rnd.choice((1, 1, 1, 2, 4))):
        places = [place for place in _places(root) if place[0] is not root] or [(root, 0)]
        holder, key = rnd.choice(places)
        other, at = rnd.choice(places)
        match rnd.randrange(8):
            case 0 | 1 | 2:
                holder[key] = rnd.choice(ODD)()
            case 3:
                del holder[key]
                root = root or [None]
            case 4:
                holder[key] = copy.deepcopy(other[at])
            case 5 if isinstance(holder, list):
                holder.insert(rnd.randint(0, len(holder)), copy.deepcopy(holder[key]))
            case 5:
                holder[str(key) + rnd.choice("sX_ ")] = holder.pop(key)
            case 6 if isinstance(holder[key], (int, float)) and abs(holder[key]) < 10**300:
                holder[key] *= rnd.choice((-1, 0, 2, 1e3, 1e-9, 1e30))
            case 6:
                holder[key], other[at] = other[at], holder[key]
            case _:
                holder[key] = [holder[key]]
    return root[0]


def _places(holder: Tree) -> list[tuple[Any, Any]]:
    """Every holder and key of a tree."""
    found, waiting = list[tuple[Any, Any]](), [holder]
    while waiting and len(found) < 2_000:
        one = waiting.pop()
        keys = range(len(one)) if isinstance(one, list) else list(one)
        for key in keys:
            found.append((one, key))
            if isinstance(one[key], (list, dict)):
                waiting.append(one[key])
    return found


def odd_bytes(seeds: Sequence[bytes], rnd: Random) -> bytes:
    """One of the seeds with one to six changes of bytes."""
    data = bytearray(rnd.choice(seeds))
    for _ in range(rnd.choice((1, 1, 2, 3, 6))):
        at, size = rnd.randint(0, len(data)), rnd.choice((1, 1, 4, 16, 200))
        match rnd.randrange(10):
            case 0:
                del data[at:]
            case 1:
                del data[at : at + size]
            case 2:
                data[at:at] = data[at : at + size] * rnd.choice((1, 2, 50))
            case 3:
                data[at : at + 1] = bytes([rnd.randrange(256)])
            case 4:
                data[at:at] = rnd.choice(PIECES)
            case 5 | 6 if numbers := list(NUMBER.finditer(data)):
                number = rnd.choice(numbers)
                data[number.start() : number.end()] = rnd.choice(NUMBERS)
            case 7:
                other = rnd.choice(seeds)
                start = rnd.randint(0, len(other))
                data[at : at + size] = other[start : start + size]
            case 8:
                data[at:at] = rnd.randbytes(size)
            case _ if len(data) > 1:
                lines = bytes(data).split(b"\n")
                rnd.shuffle(lines)
                data = bytearray(b"\n".join(lines))
    return bytes(data)


def as_json(tree: Tree) -> str:
    """A tree as JSON, which is YAML too."""
    return _filled(json.dumps(tree), "9" * 5000, "[" * DEEP + "]" * DEEP)


def as_toml(tree: Tree) -> str:
    """A tree as TOML: a line a key, tables and lists inline."""
    if not isinstance(tree, dict):
        return _inline(tree)
    text = "".join(f"{json.dumps(str(key))} = {_inline(value)}\n" for key, value in tree.items())
    return _filled(text, "0x" + "f" * 4000, "[" * DEEP + "]" * DEEP)


def _filled(text: str, huge: str, nested: str) -> str:
    """The text with the values that stand-ins stand for."""
    return text.replace(json.dumps(HUGE), huge).replace(json.dumps(NESTED), nested)


def as_xml(tree: Tree) -> str:
    """A tree of XML as text; what is no element is its text."""
    if tree == NESTED:
        return "<x>" * DEEP + "</x>" * DEEP
    if not (isinstance(tree, list) and len(tree) == 3 and isinstance(tree[1], dict) and isinstance(tree[2], list)):
        return escape(_text(tree))
    tag = str(tree[0]) if not isinstance(tree[0], (list, dict)) else "x"
    attributes = "".join(f" {key}={quoteattr(_text(value))}" for key, value in tree[1].items())
    return f"<{tag}{attributes}>{''.join(map(as_xml, tree[2]))}</{tag}>"


def xml_tree(text: bytes) -> Tree:
    """XML as a tree; prefixes stay in the names."""

    def tree_of(node: minidom.Node) -> Tree:
        inside = [tree_of(one) if one.nodeType == one.ELEMENT_NODE else one.nodeValue for one in node.childNodes]
        return [node.tagName, dict(node.attributes.items()), inside]

    return tree_of(minidom.parseString(text).documentElement)


def toml_tree(text: bytes) -> Tree:
    """TOML as a tree."""
    return tomllib.loads(text.decode())


def _inline(tree: Tree) -> str:
    match tree:
        case None:
            return '""'
        case bool():
            return str(tree).lower()
        case float() if not math.isfinite(tree):
            return "nan" if math.isnan(tree) else "inf"
        case list():
            return f"[{', '.join(map(_inline, tree))}]"
        case dict():
            return f"{{{', '.join(f'{json.dumps(str(key))} = {_inline(value)}' for key, value in tree.items())}}}"
        case str():
            return json.dumps(tree)
        case _:
            return str(tree)


def _text(value: Tree) -> str:
    """A value as text."""
    return "9" * 5000 if value == HUGE else str(value)
