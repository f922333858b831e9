"""The processor that machine code in a wheel is made for: its instructions are those of all but old machines."""

from __future__ import annotations

import platform
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

from llvmlite import binding


@dataclass(frozen=True)
class Baseline:
    """A processor, by LLVM's names.

    Attributes:
        name: For ``NUMBA_CPU_NAME``, with ``NUMBA_CPU_FEATURES`` empty.
        instructions: That a processor must have to run its code.
    """

    name: str
    instructions: frozenset[str]

    def fits(self, here: Mapping[str, bool]) -> bool:
        """Whether a processor with (True) or without (False) these instructions runs its code."""
        return all(here.get(instruction, False) for instruction in self.instructions)


X86_64_V3 = Baseline(
    "x86-64-v3",  # Intel since 2013, AMD since 2015
    frozenset({"avx", "avx2", "bmi", "bmi2", "cx16", "f16c", "fma", "lzcnt", "movbe", "popcnt", "sahf"})
    | {"sse3", "sse4.1", "sse4.2", "ssse3", "xsave"},
)
ARMV8 = Baseline("generic", frozenset({"neon"}))
APPLE_M1 = Baseline("apple-m1", frozenset({"neon", "dotprod", "fullfp16", "lse", "rdm"}))


@cache
def baseline() -> Baseline | None:
    """Of this machine's architecture; None: no baseline is known, or this machine is older."""
    match platform.machine().lower():
        case "x86_64" | "amd64":
            processor = X86_64_V3
        case "arm64" | "aarch64":
            processor = APPLE_M1 if platform.system() == "Darwin" else ARMV8
        case _:
            return None
    return processor if processor.fits(binding.get_host_cpu_features()) else None
