"""Loading the compiled loops late, so that ``import pin_metaik.stewart`` stays quick."""

from __future__ import annotations

from functools import cache
from types import ModuleType


@cache
def load_judging() -> ModuleType:
    """The loops over poses; each is compiled, or read from numba's cache, when it is first called."""
    from pin_metaik.stewart.kernels import judging

    return judging


@cache
def load_bounds() -> ModuleType:
    """The loops that bound a workspace, likewise."""
    from pin_metaik.stewart.kernels import bounds

    return bounds


@cache
def load_newton() -> ModuleType:
    """The loop of forward kinematics, likewise."""
    from pin_metaik.stewart.kernels import newton

    return newton


@cache
def load_homotopy() -> ModuleType:
    """The loop that follows complex assemblies, likewise."""
    from pin_metaik.stewart.kernels import homotopy

    return homotopy
