"""The package's ``SerialArm``, read from its file: environments of other solvers need not have the package."""

from __future__ import annotations

import sys
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pin_metaik.compare.methods.peers.serial_arm import BASE, TIP, SerialArm
else:
    path = Path(__file__).parents[1] / "pin_metaik" / "compare" / "methods" / "peers" / "serial_arm.py"
    spec = spec_from_file_location("serial_arm", path)
    module = sys.modules["serial_arm"] = module_from_spec(spec)
    spec.loader.exec_module(module)
    BASE, TIP, SerialArm = module.BASE, module.TIP, module.SerialArm

__all__ = ["BASE", "TIP", "SerialArm"]
