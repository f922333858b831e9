"""Machine code that a wheel carries gives what code for this very processor gives, but for rounding."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from pin_metaik.compiled import baseline

GIVEN = """
import sys
import numpy as np
import pin_metaik as mik
chain = mik.Chain(mik.load_robot("panda").model, "panda_hand_tcp")
X = chain.box.sample(np.random.default_rng(0), 200)
problem = mik.IKProblem.of(chain, chain.placements(chain.q(X[0]))[0])
np.savez(sys.argv[1], poses=chain.poses(X), costs=problem.costs(X))
"""


def test_code_for_the_baseline_differs_from_this_processors_own_by_rounding_only(tmp_path: Path) -> None:
    processor = baseline.baseline()
    if processor is None:
        pytest.skip("this machine is older than the baseline")
    own, other = tmp_path / "own.npz", tmp_path / "baseline.npz"
    wheels = {"NUMBA_CPU_NAME": processor.name, "NUMBA_CPU_FEATURES": "", "NUMBA_CACHE_DIR": str(tmp_path)}
    for file, environment in ((own, {}), (other, wheels)):
        subprocess.run([sys.executable, "-c", GIVEN, file], env={**os.environ, **environment}, check=True)
    with np.load(own) as here, np.load(other) as there:
        for name in ("poses", "costs"):  # in m and rad, from some hundred numbers of size one
            assert_allclose(there[name], here[name], rtol=0.0, atol=1e-13)
