"""Position only, on the RV-7FL as its paper has it: three joints place the tip, three are left free.

python examples/02_position_only.py [picture.png]
"""

import sys

import pin_metaik as mik
from pin_metaik.ik import save_arm


def main() -> None:
    robot = mik.load_robot("rv7fl_paper")
    chain = mik.Chain(robot.model, robot.frame)
    target = mik.Target.at([0.63925, -0.64594, 0.40079])  # metres; any orientation

    # The classical Jacobian method, a pure metaheuristic, and the metaheuristic as seeder of the Jacobian method.
    solvers = {
        "DLS from one start": mik.IKSolver(seeder=None, starts=1),
        "grey wolves alone": mik.IKSolver("gwo", refiner=None, budget=mik.Budget(evaluations=30_000)),
        "grey wolves, then DLS": mik.IKSolver("gwo", "dls", mik.Budget(evaluations=4_000)),
    }
    for name, solver in solvers.items():
        result = mik.solve_ik(chain, target, solver=solver, rng=0)
        print(f"{name:22} {result.status:17} {1e3 * result.position_error:.1e} mm, {result.evaluations} evaluations")

    if len(sys.argv) > 1:
        save_arm(sys.argv[1], chain, result.q, target.pose.translation)


if __name__ == "__main__":
    main()
