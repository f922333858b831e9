"""Where to put a robot so that it reaches a list of poses, and moves well there."""

from __future__ import annotations

import math
import pickle
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from time import perf_counter
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import checked
from pin_metaik.collision import CollisionWorld
from pin_metaik.dexterity import manipulability
from pin_metaik.errors import InvalidBounds
from pin_metaik.ik import IKBatch, IKResult, IKSolver, Target, solve_ik_batch
from pin_metaik.ik.goals.pose import TargetLike
from pin_metaik.ik.problem import IKProblem, check_targets, check_world
from pin_metaik.interrupts import wrapped
from pin_metaik.kinematics import Chain
from pin_metaik.optimize import Box, Budget, Metaheuristic, Result, Status, minimize
from pin_metaik.plain import fields_of, plain
from pin_metaik.randomness import Rng
from pin_metaik.watching import Watch

PLACES = Budget(evaluations=1000)
TRIES = Budget(evaluations=300)  # for each pose at a place while places are compared
HALF = 0.1  # manipulability at which a pose counts half of what it can

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class BasePlacement:
    """A placement of a robot's base.

    Attributes:
        x: m, of the origin of the robot's model in the world.
        y: m.
        yaw: rad, about the world's z.
        results: The result for each pose, with targets in the robot's own frame; ``results[i].q`` is the configuration.
        manipulability: (k,) Yoshikawa's measure at each solution, NaN where the pose is not reached.
        cost: The minimised cost: the sum over the poses, 1 to 2 for one that is not reached, -1 to 0 for one that is.
        evaluations: Number of placements tried.
        seconds: Time taken, s.
        interrupted: Whether a watch ended the search.
    """

    x: float
    y: float
    yaw: float
    results: tuple[IKResult, ...] = field(repr=False)
    manipulability: Floats
    cost: float
    evaluations: int
    seconds: float
    interrupted: bool = False

    @property
    def pose(self) -> pin.SE3:
        """Pose of the robot's model in the world."""
        return _placement(np.array([self.x, self.y, self.yaw]))

    @property
    def reached(self) -> int:
        """Number of poses that are reached."""
        return sum(result.success for result in self.results)

    @property
    def success(self) -> bool:
        """Whether all poses are reached."""
        return self.reached == len(self.results)

    def __bool__(self) -> bool:
        """Whether all poses are reached."""
        return self.success

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON: lengths in m, angles in rad."""
        names = "x", "y", "yaw", "success", "reached", "manipulability", "cost", "evaluations", "interrupted", "seconds"
        return {**fields_of(self, *names), "q": plain([result.q for result in self.results])}

    def __str__(self) -> str:
        return (
            f"({self.x:.3f} m, {self.y:.3f} m, {math.degrees(self.yaw):.1f} deg): {self.reached} of "
            f"{len(self.results)} poses reached, after {self.evaluations} places in {self.seconds:.3g} s"
        )


@checked
def place_base(
    chain: Chain,
    targets: Sequence[TargetLike] | Floats,
    *,
    region: Box | None = None,
    q0: ArrayLike | None = None,
    solver: IKSolver | None = None,
    world: CollisionWorld | None = None,
    algorithm: str | Metaheuristic = "mtde",
    budget: Budget = PLACES,
    rng: Rng = None,
    watch: Watch | None = None,
) -> BasePlacement:
    """Find where on the floor to put a robot so that it reaches as many poses as possible, with good manipulability.

    A metaheuristic searches x, y and yaw. The cost of a placement is a sum over all poses: 1 for one that is not
    reached, plus up to 1 by how far it is missed; -m / (m + 0.1) for one that is reached with manipulability m.

    Args:
        chain: The joints to move and the frame to place; the origin of its model is the base that is placed.
        targets: k targets in the world, as for ``solve_ik``.
        region: Box of x, y (m) and yaw (rad) to search; default: as far around the targets as the chain reaches, any
            yaw.
        q0: (nq,) configuration every search starts from; default: the chain's reference.
        solver: How poses are solved at the placement chosen; while placements are compared it has 300 evaluations a
            pose.
        world: World in which nothing must collide. Its obstacles stay where they are while the robot is moved; a
            placement at which the robot's base overlaps one reaches no pose.
        algorithm: A metaheuristic's name or object.
        budget: Its evaluations are the number of placements to try.
        rng: Seed or generator; ``None`` is a fixed seed.
        watch: Called after every generation with the placements tried, their total and the best cost; returning True
            ends the search.

    Raises:
        InvalidTarget: If there are no targets, or one of them is not valid.
        InvalidBounds: If the region is not a box of three numbers.
        UnknownName: If there is no such metaheuristic.
        InvalidSetting: If the world is another model's than the chain.
        InvalidConfiguration: If ``q0`` is not a configuration of the model.
    """
    began = perf_counter()
    check_world(chain, world)
    check_targets(targets, "a place is looked for at least one target, got none")
    site = _Site(chain, [Target.of(target) for target in targets], q0, world)
    region = site.around() if region is None else region
    if len(region.lower) != 3:
        raise InvalidBounds(f"a region is a box of x, y and yaw, got one of {len(region.lower)} numbers")
    quick = replace(IKSolver() if solver is None else solver, budget=TRIES)

    def costs(X: Floats) -> Floats:
        return np.array([site.cost(site.solve(x, quick)) for x in X])

    def placed(found: Result) -> BasePlacement:
        batch = site.solve(found.x, IKSolver() if solver is None else solver)
        x, y, yaw = found.x.tolist()
        dexterity, stopped = site.dexterity(batch), found.status is Status.INTERRUPTED
        took = perf_counter() - began
        return BasePlacement(x, y, yaw, tuple(batch), dexterity, site.cost(batch), found.evaluations, took, stopped)

    return wrapped(lambda: minimize(costs, region, algorithm, budget, rng, watch=watch), placed)


class _Site:
    """Targets in a world, and a robot that is put here and there."""

    def __init__(self, chain: Chain, targets: list[Target], q0: ArrayLike | None, world: CollisionWorld | None) -> None:
        self._chain = chain if q0 is None else chain.at(q0)
        self._q0 = chain.reference if q0 is None else chain.configuration(q0)
        self._targets = targets
        for target in targets:
            IKProblem.of(self._chain, target)
        self._world: CollisionWorld | None = None if world is None else pickle.loads(pickle.dumps(world))
        self._poses = {} if world is None else {o.name: pin.SE3(o.pose) for o in world.obstacles}

    def around(self) -> Box:
        """As far round the targets as the chain reaches, whichever way it is turned."""
        places = np.array([target.pose.translation[:2] for target in self._targets])
        reach = self._chain.reach(0, False)
        most = reach.most + float(np.linalg.norm(reach.anchor[:2]))
        return Box([*(places.min(axis=0) - most), -math.pi], [*(places.max(axis=0) + most), math.pi])

    def solve(self, place: Floats, solver: IKSolver) -> IKBatch:
        """The answers to all targets with the robot at a place (3,)."""
        back = _placement(place).inverse()
        world = self._world
        for name, pose in self._poses.items():
            assert world is not None
            world.move(name, back * pose)
        moved = [replace(target, pose=back * target.pose) for target in self._targets]
        plain = all(target.plain and not target.loose for target in moved)
        asked: Any = moved
        if plain and len({target.counts for target in moved}) == 1 and all(moved[0].counts):
            asked = np.array([target.pose.homogeneous for target in moved])
        return solve_ik_batch(self._chain, asked, self._q0, solver=solver, world=world, workers=1)

    def cost(self, batch: IKBatch) -> float:
        """What the answers to all targets cost."""
        worth = self.dexterity(batch)
        missed = np.nan_to_num(batch.position_error + batch.orientation_error, nan=1.0)
        return float(np.where(batch.success, -worth / (worth + HALF), 1.0 + np.minimum(missed, 1.0)).sum())

    def dexterity(self, batch: IKBatch) -> Floats:
        """Manipulability (k,) of the answers, NaN where a target is not met."""
        found = np.full(len(batch), np.nan)
        for i in np.flatnonzero(batch.success):
            problem = IKProblem.of(self._chain, self._targets[i])
            found[i] = manipulability(problem.linearize(self._chain.x(batch.q[i]))[1].T)
        return found


def _placement(place: Floats) -> pin.SE3:
    """Where x, y and yaw (3,) put the origin of a model."""
    return pin.SE3(pin.utils.rotate("z", float(place[2])), np.array([place[0], place[1], 0.0]))
