"""Functions in C give what they give in Python."""

import ctypes
import math
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from numpy.testing import assert_allclose

from pin_metaik.errors import CannotExport
from pin_metaik.export.c_types import NUMBER, WHOLE, Array, Kind
from pin_metaik.export.to_c import Translation

Floats = np.ndarray
TABLE, AT = (3, 1, 2), (1, 2)
GIVEN = Array(NUMBER, (3, 4))


class Room(NamedTuple):
    numbers: Floats
    row: Floats


class Fixed(NamedTuple):
    numbers: Floats


def room_of(given: Floats) -> Room:
    copy = np.empty((3, 4))
    copy[:] = given
    return Room(copy, np.empty(4))


def shares(whole: int, part: int) -> tuple[int, int]:
    return whole // part, whole % part


def bent(x: float) -> tuple[float, float]:
    if not 0.0 < x < 2.0:
        return -x, x**2
    return (1.0, 2.0) if x > 1.0 else (x, 0.5)


def everything(given: Floats, count: int, out: Floats) -> int:
    room, total = room_of(given), 0
    a, b = given[AT], given[0, 3]
    a, b = b - a, a - (b - a)
    for k in range(-3, 4):
        parts = shares(k, 3)
        total += 10 * parts[0] + parts[1]
    for k in range(3, 0, -1):
        room.numbers[0, k], room.numbers[0, k - 1] = room.numbers[0, k - 1], room.numbers[0, k]
    for k in TABLE:
        room.row[k] = a * k - b
    room.row[0] = given.shape[1]
    z = complex(a, b)
    z *= 2.0j * z
    least = most = 0.0
    for x in room.row:
        if x < 0.0:
            continue
        most, least = max(most, x, abs(z.imag)), min(least, x - 1.0)
    while total > 5:
        total -= count
        if total < -100:
            break
    for c in range(4):
        out[c] = room.numbers[0, c] - (room.numbers[1, c] - (2.0 - room.row[c])) / 2.0
        first, second = bent(out[c])
        out[4 + c] = first - second / (first * 3.0 + 1.0)
    out[8], out[9], out[10] = (z.conjugate() * z).real, -most, least
    return total if total > 0 and (most > 1.0 or least < 0.0) else -1


def compiled(function: Callable[..., object], kinds: list[Kind], call: str, folder: Path) -> ctypes.CDLL:
    program = Translation((Fixed,))
    program.call(function, kinds)
    (folder / "f.c").write_text(f"{program.text}\n{call}\n", encoding="utf-8")
    strict = ["cc", "-std=c99", "-O1", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", "f.c", "-o", "f.so", "-lm"]
    subprocess.run(strict, check=True, cwd=folder)
    return ctypes.CDLL(str(folder / "f.so"))


@pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler")
def test_what_the_kernels_are_written_with_means_the_same_in_c(tmp_path: Path) -> None:
    call = "long run(const double *given, long count, double *out) { return everything(given, count, out); }"
    run = compiled(everything, [GIVEN, WHOLE, Array(NUMBER, (11,))], call, tmp_path).run
    numbers, run.restype = ctypes.POINTER(ctypes.c_double), ctypes.c_long
    rng = np.random.default_rng(1)
    for count in range(1, 30):
        given, there, here = rng.normal(size=(3, 4)), np.zeros(11), np.zeros(11)
        before = given.copy()
        assert run(given.ctypes.data_as(numbers), ctypes.c_long(count), there.ctypes.data_as(numbers)) == everything(
            given, count, here
        )
        assert_allclose(there, here, rtol=1e-12)
        assert_allclose(given, before, atol=0.0)


def keyword(x: float) -> float:
    return max(x, default=1.0)  # type: ignore[call-overload, no-any-return]


def narrowed(x: float) -> float:
    total = 0
    for _ in range(3):
        total += x  # type: ignore[assignment]
    return total


def tangent(x: float) -> float:
    return math.tan(x)


def real_modulo(x: float) -> float:
    return x % 2.0


def shifted(x: float) -> int:
    return 1 << int(x)


def otherwise(x: float) -> float:
    for _ in range(3):
        x += 1.0
    else:
        x = 0.0
    return x


def value_or(x: float) -> float:
    return x or 1.0


def written(x: Floats) -> None:
    fixed = Fixed(x)
    fixed.numbers[0] = 1.0


@pytest.mark.parametrize(
    ("function", "kind", "why"),
    [
        (keyword, NUMBER, "max"),
        (narrowed, NUMBER, "does not fit"),
        (tangent, NUMBER, "tan"),
        (real_modulo, NUMBER, "Mod"),
        (shifted, NUMBER, "source of .*int"),
        (otherwise, NUMBER, "for _ in"),
        (value_or, NUMBER, "or"),
        (written, Array(NUMBER, (2,)), "is constant"),
    ],
)
def test_what_would_mean_something_else_in_c_is_refused(function: Callable[..., object], kind: Kind, why: str) -> None:
    with pytest.raises(CannotExport, match=why):
        Translation((Fixed,)).call(function, [kind])
