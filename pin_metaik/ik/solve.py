"""``solve_ik``: one target, one answer."""

from __future__ import annotations

from numpy.typing import ArrayLike

from pin_metaik.arguments import instance
from pin_metaik.collision import CollisionWorld
from pin_metaik.ik.plain_pose import solve_plain
from pin_metaik.ik.problem import Asked, IKProblem
from pin_metaik.ik.result import IKResult
from pin_metaik.ik.solver import DEFAULT_SOLVER, IKSolver
from pin_metaik.kinematics import Chain
from pin_metaik.randomness import Rng, as_seed


def solve_ik(
    chain: Chain,
    target: Asked,
    q0: ArrayLike | None = None,
    *,
    solver: IKSolver | None = None,
    world: CollisionWorld | None = None,
    rng: Rng = None,
) -> IKResult:
    """Find a configuration at which the chain's frames are at their targets, or prove that there is none.

    Args:
        chain: The joints to move and the frames to place.
        target: World pose of the chain's frame (``pin.SE3`` or 4x4), a position (3,) in m, a ``Target``, or one
            ``Target`` for each frame of a chain that has several; or a list of any goals, which are met together, and
            wishes, which are improved only as far as the goals leave freedom (see ``pin_metaik.goals``).
        q0: (nq,) configuration to start from. Joints outside the chain and locked ones keep its values in the search
            and in the answer. An arm with a closed form stays on the branch of ``q0`` (shoulder, elbow and wrist), if
            that branch has a solution. Default: the chain's reference.
        solver: How to search; default ``IKSolver()``.
        world: The world in which nothing must collide: the robot with itself, with objects it holds, and with
            obstacles. If the solver's solution collides, others are searched for with its refiner (damped least squares
            if it has none), by pushing them out of collision, and by its seeder.
        rng: Seed or generator of every random choice; ``None`` is a fixed seed, so that the same call gives the same
            answer. From a generator one number is drawn as the seed, however hard the target is.

    Returns:
        The result: check ``result.success``. A target out of reach raises nothing: its result has the nearest pose
        found. The status ``UNREACHABLE`` is always proved (``result.proof``). It can be proved for whole poses,
        positions, orientations and targets with free axes, also with mimic joints; of several frames each is looked at
        by itself. Nothing is proved from other goals, nor for sliding joints without limits, and little for nine joints
        and more or within some ten tolerances of the reachable poses.

    Raises:
        InvalidTarget: If the target is not a pose, position, orientation or goal, or a goal does not give numbers.
        FrameNotFound: If a target or a goal names a frame that does not exist.
        FixedFrame: If a goal is about a frame that the chain does not move.
        InvalidConfiguration: If ``q0`` is not a configuration of the model.
        InvalidBounds: If a joint of the chain has no finite range to search in.
        InvalidSetting: If the world is another model's than the chain, or ``rng`` is not one of these.
    """
    seed = None if rng is None else as_seed(rng)
    solver = DEFAULT_SOLVER if solver is None else solver
    try:
        if chain.held and q0 is not None:
            chain = chain.at(q0)
        first = solve_plain(chain, target, q0, solver.kernel_settings, seed)
    except (
        AttributeError,
        TypeError,
    ):  # told here, where looking costs a quick solve nothing
        instance(Chain, chain=chain)
        instance(IKSolver, solver=solver)
        raise
    if isinstance(first, IKResult) and world is None:
        return first
    problem = IKProblem.of(chain, target, world)
    return solver._finish(problem if q0 is None else problem.at(q0), first, q0, seed)
