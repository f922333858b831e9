"""Ctrl-C while a loop is compiled is heard once it is, and leaves everything able to compile."""

import shutil
import subprocess
import sys
from pathlib import Path

from pin_metaik.compiled import sources

PRESSED = """
import os, signal, threading, time
import numpy as np, pin_metaik as mik
chain = mik.Chain(mik.load_robot("ur5").model, "tool0")
pose = chain.placements(chain.q(np.full(6, 0.3)))[0]
problem = mik.IKProblem.of(chain, pose)
try:
    threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
    problem.linearize(np.full(6, 0.3))
    print("not heard")
except KeyboardInterrupt:
    residual, cost = problem.linearize(np.full(6, 0.3))[0], problem.costs(np.zeros((1, 6)))[0]
    print("heard", np.abs(residual).max() < 1e-12, cost > 0.0)
"""


def test_a_process_whose_compilation_is_interrupted_hears_of_it_and_compiles_on(tmp_path: Path) -> None:
    shutil.copytree(sources.PACKAGE, tmp_path / "pin_metaik", ignore=shutil.ignore_patterns("__pycache__"))
    run = subprocess.run([sys.executable, "-c", PRESSED], cwd=tmp_path, capture_output=True, text=True)
    assert run.stdout.split() == ["heard", "True", "True"], run.stdout + run.stderr
