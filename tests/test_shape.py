"""The shape of the code: functions take few arguments, and every room has its place in the layers."""

import ast
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pin_metaik

PACKAGE = Path(pin_metaik.__file__).parent
PROJECT = PACKAGE.parent / "pyproject.toml"
# loops and their parts take flat arrays
COMPILED = {"jit", "inline", "shared", "separate", "separate_allocating", "exact", "allocating"}
MOST = 8  # arguments that may be given by their place; of a command they are options with names


def functions() -> Iterator[tuple[str, ast.FunctionDef | ast.AsyncFunctionDef]]:
    """Every function of the package that is no loop and no command, with its file."""
    for file in sorted(PACKAGE.rglob("*.py")):
        place = file.relative_to(PACKAGE)
        if place.parts[0] == "cli":
            continue
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                decorators = {ast.unparse(each).partition("(")[0] for each in node.decorator_list}
                if not decorators & COMPILED:
                    yield f"{place}: {node.name}", node


def test_no_function_takes_more_than_eight_arguments_by_their_place() -> None:
    taken = {
        name: [each.arg for each in (*node.args.posonlyargs, *node.args.args) if each.arg not in ("self", "cls")]
        for name, node in functions()
    }
    assert len(taken) > 1000
    assert {name: arguments for name, arguments in taken.items() if len(arguments) > MOST} == {}


def test_every_folder_with_rooms_has_layers_that_name_all_of_them() -> None:
    contracts = tomllib.loads(PROJECT.read_text(encoding="utf-8"))["tool"]["importlinter"]["contracts"]
    layered = {each["containers"][0] for each in contracts if each["type"] == "layers" and each.get("exhaustive")}
    folders = [init.parent for init in PACKAGE.rglob("__init__.py")]
    roomy = {
        ".".join(folder.relative_to(PACKAGE.parent).parts)
        for folder in folders
        if sum(room.parent == folder for room in folders) > 1
    }
    assert "pin_metaik.compare" in roomy
    assert roomy <= layered
