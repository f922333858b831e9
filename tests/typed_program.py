"""A user's program: every public name of ``pin_metaik``, and the calls of its other modules that most programs make.

``mypy --strict`` passes it against the installed package; it runs, too.
"""

from collections.abc import Generator

import numpy as np
from numpy.typing import ArrayLike, NDArray

import pin_metaik as mik
from pin_metaik import collision, export, gui, mobile, reachable, stewart

Floats = NDArray[np.float64]


class Uniform:
    """A metaheuristic of one's own: points anywhere."""

    def search(self, run: mik.Search) -> Generator[Floats, Floats, None]:
        while True:
            yield run.space.sample(run.rng, 20)


class Still:
    """A refiner of one's own: it leaves the best start as it is."""

    def refine(self, problem: mik.IKProblem, starts: ArrayLike, evaluations: int) -> mik.Refinement:
        x: Floats = np.array(starts, dtype=float)[0]
        return mik.Refinement(x, met=False, evaluations=0)


def inverse() -> bool:
    robot: mik.Robot = mik.load_robot("ur5")
    names: list[str] = [entry.name for entry in mik.robot_names()]
    chain = mik.Chain(robot, "tool0", locked=[], limits={"elbow_joint": (-2.5, 2.5)})
    limits: mik.Limits = chain.limits
    q: Floats = chain.q(np.full(len(limits.lower), 0.3))
    poses = chain.placements(q)
    result: mik.IKResult = mik.solve_ik(chain, poses[0], q, rng=1)
    status: mik.IKStatus = result.status
    proof: mik.Proof | None = result.proof
    every: mik.IKSolutions = mik.solve_ik_all(chain, poses[0])
    labels: tuple[str, ...] = every.labels
    dimensions: tuple[int, ...] = every.dimensions
    calm = mik.Weighted("nearest", {chain.names[0]: 5.0})
    print(dimensions, every.best(calm, q).shape, mik.IKSolver(select=calm).select)
    label: str = result.label
    sets: tuple[mik.IKSolutions, ...] = mik.solve_ik_all_batch(chain, [poses[0], poses[0]], workers=2)
    text: str = export.exported(chain, "python")
    print(label in labels, len(sets), len(text))
    batch: mik.IKBatch = mik.solve_ik_batch(chain, [poses[0], poses[0]])
    path: mik.IKPath = mik.solve_ik_path(chain, [poses[0], poses[0]], q, max_step=0.2)
    limits_of_motion: mik.MotionLimits = mik.MotionLimits.of(chain, acceleration=8.0)
    follower = mik.Follower(chain, rate=500.0, limits=limits_of_motion)
    tick: mik.FollowerStep = follower.step(poses[0], q)
    why: mik.FollowerStatus = tick.status
    timed: mik.TimedPath = mik.time_path(chain, [q, chain.q(np.full(chain.n, 0.4))])
    print(why.name, timed.duration, timed.sample(0.01).v.shape)
    choice: mik.IKChoice = mik.solve_ik_any(chain, [poses[0], poses[0]])
    map_: mik.Reachability = mik.reachability(chain, [poses[0].translation], 2)
    grid: reachable.Grid = reachable.Grid.around(chain, 0.5)
    print(grid.shape)
    place: mik.BasePlacement = mik.place_base(chain, [poses[0]], budget=mik.Budget(evaluations=20))
    target = mik.Target(poses[0], orientation_tolerance=(1e-5, 1e-5, np.inf))
    motions: mik.SelfMotions = mik.self_motions(chain, target)
    curves: list[mik.SelfMotionCurve] = list(motions)
    least = motions.best(mik.gravity_torque(chain, payload=1.0))
    print(len(curves), least.value)
    budget = mik.Budget(evaluations=2000)
    solver = mik.IKSolver("gwo", mik.DLS(), budget=budget)
    seeded = mik.solve_ik(chain, target, solver=solver, rng=np.random.default_rng(0))
    problem = mik.IKProblem.of(chain, target)
    refiner: mik.Refiner = Still()
    own: mik.Metaheuristic = Uniform()
    searched = mik.solve_ik(chain, target, solver=mik.IKSolver(own, refiner, budget), rng=0)
    world = mik.CollisionWorld(robot, margin=0.001)
    world.add(collision.Obstacle("wall", collision.Box((0.1, 2.0, 2.0)), (-1.0, 0.0, 0.5)))
    free = mik.solve_ik(chain, poses[0], world=world)
    looking: mik.goals.Goal = mik.goals.LookAt("tool0", (1.0, 0.0, 0.0))
    looked = mik.solve_ik(chain, [poses[0].translation, looking, mik.goals.Wish(mik.goals.MidRange(0.0))])
    met: list[bool] = [outcome.met for outcome in looked.goals]
    loops: list[mik.goals.Loop] = [mik.goals.Loop(closure) for closure in robot.loops]
    ends: list[str] = [link for loop in loops for link in loop.ends(robot.model)]
    print(len(ends))
    print(len(names), status.name, proof, len(every), len(batch), path.continuous, seeded.success, free.success)
    move: collision.Move = world.first_contact(q, q)
    print(choice.index, map_.share, place.pose, move.status, world.clear_between(q, q), path.reasons)
    print(met, problem, searched.status, mik.REFINERS, world.in_collision(q), world.min_distance(q).distance)
    return result.success


def search() -> float:
    def sphere(X: Floats) -> Floats:
        costs: Floats = np.square(X).sum(axis=1)
        return costs

    box = mik.Box([-1.0, -1.0], [1.0, 1.0])
    gwo: mik.Metaheuristic = mik.ALGORITHMS["gwo"]()
    found = mik.minimize(sphere, box, gwo, budget=mik.Budget(evaluations=500), rng=0)
    asking = mik.AskTell(box, "de", budget=mik.Budget(evaluations=100))
    asking.tell(sphere(asking.ask()))
    return found.cost


def others() -> None:
    square = mobile.read_polygons([[(1.0, -1.0), (2.0, -1.0), (2.0, 1.0), (1.0, 1.0)]])
    plan: mobile.PathPlan = mobile.plan_path(mobile.Scene((0.0, 0.0), (3.0, 0.0), square))
    mechanism: stewart.Mechanism = stewart.load_mechanism(stewart.mechanism_names()[0])
    print(plan.success, mechanism)
    with gui.open_toolbox(port=0) as toolbox:
        print(toolbox.url, toolbox.busy, toolbox.pids, len(toolbox.tabs))


if __name__ == "__main__":
    try:
        print(inverse(), search())
        others()
    except mik.MetaIKError as error:
        raise SystemExit(str(error)) from None
