"""Which method pays on your robot? A case and a method of your own, next to ours, at equal budgets.

python examples/40_compare_on_your_robot.py [picture.png]
"""

from __future__ import annotations

import shutil
import sys
import tempfile
from pathlib import Path

import numpy as np

from pin_metaik.compare import CASES, METHODS, Answer, Case, Suite, Task, compare, read_results, summarise, write_report
from pin_metaik.ik import IKProblem
from pin_metaik.kinematics import Chain


def on_the_bench(chain: Chain, rng: np.random.Generator) -> Task:
    """A pose of a random configuration with the tip in front of the arm and above the bench."""
    while True:
        x = chain.box.sample(rng, 1)
        tip = chain.placements(chain.q(x[0]))[0].translation
        if tip[0] > 0.2 and tip[2] > 0.0:
            return Task.at(chain, x)


class BestOfHundred:
    """Starts a method of ours from the best of a hundred random configurations instead of from where it stands."""

    name = "best of hundred"

    def solve(self, problem: IKProblem, x0: np.ndarray, budget: int, rng: np.random.Generator) -> Answer:
        """Spend 100 evaluations on the start, and the rest on the way from there."""
        X = problem.box.sample(rng, 100)
        found = METHODS["dls+restarts"].solve(problem, X[problem.costs(X).argmin()], budget - 100, rng)
        assert found.evaluations is not None
        return Answer(found.x, found.claimed, found.evaluations + 100, found.status)


def main() -> None:
    bench = Case("bench", "Poses in front of the arm and above the bench.", on_the_bench)
    suite = Suite(("ur5",), (bench, CASES["singular"]), ("lm", "dls+restarts", BestOfHundred()), tasks=20, budget=2000)
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder)
        print(compare(suite, out))
        results = read_results(out)
        page, *_ = write_report(out)
        print(f"{page.name}: {page.stat().st_size // 1024} kB")
        if len(sys.argv) > 1:
            shutil.copy(page.with_name("ecdf.png"), sys.argv[1])
    print(f"{'case':10} {'method':16} {'solved':>7} {'evaluations':>12}")
    for case in results.cases:
        for method in results.methods:
            summary = summarise(results.rows(case=case, method=method))
            median = f"{summary.evaluations[0]:12.0f}" if summary.evaluations else "           -"
            print(f"{case:10} {method:16} {summary.rate:7.0%} {median}")


if __name__ == "__main__":
    main()
