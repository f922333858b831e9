"""An inverse-kinematics problem: the cost that is minimised and the test that decides."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property
from typing import NamedTuple, TypeAlias, cast

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import array, checked, instance, shown
from pin_metaik.collision import CollisionWorld
from pin_metaik.errors import FrameNotFound, InvalidConfiguration, InvalidSetting, InvalidTarget
from pin_metaik.ik.goals.contradictions import check_contradictions
from pin_metaik.ik.goals.goal import Goal, Goals, Outcome
from pin_metaik.ik.goals.placed import Placed
from pin_metaik.ik.goals.pose import ANYWHERE, Target, TargetLike
from pin_metaik.ik.goals.wish import Wish, Wishes
from pin_metaik.ik.proof import Proof
from pin_metaik.kinematics import Chain, Limits
from pin_metaik.kinematics.kernel.layout import ALIGNED, NEAR, SLACK, TURN_WEIGHT, WEIGHT
from pin_metaik.kinematics.proofs.boxes import TINY, Boxes
from pin_metaik.kinematics.proofs.closed_forms import Branches
from pin_metaik.optimize import Box
from pin_metaik.optimize.settings import few

Asked: TypeAlias = TargetLike | Goal | Wish | Sequence[TargetLike | Goal | Wish]
NO_GOALS, NO_WISHES = Goals(), Wishes()
EXACT = 1e-9  # m and rad


class Verdict(NamedTuple):
    """A configuration judged by Pinocchio (errors, limits) and coal (collisions).

    Attributes:
        position_error: Of the worst frame, m.
        orientation_error: Of the worst frame, rad.
        accepted: Whether it is a solution: within the tolerances, inside the limits and free of collisions.
        collides: Whether it would be a solution if it were not in collision.
    """

    position_error: float
    orientation_error: float
    accepted: bool
    collides: bool = False


@dataclass(frozen=True, eq=False)
class IKProblem:
    """Targets for the frames of a chain, to be met inside its limits and, if a world is given, free of collisions.

    Joints that are not coordinates of the chain have their values of its ``reference``, except in ``verdict`` and
    ``accepts``, which judge whole configurations; ``problem.at(q)`` is the same problem with those joints at q.

    The residual is a sum over goals: those of the targets by compiled loops, then those of ``goals`` in Python.

    Attributes:
        chain: The chain.
        targets: One for each of its frames, in the chain's order.
        records: (T, 26) the targets as the kernels take them; they aim at the middle of each tolerance.
        rows: (m, 2) the (frame, axis) pairs that count: three translations and three rotations, without the free axes.
        world: The robot and obstacles that must not collide; ``None``: no collision is checked.
        goals: All other goals.
        wishes: Goals that are improved only as far as the others leave freedom (``Wish``).
        base: (nq,) configuration from which goals and wishes take the joints that the chain does not move; None: the
            chain's reference.
    """

    chain: Chain
    targets: tuple[Target, ...]
    records: NDArray[np.float64]
    rows: NDArray[np.int64]
    world: CollisionWorld | None = None
    goals: Goals = NO_GOALS
    wishes: Wishes = NO_WISHES
    base: NDArray[np.float64] | None = None

    @staticmethod
    def of(chain: Chain, target: Asked, world: CollisionWorld | None = None) -> IKProblem:
        """Make a problem of targets, goals and wishes, each matched to a frame of the chain.

        Args:
            chain: The chain.
            target: A target for its only frame, or a list with one for each frame: in the chain's order, or each
                naming its frame; a further target of a frame, goals of other kinds, and wishes may be in the list, too.
            world: What must not collide.

        Raises:
            InvalidTarget: If a target is not valid, a frame has no target, or two targets name no frame; if a goal's
                residual is not (m,) finite numbers; or if two goals obviously contradict each other.
            FrameNotFound: If a target names a frame that is not the chain's.
            InvalidSetting: If the world's model is not the chain's.
            FixedFrame: If a goal is about a frame that the chain does not move.
        """
        check_world(chain, world)
        given, goals, wishes, listed = _sorted_out(target)
        several = len(chain.frames) > 1 or listed
        if not several:
            targets: tuple[Target, ...] = (Target.of(cast(TargetLike, given)),)
        elif isinstance(given, Target) or not isinstance(given, Sequence):
            raise InvalidTarget(f"this chain places {', '.join(chain.frames)}: give a list of targets, one for each")
        else:
            targets = tuple(Target.of(one) for one in given)
        if several or targets[0].frame is not None:
            targets, further = _match(chain.frames, targets, bool(goals or wishes))
            goals = further + goals
        records = targets[0].record[None] if len(targets) == 1 else np.array([one.record for one in targets])
        rows = _rows(tuple([one.counts for one in targets]))
        asked = Goals.of(chain, goals) if goals else NO_GOALS
        if goals:
            check_contradictions(chain, targets, goals)
        wished = Wishes.of(chain, wishes) if wishes else NO_WISHES
        return IKProblem(chain, targets, records, rows, world, asked, wished)

    @property
    def asked(self) -> tuple[Goal | Wish, ...]:
        """Everything that is asked: what makes the same problem again."""
        return tuple(one for one in self.targets if one is not ANYWHERE) + self.goals.each + self.wishes.each

    @property
    def m(self) -> int:
        """Number of rows of the residual: an axis of a target that counts has one, other goals have their own."""
        return len(self.rows) + sum(self.goals.sizes)

    def at(self, q: ArrayLike) -> IKProblem:
        """The same problem, with the joints that the chain does not move where q (nq,) has them; see ``Chain.at``."""
        chain = self.chain.at(q)
        if self.goals or self.wishes:
            return replace(self, chain=chain, base=chain.configuration(q))
        return self if chain is self.chain else replace(self, chain=chain)

    @cached_property
    def whole(self) -> IKProblem:
        """The same problem with zero error and cost everywhere inside the tolerances, instead of in their middle only.

        A solution in the middle of the tolerances is better, and is looked for first. Where the middle is out of reach,
        a descent towards it ends at a compromise that may lie outside the tolerances; a descent on this problem does
        not.
        """
        return replace(self, records=np.array([target.whole_record for target in self.targets]))

    @property
    def exact(self) -> IKProblem:
        """The same problem in the middle of the tolerances, to be met to 1e-9 m and rad."""
        records = self.records.copy()
        slacks, least = records[:, SLACK:WEIGHT], records[:, [NEAR, ALIGNED]]
        records[:, SLACK:WEIGHT] = np.where(np.isfinite(slacks), 0.0, np.inf)
        records[:, [NEAR, ALIGNED]] = np.where(np.isfinite(least), EXACT, np.inf)
        return replace(self, records=records)

    @property
    def loose(self) -> bool:
        """Whether a target has more than the default tolerance: its edge may be reachable where its middle is not."""
        return any(target.loose for target in self.targets)

    def placed(self, x: NDArray[np.float64]) -> Placed:
        """The robot at coordinates x (n,), as an argument for goals."""
        return Placed(self.chain, self.chain.q(x, self.base))

    def nearest_turns(self, X: NDArray[np.float64], x0: NDArray[np.float64]) -> NDArray[np.float64]:
        """Solutions X (k, n), each moved by whole turns nearest to x0 (n,), unless a goal is then missed."""
        near = self.limits.nearest_turns(X, x0)
        if self.goals:
            lost = [not self.goals.met(self.placed(x)) for x in near]
            near[lost] = X[lost]
        return near

    @property
    def limits(self) -> Limits:
        """The limits of the chain's coordinates."""
        return self.chain.limits

    @property
    def box(self) -> Box:
        """The box to sample and search in."""
        return self.chain.box

    @cached_property
    def kernel_rows(self) -> NDArray[np.int64] | None:
        """``rows`` for the compiled descent; None stands for its special case, the whole pose of one frame."""
        whole = len(self.targets) == 1 and not self.records[0, SLACK:WEIGHT].any()
        return None if whole else self.rows

    @cached_property
    def success_cost(self) -> float:
        """A cost at which every tolerance is certainly met; 0 if a goal does not tell its tolerance."""
        return (
            0.0
            if self.goals
            else float(np.min(self.records[:, [WEIGHT, TURN_WEIGHT]] * self.records[:, [NEAR, ALIGNED]]))
        )

    @cached_property
    def gap(self) -> float:
        """Lower bound (m) on how far the targets, or the wrists behind them, are out of reach; 0: nothing is proved."""
        return max(self._gap(t, oriented=math.isfinite(one.allowance[1])) for t, one in enumerate(self.targets))

    @checked
    def gaps(self, t: int) -> tuple[float, float]:
        """Lower bounds (m) on how far target t is out of reach: by its position alone, and with its orientation."""
        self._frame(t)
        oriented = math.isfinite(self.targets[t].allowance[1])
        return self._gap(t, oriented=False), self._gap(t, oriented)

    def _frame(self, t: int) -> None:
        """Raise InvalidSetting if there is no target number t."""
        if not 0 <= t < len(self.targets):
            raise InvalidSetting(f"t is the number of a target, 0 to {len(self.targets) - 1}, got {t}")

    def _gap(self, t: int, oriented: bool) -> float:
        return self.chain.reach(t, oriented).gap(self.targets[t].pose, *self.targets[t].allowance)

    def linearize(self, x: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Weighted residual r (m,) at coordinates x (n,), and J (n, m) to descend along, dr_i/dx_c in J[c, i].

        Rows are the axes that ``rows`` lists: of the error T_target^-1 T_frame, in the target frame, its position p (m)
        and its rotation vector w = log(R) (rad), less the slack, times the weight. J is the derivative of r but for one
        kind of row: where no axis of rotation has slack, rotation rows are the angular velocity, in the target frame,
        times the weight. The derivative is Jl^-1(w), the inverse left Jacobian of SO(3), times that; the two are equal
        at the target, and differ by half the angle of w to first order.
        """
        r, J = np.empty(self.m), np.empty((self.chain.n, self.m))
        self._evaluator(r, J)(array("x", x, self.chain.n))
        return r, J

    def _evaluator(
        self, r: NDArray[np.float64], J: NDArray[np.float64]
    ) -> Callable[[NDArray[np.float64]], tuple[float, bool]]:
        """A function that writes ``linearize`` at x (n,) into r (m,) and J (n, m), for loops that call it often.

        It returns |r|^2, and whether all goals are within their tolerances.
        """
        chain, t = self.chain, len(self.rows)
        linearize, given = chain.kernels.linearize, (chain.bare, self.records, self.rows)
        if not self.goals:
            return lambda x: linearize(*given, x, r, J)
        placed, slopes = np.empty(t), np.empty((chain.n, t))

        def evaluate(x: NDArray[np.float64]) -> tuple[float, bool]:
            square, met = linearize(*given, x, placed, slopes)
            at = self.placed(x)
            r[:t], r[t:] = placed, self.goals.residual(at)
            J[:, :t], J[:, t:] = slopes, self.goals.jacobian(at).T
            return square + float(r[t:] @ r[t:]), met and self.goals.met(at)

        return evaluate

    def branches(self, x0: NDArray[np.float64]) -> NDArray[np.float64]:
        """Coordinates (b, n) that the arm's closed form has for a whole pose, if it has one; see ``Chain.branches``."""
        if self.kernel_rows is not None:
            return np.empty((0, self.chain.n))
        return self.chain.branches(self.targets[0].pose.homogeneous, x0)

    @cached_property
    def proof(self) -> Proof | None:
        """How limits and link lengths prove that no configuration meets the targets; None: they do not.

        For a chain whose joints cannot move, it is a proof only together with the check that its one configuration does
        not meet the targets.
        """
        if self.limits.rigid:
            return Proof.LIMITS
        return Proof.REACH if self.gap > 0.0 else None

    @property
    def refuted(self) -> Proof | None:
        """The proof, by limits, links or closed form, that no configuration meets the targets; None without one."""
        nominal = self.nominal_branches if self.proof is None else None
        return Proof.CLOSED_FORM if nominal is not None and nominal.proved else self.proof

    @cached_property
    def form_branches(self) -> Branches | None:
        """The closed form's branches for all poses within the target's tolerances; None without a closed form.

        None also if there are other goals: few branches meet these, and they have no closed form.
        """
        return self.nominal_branches if len(self.chain.form) and not self.goals else None

    @cached_property
    def nominal_branches(self) -> Branches | None:
        """The same for an arm that nearly has a closed form; how far it is from one is added to the tolerances."""
        proof, target = self.chain.nominal_proof, self.targets[0]
        if proof is None or not all(target.counts):
            return None
        return proof.judge(target.pose.homogeneous, *target.allowance)

    @checked
    def boxes(self, t: int, *, least: float = TINY, shrink: bool = False) -> Boxes | None:
        """Boxes that cover all configurations, to be excluded for target t; None if no proof can come of them.

        Of a target with a free translation only the orientation is used; of one with two free rotations only the
        position. ``least`` and ``shrink`` as for ``Chain._boxes``.
        """
        self._frame(t)
        if not least > 0.0:
            raise InvalidSetting(f"least is a half width above 0, got {least!r}")
        target, near = self.targets[t], self.targets[t].allowance[0]
        free = not target.counts[3], not target.counts[4], not target.counts[5]
        if near == math.inf and sum(free) > 1:
            return None
        begin = None if self.nominal_branches is None else self.nominal_branches.pieces
        how = near, target.tilt, free
        return self.chain._boxes(t, target.pose.homogeneous, *how, least=least, shrink=shrink, begin=begin)

    def near(self, count: int) -> NDArray[np.float64]:
        """Sampled coordinates (count, n) of the chain with the poses nearest to the targets, nearest first."""
        few("count", count, 0)
        count = int(count)
        out = np.empty((count, self.chain.n))
        self.chain.kernels.nearest_samples(self.chain.block, self.records, out)
        return out

    def costs(self, X: NDArray[np.float64]) -> NDArray[np.float64]:
        """Cost (k,) of coordinates X (k, n): weighted distance in m plus weighted angle in rad, summed over the frames.

        For a position alone this is the distance in metres.
        """
        X = array("X", X, "k", self.chain.n, finite=False)
        out = np.empty(len(X))
        self.chain.kernels.costs(self.chain.bare, self.records, X, out)
        if self.goals:
            out += [self.goals.cost(self.placed(x)) for x in X]
        return out

    def verdict(self, q: NDArray[np.float64]) -> Verdict:
        """Judge a configuration q (nq,) with Pinocchio's forward kinematics, the limits, and coal."""
        q = array("q", q, self.chain.model.nq, error=InvalidConfiguration, finite=False)
        position = orientation = 0.0
        accepted = self.chain.keeps_limits(q)
        for target, placement in zip(self.targets, self.chain._placed(q), strict=True):
            judged = target.judge(placement)
            position = max(position, judged.position_error)
            orientation = max(orientation, judged.orientation_error)
            accepted = accepted and judged.met
        accepted = accepted and (not self.goals or self.goals.met(Placed(self.chain, q)))
        collides = accepted and self.world is not None and self.world.checker.collides(q)
        return Verdict(position, orientation, accepted and not collides, collides)

    def outcomes(self, q: NDArray[np.float64]) -> tuple[tuple[Outcome, ...], tuple[Outcome, ...]]:
        """The outcome of each goal and of each wish at a configuration q (nq,)."""
        q = array("q", q, self.chain.model.nq, error=InvalidConfiguration)
        at, pairs = Placed(self.chain, q), zip(self.chain.frames, self.targets, strict=True)
        placed = [replace(target, frame=frame) for frame, target in pairs if target is not ANYWHERE]
        musts = tuple(Outcome.of(goal, at) for goal in (*placed, *self.goals.each))
        return musts, tuple(Outcome.of(wish.goal, at) for wish in self.wishes.each)

    def accepts(self, q: NDArray[np.float64]) -> bool:
        """Whether q (nq,) is a solution."""
        return self.verdict(q).accepted


def check_world(chain: Chain, world: CollisionWorld | None) -> None:
    """Raise InvalidSetting if the world is another model's than the chain."""
    instance(Chain, chain=chain)
    if world is not None:
        instance(CollisionWorld, world=world)
    if world is not None and world.model is not chain.model and world.model != chain.model:
        raise InvalidSetting(f"the world is of {world.model.name!r}, not of the chain's model {chain.model.name!r}")


def check_targets(targets: object, none: str) -> None:
    """Raise InvalidTarget if targets are not a list, or if there are none: then ``none`` says what is missing."""
    if isinstance(targets, str) or not (isinstance(targets, Sequence) or np.ndim(cast(ArrayLike, targets))):
        raise InvalidTarget(f"targets are a list of poses or positions, got {shown(targets)}")
    if len(cast(Sequence[object], targets)) == 0:
        raise InvalidTarget(none)


@cache
def _rows(counts: tuple[tuple[bool, ...], ...]) -> NDArray[np.int64]:
    """The (frame, axis) pairs at which ``counts`` is true."""
    return np.ascontiguousarray(np.argwhere(np.array(counts)))


def _sorted_out(asked: Asked) -> tuple[object, tuple[Goal, ...], tuple[Wish, ...], bool]:
    """The targets that somebody asks for, goals of other kinds, wishes, and whether the targets are a list of them."""
    if isinstance(asked, Target | pin.SE3):  # what comes most; asking what has a goal's methods takes 5 us
        return asked, (), (), False
    if isinstance(asked, Wish | Goal):
        asked = [asked]
    kinds = Target, pin.SE3, Goal, Wish
    if not isinstance(asked, (list, tuple)) or not any(isinstance(one, kinds) for one in asked):
        return asked, (), (), False
    wishes = tuple(one for one in asked if isinstance(one, Wish))
    others = tuple(one for one in asked if isinstance(one, Goal) and not isinstance(one, Target))
    targets = [one for one in asked if isinstance(one, Target) or not isinstance(one, (Goal, Wish))]
    return targets, others, wishes, True


def _match(
    frames: tuple[str, ...], targets: tuple[Target, ...], other_goals: bool
) -> tuple[tuple[Target, ...], tuple[Target, ...]]:
    """The targets in the order of the frames, and those that a frame has beyond its first one.

    With goals of other kinds, a frame needs none.
    """
    if len(targets) == len(frames) and all(target.frame is None for target in targets):
        return targets, ()
    by_frame: dict[str, Target] = {}
    further: list[Target] = []
    for target in targets:
        name = frames[0] if target.frame is None and len(frames) == 1 else target.frame
        if name is None:
            raise InvalidTarget(f"this chain places {', '.join(frames)}: give one target a frame, each naming its own")
        if name not in frames:
            raise FrameNotFound(name, frames)
        if by_frame.setdefault(name, target) is not target:
            further.append(target)
    missing = [name for name in frames if name not in by_frame]
    if missing and not other_goals:
        raise InvalidTarget(f"no target for {', '.join(missing)}; a chain places all of its frames at once")
    return tuple(by_frame.get(name, ANYWHERE) for name in frames), tuple(further)
