"""Give a wheel machine code for this platform and this Python: compiled from the sources that are in it.

    python .github/wheel.py dist/pin_metaik-0.1.0-py3-none-any.whl

replaces the wheel by one for this platform. Needs pin_metaik's dependencies, those of ``mobile`` among them.
"""

from __future__ import annotations

import os
import platform
import re
import subprocess
import sys
from argparse import ArgumentParser
from pathlib import Path
from tempfile import TemporaryDirectory

# Run with the unpacked wheel on the path: its sources' digest is the stamp of the code.
COMPILE = """
import sys
from pin_metaik.compiled import ahead
if __name__ == "__main__":
    versions, missing = ahead.versions()
    sys.exit("\\n".join(missing)) if missing else None
    for done, loop in enumerate(ahead.each(ahead.Version.compile, versions), 1):
        print(f"{done:3d} of {len(versions)}: {loop.module}.{loop.name}", flush=True)
    for code in ahead.machine_code():
        code.ship()
"""
# Of Pinocchio's own wheels; machine code calls nothing but what numba finds for it at run time.
SYSTEMS = {"Linux": "manylinux_2_28", "Darwin": "macosx_11_0"}


def main() -> None:
    parser = ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("wheel", type=Path)
    wheel: Path = parser.parse_args().wheel
    with TemporaryDirectory() as folder:
        run("wheel", "unpack", "--dest", folder, str(wheel))
        (unpacked,) = Path(folder).iterdir()
        fill(unpacked, Path(folder))
        (about,) = unpacked.glob("*.dist-info/WHEEL")
        python = f"cp{sys.version_info.major}{sys.version_info.minor}"
        tag = f"{python}-{python}-{SYSTEMS[platform.system()]}_{platform.machine()}"
        text = about.read_text().replace("Root-Is-Purelib: true", "Root-Is-Purelib: false")
        about.write_text(re.sub(r"^Tag: .*$", f"Tag: {tag}", text, flags=re.MULTILINE))
        run("wheel", "pack", "--dest-dir", str(wheel.parent), str(unpacked))
    wheel.unlink()


def fill(unpacked: Path, folder: Path) -> None:
    """Compile every loop of an unpacked wheel for the baseline of this platform's processors."""
    program = folder / "compile.py"
    program.write_text(COMPILE)
    here = {"PYTHONPATH": str(unpacked), "NUMBA_CACHE_DIR": str(folder / "code"), "PYTHONDONTWRITEBYTECODE": "1"}
    find = "from pin_metaik.compiled.baseline import baseline; print(baseline().name)"
    found = subprocess.run(
        [sys.executable, "-c", find], check=True, capture_output=True, text=True, env={**os.environ, **here}
    )
    processor = {"NUMBA_CPU_NAME": found.stdout.strip(), "NUMBA_CPU_FEATURES": ""}
    subprocess.run([sys.executable, str(program)], check=True, env={**os.environ, **here, **processor})


def run(module: str, *arguments: str) -> None:
    subprocess.run([sys.executable, "-m", module, *arguments], check=True)


if __name__ == "__main__":
    main()
