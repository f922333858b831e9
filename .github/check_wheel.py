"""Install a wheel into an empty environment and solve from there: no compiler in sight, nowhere to write.

    python .github/check_wheel.py dist/pin_metaik-*.whl

prints how large the wheel and what pip installs with it are, and makes the first solve of each kind; as root once more
as a user who owns nothing. Exits with 1 if anything had to be compiled, or anything was printed about it.
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
from pin_metaik import mobile, stewart
print(f"{time.perf_counter() - began:7.2f} s, {time.process_time():5.2f} s of processor:  import of {mik.__file__}")

robot = mik.load_robot("panda")
chain = mik.Chain(robot, "panda_hand_tcp")
pose = pin.SE3(np.diag([1.0, -1.0, -1.0]), np.array([0.4, 0.0, 0.4]))
free = mik.Target(pose, orientation_tolerance=(1e-5, 1e-5, np.inf))
both = mik.Chain(robot, ["panda_hand_tcp", "panda_link4"])
elbow = both.placements(both.q((both.limits.lower + both.limits.upper) / 2))
circles = np.radians([-10, 10, 110, 130, 230, 250]), np.radians([-50, 50, 70, 170, 190, 290])
platform = stewart.Geometry(0.25, 0.12, *circles, legs=[(i, i) for i in range(6)])
reach = stewart.LegLimits(shortest=0.35, longest=0.47)
box = [(1.0, -1.0), (2.0, -1.0), (2.0, 1.0), (1.0, 1.0)]
scene = lambda: mobile.Scene((0.0, 0.0), (3.0, 0.0), mobile.read_polygons([box]))
kinds = {
    "a pose": lambda: mik.solve_ik(chain, pose).success,
    "a position": lambda: mik.solve_ik(chain, [0.4, 0.1, 0.5]).success,
    "a free axis": lambda: mik.solve_ik(chain, free).success,
    "two frames": lambda: mik.solve_ik(both, list(elbow)).success,
    "all": lambda: len(mik.solve_ik_all(chain, pose)) > 0,
    "the nearest": lambda: mik.solve_ik(chain, pose, solver=mik.IKSolver(select="nearest")).success,
    "a path": lambda: bool(mik.solve_ik_path(chain, [pose, pose], max_step=0.1)),
    "a batch": lambda: bool(np.all(mik.solve_ik_batch(chain, [pose] * 10).success)),
    "a seeder": lambda: mik.solve_ik(chain, pose, solver=mik.IKSolver("gwo", "dls")).success,
    "a world": lambda: mik.solve_ik(chain, pose, world=mik.CollisionWorld(robot)).success,
    "a Stewart grid": lambda: stewart.survey(platform, reach, stewart.Grid((20, 20, 20))).volume > 0,
    "a mobile path": lambda: mobile.plan_path(scene()).length > 3.0,
}
for kind, solve in kinds.items():
    start, busy = time.perf_counter(), time.process_time()
    assert solve(), kind
    print(f"{time.perf_counter() - start:7.2f} s, {time.process_time() - busy:5.2f} s of processor:  {kind}")
print(f"{time.perf_counter() - began:7.2f} s, {time.process_time():5.2f} s of processor:  together")
loops = [each for each in gc.get_objects() if type(each).__name__ in ("CPUDispatcher", "Separate")]
compiled = sum(sum(loop.stats.cache_misses.values()) for loop in loops)
print(compiled, "loops compiled,", sum(sum(loop.stats.cache_hits.values()) for loop in loops), "read", flush=True)
sys.exit(compiled > 0)
"""
NOBODY = 65534


def main() -> None:
    wheel = Path(sys.argv[1]).resolve()
    print(f"{megabytes(wheel):7.1f} MB  the wheel")
    with TemporaryDirectory() as name:
        folder = Path(name)
        folder.chmod(0o755)  # for another user, too
        venv.create(folder, with_pip=True)
        python = folder / "bin" / "python"
        empty = installed(folder)
        install(python, str(wheel))
        print(f"{installed(folder) - empty:7.1f} MB  what pip installs by default")
        install(python, f"{wheel}[mobile]")
        failed = solve(folder)
        if os.getuid() != 0:
            print("not tried as another user: only root can become one")
        elif not may_run(python):
            print(f"not tried as another user: only root may read {os.path.realpath(python)}")
        else:
            failed |= solve(folder, NOBODY)
    sys.exit(failed)


def install(python: Path, what: str) -> None:
    subprocess.run([python, "-m", "pip", "install", "--quiet", what], check=True)


def megabytes(*files: Path) -> float:
    return sum(file.stat().st_size for file in files) / 1e6


def installed(folder: Path) -> float:
    return megabytes(*(file for file in folder.rglob("*") if file.is_file()))


def may_run(python: Path) -> bool:
    try:
        done = subprocess.run([python, "-c", ""], user=NOBODY, group=NOBODY, extra_groups=[], check=False)
    except PermissionError:
        return False
    return done.returncode == 0


def solve(folder: Path, user: int | None = None) -> bool:
    """Solve one of each with nothing but the environment to find and nowhere to write; whether that failed."""
    nowhere = {"HOME": os.devnull, "XDG_CACHE_HOME": os.devnull, "PATH": str(folder / "bin")}
    other = {} if user is None else {"user": user, "group": user, "extra_groups": []}
    print("as this user:" if user is None else "as a user who owns nothing:", flush=True)
    done = subprocess.run(
        [folder / "bin" / "python", "-c", SOLVE],
        cwd=folder,
        env=nowhere,
        stderr=subprocess.PIPE,
        text=True,
        check=False,
        **other,  # type: ignore[call-overload]
    )
    print(done.stderr, end="")
    return done.returncode != 0 or done.stderr != ""


if __name__ == "__main__":
    main()
