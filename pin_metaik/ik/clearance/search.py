"""From a solution in collision to one that is free: all others, where they can be counted, or pushed and covered."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain, count, cycle, islice

import numpy as np
from numpy.typing import NDArray

from pin_metaik.ik.clearance.qp import Push
from pin_metaik.ik.collect import collect
from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.proof import Proof
from pin_metaik.ik.refine.descent import Descent
from pin_metaik.ik.starts import BATCH, drawn
from pin_metaik.ik.state import SearchState
from pin_metaik.kinematics.roots.real import UNBOUNDED
from pin_metaik.optimize import Budget, Metaheuristic, minimize
from pin_metaik.randomness import Rng, as_generator

NEAREST = 24  # entries of the sample table to start from
EVERY = 50_000  # evaluations for all solutions, where time is what is budgeted
CANDIDATES = 256  # solutions kept, to be told apart
APART = 0.05  # rad or m between solutions; what is nearer collides alike
OTHERS = 16  # starts of a redundant chain before any solution is pushed
FINE = 0.1  # rad or m, half width of the boxes of its solutions that are looked at
KEPT, COVER = 4_096, 20_000  # of such boxes at most, and of all that are looked at for them
SHALLOW = 0.02  # m; deeper ones are not pushed where all solutions were looked at
PUSHED = 4  # of the solutions found, those pushed in each round: the least deep
SEEDING = 0.02  # of what is left, for a metaheuristic in each round
ROUND = 256  # further starts in each round
DEPTH_WEIGHT = 5.0  # what a metre of depth counts in it, in metres from the target
ELITE = 8  # its best points that are refined, and the least deep solutions that it starts from


class ClearSearch:
    """One search for a solution of a problem that is free of collisions in the problem's world.

    Attributes:
        state: What was spent of which budget.
        found: (CANDIDATES, n) solutions in collision; ``known`` rows of them are taken.
        complete: Whether there are no other solutions, as far as can be told.
        proof: What proves that there are none.
        resolution: Half width (rad or m) of boxes that cover all solutions of a redundant chain, in each of which one
            was looked at; None, if that was not done.
    """

    def __init__(
        self, problem: IKProblem, base: NDArray[np.float64], state: SearchState, descent: Descent, rng: Rng
    ) -> None:
        """Set up for a problem in a world; ``base`` (nq,) has the joints that the chain does not move."""
        assert problem.world is not None
        self.problem, self.world, self.base, self.state, self.rng = problem, problem.world, base, state, rng
        self.descent = descent
        self.found = np.empty((CANDIDATES, problem.chain.n))
        self.known = 0
        self.complete = False
        self.proof: Proof | None = None
        self.resolution: float | None = None
        self._depths = np.full(CANDIDATES, np.nan)  # of the solutions found, NaN where not known yet
        self._pushed: set[int] = set()
        self._redundant = problem.chain.n > problem.m or problem.loose or bool(problem.goals)
        self._generator = as_generator(rng)

    def run(self, x: NDArray[np.float64], seeder: Metaheuristic) -> NDArray[np.float64] | None:
        """Collision-free solution (n,) near x (n,), which is a solution in collision; None: none was found."""
        self.found[0], self.known = x, 1
        if not self._redundant:
            return self.every()
        starts = self.starts()
        free = self.others(islice(starts, OTHERS))
        for means in chain(("cover",), cycle(("push", "others", "seed"))):
            if free is not None or self.state.over() or self.complete:
                break
            match means:
                case "push":
                    free = self.push()
                case "cover":
                    free = self.cover()
                case "others":
                    free = self.others(islice(starts, ROUND))
                case _:
                    free = self.seed(seeder)
        return free

    def every(self) -> NDArray[np.float64] | None:
        """The first of all solutions that is free, the nearest to the one that collides first."""
        budget = Budget(evaluations=self.state.left() if self.state.left() < UNBOUNDED else EVERY)
        _, found, self.proof, spent = collect(
            self.problem, self.found[0], self.descent, self.rng, limit=CANDIDATES - 1, apart=APART, budget=budget
        )
        self.state.spent += spent
        found = found[np.argsort(np.linalg.norm(found - self.found[0], axis=1), kind="stable")]
        self.found[1 : 1 + len(found)], self.known, self.complete = found, 1 + len(found), True
        return next((x for x in found if self._accepts(x)), None)

    def cover(self) -> NDArray[np.float64] | None:
        """Cover the solutions of a redundant chain with boxes, and look at one in each; then push the least deep."""
        boxes = self.problem.boxes(0, least=FINE) if len(self.problem.targets) == 1 else None
        if boxes is None:
            return None
        kept = boxes.look(min(COVER, self.state.left_for_boxes), KEPT)
        self.state.add_boxes(boxes.looked)
        if not boxes.done:
            return None
        free = self.others(kept[:, : self.problem.chain.n])
        if free is None and not self.state.over():
            self.resolution, self.complete = FINE, True
            free = self.push(SHALLOW)
        return free

    def least_deep(self) -> NDArray[np.float64]:
        """Coordinates (n,) of the solution found that is least deep in collision."""
        least: NDArray[np.float64] = self.found[self._by_depth()[0]]
        return least

    def starts(self) -> Iterator[NDArray[np.float64]]:
        """Starts (n,): the nearest samples of the chain, then random ones, for ever."""
        yield from self.problem.near(NEAREST)
        for index in count():
            yield from drawn(self.problem.chain, self.rng, index, BATCH)

    def others(self, starts: Iterable[NDArray[np.float64]]) -> NDArray[np.float64] | None:
        """Descend from starts (n,), one by one; the first new solution that is free."""
        for start in starts:
            if self.state.over():
                break
            if self.known == CANDIDATES:  # forget all but the least deep
                self.found[:ELITE] = self.found[self._by_depth()[:ELITE]]
                self.known = ELITE
                self._depths[:] = np.nan
                self._pushed.clear()
            room = self.found[: self.known + 1]
            spent, known, _ = self.descent.gather(
                self.problem, start[None], room, self.known, APART, 2, self.state.left(), branch=False
            )
            self.state.spent += spent
            new, self.known = known > self.known, known
            newest: NDArray[np.float64] = room[-1]
            if new and self._accepts(newest):
                return newest
        return None

    def _pushed_out(self, points: NDArray[np.float64]) -> NDArray[np.float64] | None:
        """The first of the points (s, n) that can be pushed out of collision."""
        for x in points:
            refined = Push().refine(self.problem, self.world, x, self.base, self.state.left())
            self.state.spent += refined.evaluations
            if refined.met:
                return refined.x
        return None

    def push(self, deepest: float = np.inf) -> NDArray[np.float64] | None:
        """Push the least deep of the solutions not pushed yet out of collision, none deeper than ``deepest`` (m)."""
        least = [i for i in self._by_depth() if i not in self._pushed and self._depths[i] <= deepest]
        chosen = least[:PUSHED]
        self._pushed.update(chosen)
        return self._pushed_out(self.found[chosen])

    def seed(self, seeder: Metaheuristic) -> NDArray[np.float64] | None:
        """Search for a point that is near the target and not deep, and refine the best of them."""
        problem, checker, chain = self.problem, self.world.checker, self.problem.chain

        def costs(X: NDArray[np.float64]) -> NDArray[np.float64]:
            depths = np.array([checker.depth(q) for q in chain.q(X, self.base)])
            return problem.costs(X) + DEPTH_WEIGHT * depths

        found = minimize(
            costs,
            problem.box,
            seeder,
            self.state.slice(SEEDING),
            self._generator,
            seeds=self.found[self._by_depth()[:ELITE]],
            keep=ELITE,
        )
        self.state.add_search(found)
        free = self.others(found.elite)
        return self._pushed_out(found.elite[:2]) if free is None else free

    def _accepts(self, x: NDArray[np.float64]) -> bool:
        return self.problem.accepts(self.problem.chain.q(x, self.base))

    def _by_depth(self) -> list[int]:
        """Numbers of the solutions found, the least deep first."""
        chain, depths = self.problem.chain, self._depths
        for i in np.flatnonzero(np.isnan(depths[: self.known])):
            depths[i] = self.world.checker.depth(chain.q(self.found[i], self.base))
        order: list[int] = np.argsort(depths[: self.known], kind="stable").tolist()
        return order
