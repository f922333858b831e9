"""A DH table as it is typed: rows of inputs to the TOML that the library reads, and back."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from typing import Any

from pin_metaik.errors import InvalidTable
from pin_metaik.gui.tab import Tab

MOST_ROWS = 24
FIRST = """name = "typed_arm"
convention = "standard"
length = "m"
angle = "deg"

[[joint]]
type = "revolute"
a = 0.4
alpha = 0
d = 0.3
offset = 0
limits = [-170, 170]

[[joint]]
type = "revolute"
a = 0.35
alpha = 0
d = 0
offset = 0
limits = [-150, 150]

[[joint]]
type = "prismatic"
a = 0
alpha = 180
theta = 0
offset = 0
limits = [0, 0.2]
"""
Row = dict[str, Any]


def rows_of(text: str) -> tuple[Row, list[Row]]:
    """What is above the rows of a table's TOML, and its rows; parameters are put in where rows name them.

    Raises:
        InvalidTable: It is not TOML.
    """
    try:
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as reason:
        raise InvalidTable(f"the table is not TOML: {reason}") from None
    parameters = content.pop("parameters", {})
    rows = content.pop("joint", [])
    filled = [{key: _value(value, parameters) for key, value in row.items()} for row in rows]
    return content, filled


def _value(value: Any, parameters: Row) -> Any:
    """A number where a row names a parameter."""
    if isinstance(value, str) and value.removeprefix("-") in parameters:
        number = parameters[value.removeprefix("-")]
        return -number if value.startswith("-") else number
    return value


def to_text(top: Row, rows: list[Row]) -> str:
    """A table as TOML."""
    plain = {key: value for key, value in top.items() if not isinstance(value, dict)}
    lines = [f"{key} = {_toml(value)}" for key, value in plain.items()]
    for key, value in top.items():
        if isinstance(value, dict):
            lines += ["", f"[{key}]", *(f"{name} = {_toml(each)}" for name, each in value.items())]
    for row in rows:
        lines += ["", "[[joint]]", *(f"{key} = {_toml(value)}" for key, value in row.items())]
    return "\n".join(lines) + "\n"


def _toml(value: Any) -> str:
    match value:
        case bool():
            return str(value).lower()
        case str():
            escaped = "".join(c if c.isprintable() and c not in '"\\' else f"\\u{ord(c):04x}" for c in value)
            return f'"{escaped}"'
        case list() | tuple():
            return f"[{', '.join(map(_toml, value))}]"
        case _:
            return repr(value)


class TableForm:
    """Inputs for a DH table. Whatever is typed is put together and handed on at once.

    Args:
        tab: The tab.
        text: The table to begin with.
        changed: Called with the TOML after every change.
    """

    def __init__(self, tab: Tab, text: str, changed: Callable[[str], None]) -> None:
        self._tab, self._gui, self._changed = tab, tab.client.gui, changed
        self._top, self._rows = rows_of(text)
        self._folder: Any = None
        self._holder = self._gui.add_folder(None)
        self._build()

    @property
    def text(self) -> str:
        """The table as TOML."""
        return to_text(self._top, self._rows)

    def _build(self) -> None:
        """Make the inputs anew: there are other rows."""
        gui = self._gui
        if self._folder is not None:
            self._folder.remove()
        with self._holder:
            self._folder = gui.add_folder(None)
        with self._folder:
            for key, options, hint in (
                ("convention", ("standard", "modified"), "After Denavit and Hartenberg, or after Craig."),
                ("length", ("m", "cm", "mm"), "Unit of a, d and of slides."),
                ("angle", ("deg", "rad"), "Unit of alpha, theta and of turns."),
            ):
                self._choice(self._top, key, options, hint)
            base = self._top.get("base", {}) if isinstance(self._top.get("base"), dict) else {}
            self._vector("Base x, y, z", base.get("xyz", (0.0, 0.0, 0.0)), lambda v: self._base("xyz", v))
            self._vector("Base roll, pitch, yaw", base.get("rpy", (0.0, 0.0, 0.0)), lambda v: self._base("rpy", v))
            for number, row in enumerate(self._rows, start=1):
                with gui.add_folder(f"Joint {number}", expand_by_default=number <= 3):
                    self._row(row)
            buttons = gui.add_button_group("Rows", ("Add", "Remove last"))
            buttons.on_click(self._tab.doing(lambda: self._resize(buttons.value)))

    def _row(self, row: Row) -> None:
        kind = self._choice(row, "type", ("revolute", "prismatic"), "Whether the joint turns or slides.")
        fixed = "theta" if kind == "prismatic" else "d"

        def shape(values: tuple[float, ...]) -> None:
            row["a"], row["alpha"], row[fixed] = values

        def ranges(values: tuple[float, ...]) -> None:
            row["offset"], row["limits"] = values[0], list(values[1:])
            row.pop("continuous", None)

        self._vector(f"a, alpha, {fixed}", [row.get(key, 0.0) for key in ("a", "alpha", fixed)], shape)
        turn = 180.0 if self._top.get("angle") == "deg" else 3.141592653589793
        low, high = row.get("limits", (-turn, turn))
        self._vector("zero, lower, upper", [row.get("offset", 0.0), low, high], ranges)

    def _choice(self, into: Row, key: str, options: tuple[str, ...], hint: str) -> str:
        value = str(into.setdefault(key, options[0]))
        value = value if value in options else options[0]
        handle = self._gui.add_dropdown(key, options, initial_value=value, hint=hint)

        def choose() -> None:
            into[key] = handle.value
            if key == "type":
                into.pop("theta" if handle.value == "revolute" else "d", None)
                into.setdefault("d" if handle.value == "revolute" else "theta", 0.0)
                self._build()
            self._changed(self.text)

        handle.on_update(self._tab.doing(choose, "The table is not taken"))
        return value

    def _vector(self, label: str, values: Any, take: Callable[[tuple[float, ...]], None]) -> None:
        try:
            first = tuple(float(value) for value in values)
        except (TypeError, ValueError):
            raise InvalidTable(f"{label}: numbers are needed, got {values!r}") from None
        if len(first) != 3:
            raise InvalidTable(f"{label}: three numbers are needed, got {len(first)}")
        handle = self._gui.add_vector3(label, first, step=0.001)

        def typed() -> None:
            take(handle.value)
            self._changed(self.text)

        handle.on_update(self._tab.doing(typed, "The table is not taken"))

    def _base(self, key: str, values: tuple[float, ...]) -> None:
        base = self._top.setdefault("base", {})
        base[key] = list(values)

    def _resize(self, what: str) -> None:
        """Add a row, or take the last one away."""
        if what == "Add":
            if len(self._rows) >= MOST_ROWS:
                raise InvalidTable(f"a table has at most {MOST_ROWS} rows here")
            self._rows.append(dict(self._rows[-1]))
            self._rows[-1].pop("name", None)
        elif len(self._rows) > 1:
            self._rows.pop()
        self._build()
        self._changed(self.text)
