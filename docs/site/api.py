"""The reference: a page for each module with an ``__all__``, its public names in their order, from their docstrings.

What ``pin_metaik`` itself exports is on its page, and not again on that of the module it comes from.
"""

from __future__ import annotations

import importlib
import inspect
import re
from pathlib import Path
from types import ModuleType
from typing import Any

MODULES = (
    "pin_metaik",
    "pin_metaik.ik.goals",
    "pin_metaik.ik",
    "pin_metaik.collision",
    "pin_metaik.collision.viewer",
    "pin_metaik.kinematics",
    "pin_metaik.robots",
    "pin_metaik.motion",
    "pin_metaik.timing",
    "pin_metaik.planning",
    "pin_metaik.reachable",
    "pin_metaik.reachable.viewer",
    "pin_metaik.mobile",
    "pin_metaik.stewart",
    "pin_metaik.export",
    "pin_metaik.optimize",
    "pin_metaik.learn",
    "pin_metaik.compare",
    "pin_metaik.errors",
    "pin_metaik.interrupts",
)


def names(module: ModuleType) -> tuple[list[str], list[str]]:
    """The public names of a module: those that its page describes, and those that the page of ``pin_metaik`` does."""
    listed = getattr(module, "__all__", None)
    if listed is None:
        listed = [name for name, value in vars(module).items() if inspect.isclass(value) and name[0].isupper()]
        listed = [name for name in listed if getattr(module, name).__module__ == module.__name__]
    listed = [name for name in listed if not inspect.ismodule(getattr(module, name))]
    top = importlib.import_module("pin_metaik")
    exported = [name for name in listed if module is not top and getattr(top, name, None) is getattr(module, name)]
    return [name for name in listed if name not in exported], exported


def page(name: str) -> str:
    """A module's page in reStructuredText."""
    module = importlib.import_module(name)
    public, exported = names(module)
    about = inspect.cleandoc(module.__doc__ or "").partition("\n")[0]
    lines = [name, "=" * len(name), "", about, ""]
    if exported:
        lines += ["Described with ``pin_metaik``: " + ", ".join(f":obj:`~pin_metaik.{each}`" for each in exported), ""]
    lines += [f".. currentmodule:: {name}", "", ".. autosummary::", "   :nosignatures:", ""]
    lines += [f"   {each}" for each in public if callable(getattr(module, each))]
    for each in public:
        lines += ["", each, "-" * len(each), "", *_entry(each, getattr(module, each))]
    return "\n".join(lines) + "\n"


def _entry(name: str, value: object) -> list[str]:
    """The directives that document a name."""
    match value:
        case type() if issubclass(value, BaseException):
            return [f".. autoexception:: {name}"]
        case type():
            return [f".. autoclass:: {name}"]
        case dict():
            return [f".. data:: {name}", "", f"   By name: {', '.join(f'``{key}``' for key in value)}."]
        case _ if inspect.isroutine(value):
            return [f".. autofunction:: {name}"]
        case _:
            return [f".. data:: {name}", "", f"   ``{value!r}``"]


def _write(app: Any, _config: Any) -> None:
    folder = Path(app.srcdir, "docs", "api", "generated")
    folder.mkdir(parents=True, exist_ok=True)
    for name in MODULES:
        _put(folder / f"{name}.rst", page(name))
    tree = "".join(f"   {name}\n" for name in MODULES)
    _put(folder / "index.rst", f"API reference\n=============\n\n.. toctree::\n   :maxdepth: 1\n\n{tree}")


def _put(file: Path, text: str) -> None:
    """Write a file unless it is so already: what has not changed is not built again."""
    if not file.exists() or file.read_text(encoding="utf-8") != text:
        file.write_text(text, encoding="utf-8")


def _public(app: Any, env: Any, node: Any, content: Any) -> Any:
    """Where a type is documented: under its public name, which is not that of the file it is written in."""
    target = node.get("reftarget", "").rpartition(".")[2]
    for name in MODULES if node.get("refdomain") == "py" else ():
        if target in names(importlib.import_module(name))[0]:
            domain = env.get_domain("py")
            found = domain.objects.get(f"{name}.{target}")
            if found is not None:
                builder, here = app.builder, node.get("refdoc", env.docname)
                return domain.resolve_xref(env, here, builder, "obj", f"{name}.{target}", node, content)
    return None


def _escape(_app: Any, _what: str, _name: str, _value: Any, _options: Any, lines: list[str]) -> None:
    """Norms, |x|, and types that end in an underscore are no markup."""
    for number, line in enumerate(lines):
        parts = line.split("``")
        parts[::2] = [part.replace("|", "\\|") for part in parts[::2]]
        lines[number] = "``".join(parts)
        if line.lstrip().startswith(":vartype"):
            lines[number] = re.sub(r"_(?=\W|$)", r"\\_", line)


def setup(app: Any) -> dict[str, bool]:
    """Write the pages before Sphinx looks for its sources."""
    app.connect("autodoc-process-docstring", _escape, priority=600)  # after napoleon
    app.connect("config-inited", _write)
    app.connect("missing-reference", _public)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
