"""Install a wheel into an empty environment and solve from there: no compiler in sight, nowhere to write.

    python .github/check_wheel.py dist/pin_metaik-*.whl

exits with 1 if anything had to be compiled.
"""

from __future__ import annotations

import os
import subprocess
import sys
import venv
from pathlib import Path
from tempfile import TemporaryDirectory

SOLVE = """
import gc, sys, time
began = time.perf_counter()
import numpy as np
import pinocchio as pin
import pin_metaik as mik
print(f"{time.perf_counter() - began:7.2f} s  import of {mik.__file__}")

robot = mik.load_robot("panda")
chain = mik.Chain(robot, "panda_hand_tcp")
pose = pin.SE3(np.diag([1.0, -1.0, -1.0]), np.array([0.4, 0.0, 0.4]))
free = mik.Target(pose, orientation_tolerance=(1e-5, 1e-5, np.inf))
kinds = {
    "a pose": lambda: mik.solve_ik(chain, pose).success,
    "a position": lambda: mik.solve_ik(chain, [0.4, 0.1, 0.5]).success,
    "a free axis": lambda: mik.solve_ik(chain, free).success,
    "all": lambda: len(mik.solve_ik_all(chain, pose)) > 0,
    "the nearest": lambda: mik.solve_ik(chain, pose, solver=mik.IKSolver(select="nearest")).success,
    "a path": lambda: bool(mik.solve_ik_path(chain, [pose, pose], max_step=0.1)),
    "a batch": lambda: bool(np.all(mik.solve_ik_batch(chain, [pose] * 10).success)),
    "a seeder": lambda: mik.solve_ik(chain, pose, solver=mik.IKSolver("gwo", "dls")).success,
    "a world": lambda: mik.solve_ik(chain, pose, world=mik.CollisionWorld(robot)).success,
}
for kind, solve in kinds.items():
    start = time.perf_counter()
    assert solve(), kind
    print(f"{time.perf_counter() - start:7.2f} s  {kind}")
print(f"{time.perf_counter() - began:7.2f} s  together")
loops = [each for each in gc.get_objects() if type(each).__name__ == "CPUDispatcher"]
compiled = sum(sum(loop.stats.cache_misses.values()) for loop in loops)
print(compiled, "loops compiled,", sum(sum(loop.stats.cache_hits.values()) for loop in loops), "read")
sys.exit(compiled > 0)
"""


def main() -> None:
    (wheel,) = sys.argv[1:]
    with TemporaryDirectory() as folder:
        venv.create(folder, with_pip=True)
        python = Path(folder) / "bin" / "python"
        subprocess.run([python, "-m", "pip", "install", "--quiet", Path(wheel).resolve()], check=True)
        nowhere = {"HOME": os.devnull, "XDG_CACHE_HOME": os.devnull, "PATH": str(python.parent)}
        done = subprocess.run([python, "-c", SOLVE], cwd=folder, env=nowhere, check=False)
    sys.exit(done.returncode)


if __name__ == "__main__":
    main()
