"""One arm's inverse kinematics as C or Python: its numbers, the functions of the kernels, and what calls them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from pin_metaik.arguments import checked
from pin_metaik.errors import CannotExport
from pin_metaik.export.drivers import PYTHON, C
from pin_metaik.export.parsed import source_of
from pin_metaik.export.tables import as_declared, tables_of
from pin_metaik.export.to_c import Translation
from pin_metaik.export.to_python import python_of
from pin_metaik.kinematics import Chain
from pin_metaik.kinematics.kernel import layout
from pin_metaik.output import writable

ROWS = ("H1", "H2", "H3", "H4", "H5", "H6", "O1", "O1_O2", "UPPER", "FORE", "O4_O5", "O5_TIP", "AHEAD")
ACROSS = ("ACROSS", "ACROSS_WORLD")
ENTRIES = ("LEVEL", "SIDE_2", "SIDE_3")
FAR = 1e9  # rad: where a joint without limits ends
EXACT = 1e-6  # m and rad: how far an arm may be from its closed form, as nothing descends in exported code
BRANCHES = 8  # configurations at most by a closed form


@checked
def exported(chain: Chain, language: str = "c") -> str:
    """The source text of a function that computes all configurations of an arm for a pose, without this package.

    It consists of the functions of the compiled kernels, translated, and the parameters of the arm: for C a function
    ``arm_solve`` that depends only on the mathematical library, for Python a function ``solve`` that depends only on
    the standard library. Configurations are inside the limits, distinct, and within 1e-5 m and rad of the pose, those
    by whole turns nearest to a guess.

    Args:
        chain: An arm with a closed form or, for C, any arm of six joints.
        language: ``"c"`` or ``"python"``.

    Raises:
        CannotExport: The chain has not six joints; it has no closed form, or only nearly (a calibrated arm), and the
            language is Python; or there is no such language.
    """
    if language not in LANGUAGES:
        raise CannotExport(f"there is no export to {language!r}; known: {', '.join(LANGUAGES)}")
    return LANGUAGES[language](chain)


@checked
def write_export(chain: Chain, path: Path) -> None:
    """Write ``exported`` to a file, whose suffix gives the language: .c or .py.

    Raises:
        CannotExport: As ``exported`` does, or the suffix is another one.
        CannotWrite: The file cannot be written.
    """
    if path.suffix not in SUFFIXES:
        raise CannotExport(f"the suffix gives the language, {' or '.join(SUFFIXES)}; got {path.name!r}")
    writable(path).write_text(exported(chain, SUFFIXES[path.suffix]), encoding="utf-8")


def _has_form(chain: Chain) -> bool:
    """Whether the arm is exactly one with a closed form."""
    proof = chain.form_proof
    return proof is not None and float(max(proof.deviation)) - layout.ROUNDING <= EXACT


def _numbers(chain: Chain) -> dict[str, Any]:
    """The value of each expression that names a constant in the closed form."""
    from pin_metaik.export.sources import CONSTANTS

    form = chain.form
    rows = {f"form[{name}]": tuple(form[getattr(layout, name)].tolist()) for name in ROWS + ACROSS}
    entries = {f"form[{name}]": float(form[getattr(layout, name)]) for name in ENTRIES}
    return {**rows, **entries, **CONSTANTS, "ORIGIN": (0.0, 0.0, 0.0)}


def _limits(chain: Chain) -> list[tuple[str, float, float]]:
    """Name and limits of each joint, in the order in which a configuration has them."""
    lower, upper = np.maximum(chain.limits.lower, -FAR), np.minimum(chain.limits.upper, FAR)
    return list(zip(chain.names, lower.tolist(), upper.tolist(), strict=True))


def _columns(chain: Chain) -> list[int]:
    """The coordinate of each joint, from the base on."""
    return [int(column) for column in chain.paths.wiring[:, layout.COLUMN]]


def _by_form(chain: Chain) -> tuple[Callable[..., int], tuple[Any, ...], int]:
    """What computes configurations by the closed form, the arm that it takes, and how many there are at most."""
    from pin_metaik.export.solutions import FormArm, by_branches

    return by_branches, FormArm(chain.form, np.array(_columns(chain))), BRANCHES


def _by_roots(chain: Chain) -> tuple[Callable[..., int], tuple[Any, ...], int]:
    """The same by the roots of six joints."""
    from pin_metaik.export.solutions import RootsArm, by_roots

    six = chain._six_joints
    if six is None:
        raise CannotExport(
            f"{chain.model.name!r} has no finite set of solutions to write: one frame that six joints move has one, "
            f"where joints that follow others turn at whole multiples of them; here {chain.n} move {len(chain.frames)}"
        )
    return by_roots, RootsArm(*six.arm, six.length, six.loops, six.poses, six.known, six.degree), six.degree


def _as_c(chain: Chain) -> str:
    from pin_metaik.export.solutions import CALLED_WITH, CONSTANT, Wanted

    function, arm, bound = (_by_form if _has_form(chain) else _by_roots)(chain)
    limits = _limits(chain)
    lower, upper = (np.array([one[k] for one in limits]) for k in (1, 2))
    rotates, multi_turn = chain.limits.rotates.astype(np.int64), chain.limits.multi_turn.astype(np.int64)
    wanted = Wanted(lower, upper, rotates, multi_turn, near=np.empty(6))
    arm_tables, limit_tables = tables_of(arm), tables_of(wanted)
    program = Translation(CONSTANT)
    kinds = [program.named(type(one), [table.kind for table in tables_of(one)]) for one in (arm, wanted)]
    name, _, _ = program.call(function, [*kinds, *CALLED_WITH])
    limit_tables.pop()  # near, which is given
    return C.substitute(
        name=chain.model.name,
        joints=", ".join(name for name, _, _ in limits),
        program=program.text,
        tables="\n".join(as_declared(table) for table in (*arm_tables, *limit_tables)),
        bound=bound,
        function=name,
        arm_type=type(arm).__name__,
        arm=", ".join(table.name for table in arm_tables),
        limits=", ".join(table.name for table in limit_tables),
    )


def _as_python(chain: Chain) -> str:
    from pin_metaik.export.sources import FUNCTIONS

    if not _has_form(chain):
        raise CannotExport(
            f"{chain.model.name!r} has no closed form to write in Python: six turning joints, axes 2 and 3 parallel, "
            "axes 5 and 6 meeting, and axis 4 either through that point, too, or parallel to axes 2 and 3, have one, "
            "as ur5, puma560, rv7fl, z1 and kinova do; any other arm of six joints can be written in C, as .c"
        )
    limits, numbers = _limits(chain), _numbers(chain)
    return PYTHON.substitute(
        name=chain.model.name,
        joints=", ".join(name for name, _, _ in limits),
        lower=repr(tuple(lower for _, lower, _ in limits)),
        upper=repr(tuple(upper for _, _, upper in limits)),
        columns=repr(tuple(_columns(chain))),
        outside=repr(numbers["OUTSIDE"]),
        functions="\n\n\n".join(python_of(source_of(function)[0], numbers) for function in FUNCTIONS),
    )


LANGUAGES: dict[str, Callable[[Chain], str]] = {"c": _as_c, "python": _as_python}
SUFFIXES = {".c": "c", ".py": "python"}
