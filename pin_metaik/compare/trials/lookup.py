"""Cases and methods by name, by ``module:object``, or given as objects."""

from __future__ import annotations

import importlib

from pin_metaik.compare.cases import CASES
from pin_metaik.compare.cases.case import Case
from pin_metaik.compare.methods import named
from pin_metaik.compare.methods.method import Method
from pin_metaik.errors import InvalidSetting, UnknownName
from pin_metaik.lookup import lookup


def case_of(case: str | Case) -> Case:
    """A case by its name, by ``module:object``, or itself.

    Raises:
        UnknownName: No case or object of that name.
        InvalidSetting: The module cannot be imported, or the object is no case.
    """
    found = imported("case", case) if isinstance(case, str) and ":" in case else case
    if isinstance(found, str):
        return lookup("case", found, CASES)
    if not isinstance(found, Case):
        raise InvalidSetting(f"not a case: {found!r}; give a name or a pin_metaik.compare.Case")
    return found


def method_of(method: str | Method) -> Method:
    """A method by its name, by ``module:object``, or itself.

    Raises:
        UnknownName: No method or object of that name.
        InvalidSetting: The module cannot be imported, or the object is no method.
    """
    found = imported("method", method) if isinstance(method, str) and ":" in method else method
    if isinstance(found, str):
        return named(found)
    if isinstance(found, type) or not isinstance(found, Method):
        raise InvalidSetting(
            f"not a method: {found!r}; give a name or an object with a name and solve(problem, x0, budget, rng)"
        )
    return found


def imported(kind: str, spec: str) -> object:
    """The object that ``module:object`` names.

    Raises:
        InvalidSetting: The module cannot be imported.
        UnknownName: Nothing of that name is in it.
    """
    module, _, name = spec.partition(":")
    if not all(part.isidentifier() for part in module.split(".")):
        raise InvalidSetting(f"cannot import the module of {kind} {spec!r}: {module!r} is not the name of a module")
    try:
        found = importlib.import_module(module)
    except ImportError as error:
        raise InvalidSetting(f"cannot import the module of {kind} {spec!r}: {error}") from None
    if not hasattr(found, name):
        raise UnknownName(f"{kind} in {module}", name, [name for name in vars(found) if not name.startswith("_")])
    return getattr(found, name)
