"""Write your own metaheuristic: a generator that yields points and receives their costs. No registration.

python examples/05_write_your_own_metaheuristic.py [picture.png]
"""

import sys
from collections.abc import Generator
from dataclasses import dataclass

import numpy as np

import pin_metaik as mik
from pin_metaik.figures import new_figure, save_picture


@dataclass(frozen=True)
class CrossEntropy:
    """Cross-entropy method (Rubinstein 1999): sample a Gaussian, refit it to the best quarter."""

    agents: int = 40

    def search(self, run: mik.Search) -> Generator[np.ndarray, np.ndarray, None]:
        X = run.start(self.agents)  # (agents, n): seeds first, then uniform in the box
        while True:
            costs = yield X  # (agents,): only the driver evaluates, counts and stops
            best = X[np.argsort(costs)[: self.agents // 4]]
            mean, spread = best.mean(axis=0), best.std(axis=0) + 1e-3 * run.space.width
            X = run.space.clip(mean + spread * run.rng.standard_normal(X.shape))


def main() -> None:
    robot = mik.load_robot("ur5")
    chain = mik.Chain(robot.model, robot.frame)
    target = chain.placements(chain.q([0.3, -1.2, 1.4, -0.9, -1.5, 0.6]))[0]

    alone = mik.IKSolver(CrossEntropy(), refiner=None, budget=mik.Budget(evaluations=8_000))
    seeding = mik.IKSolver(CrossEntropy(), "dls", mik.Budget(evaluations=8_000))
    print("alone:   ", mik.solve_ik(chain, target, solver=alone, rng=0))
    print("with DLS:", mik.solve_ik(chain, target, solver=seeding, rng=0))

    # It works wherever the built-in ones do, also without any robot.
    box = mik.Box([-5.0] * 6, [5.0] * 6)
    budget = mik.Budget(evaluations=4_000)
    found = mik.minimize(sphere, box, CrossEntropy(), budget, trace=True, rng=0)
    print(f"sphere:   cost {found.cost:.1e} after {found.evaluations} evaluations")

    if len(sys.argv) > 1:
        figure = new_figure((7.0, 4.5))
        axes = figure.add_subplot()
        axes.semilogy(*found.trace.T, linewidth=3, label="cross-entropy, above")
        for name in ("gwo", "mtde", "sfla", "pso", "de"):
            axes.semilogy(*mik.minimize(sphere, box, name, budget, trace=True, rng=0).trace.T, label=name)
        axes.set(xlabel="evaluations", ylabel="best cost so far", title="a sphere in six dimensions")
        axes.legend()
        save_picture(figure, sys.argv[1])


def sphere(X: np.ndarray) -> np.ndarray:
    return ((X - 1.5) ** 2).sum(axis=1)


if __name__ == "__main__":
    main()
