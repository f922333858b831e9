"""Plan with OMPL: reach a pose behind a pillar, whichever of its solutions, with a world that proves motions free.

It needs the extra ``ompl``.

python examples/16_plan_with_ompl.py [picture.png]
"""

import sys

import numpy as np
import pinocchio as pin

import pin_metaik as mik
from pin_metaik.collision import Box, Obstacle, save_world
from pin_metaik.planning import Adapter, installed, plan_joint_move

DOWN = pin.rpy.rpyToMatrix(np.pi, 0.0, 0.0)


def main() -> None:
    robot = mik.load_robot("ur5")
    chain = mik.Chain(robot, "tool0")
    pillar = Obstacle("pillar", Box((0.3, 0.06, 1.2)), (0.45, 0.0, 0.6))
    world = mik.CollisionWorld(robot, [pillar], margin=0.005)

    begin = mik.solve_ik(chain, pin.SE3(DOWN, np.array([0.4, -0.3, 0.3])), world=world)
    goals = mik.solve_ik_all(chain, pin.SE3(DOWN, np.array([0.4, 0.3, 0.3])), begin.q, world=world)
    print(f"{len(goals)} solutions of the goal; straight moves to them:")
    for q in goals:
        print("   ", world.first_contact(begin.q, q))
    if not installed():
        print("planning around it needs OMPL: pip install '.[ompl]' in the clone")
        return

    plan = plan_joint_move(chain, world, begin.q, goals.q)
    length = np.abs(np.diff(plan.x, axis=0)).max(axis=1).sum() if plan else np.nan
    print(f"planned: {plan.success}, to solution {plan.goal}, {len(plan.q)} configurations, {length:.2f} rad")
    print("every part of it is proved free:", world.clear_between_batch(plan.q[:-1], plan.q[1:]).all())

    # A planner and settings of your own: the adapter has the space, and both checks.
    from ompl import geometric as og

    adapter = Adapter(chain, world, begin.q)
    setup = adapter.setup()
    planner = og.RRTConnect(setup.getSpaceInformation())
    planner.setRange(0.5)  # rad
    setup.setPlanner(planner)
    setup.setStartState(adapter.state(begin.q))
    setup.setGoalState(adapter.state(goals.q[0]))
    if setup.solve(5.0):
        print("with RRTConnect's range at 0.5 rad:", setup.getSolutionPath().getStateCount(), "states")

    if len(sys.argv) > 1:
        save_world(sys.argv[1], world, plan.q)


if __name__ == "__main__":
    main()
