"""Exclusion of boxes of configurations, alternating with descents: a proof of no solution, or further starts."""

from __future__ import annotations

from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.proof import Proof
from pin_metaik.ik.refine.descent import Descent
from pin_metaik.ik.state import SearchState
from pin_metaik.kinematics.proofs.boxes import Boxes
from pin_metaik.kinematics.roots.real import UNBOUNDED

FIRST = 500  # evaluations before the first boxes; fewer than 1 of 10,000 random targets with a solution needs more
FAR = 3e-3  # m and rad: where the nearest is farther away by then, there is mostly nothing to be found
HEAD, TAIL = 400, 7_000  # evaluations for which no box is looked at, where the nearest is far and where it is near
LONG, TIMES = 3_000, 10  # evaluations after which, where it is far, boxes are looked at ten at a time
LAST = 50_000  # boxes of a frame, where the nearest is far
MANY, FEW = 9, 3_000  # joints of a frame from which on more boxes prove next to nothing: of talos' nine 2 of 18
CHUNK = 1_000  # boxes between two looks at the clock, where Ctrl-C is heard, too
STARTS = 8  # boxes too small to be split, at a time, that are descended from


class Exclusion:
    """The boxes of one problem, for each of its frames: when one frame cannot be where it shall, not all can.

    A box takes about as long as an evaluation and counts as one. As long as it is open whether there is a solution, as
    many boxes are looked at as configurations were evaluated, so that neither way costs more than twice what it would
    alone. Hardly any target with a solution is not solved when they begin, but for those in singularities, where
    descents are slow and near to the target: for these boxes come last.
    """

    def __init__(self, problem: IKProblem, descent: Descent) -> None:
        """Begin with all configurations inside the limits."""
        self._problem, self._descent = problem.whole, descent
        frames = range(len(problem.targets))
        self._boxes = [boxes for t in frames if (boxes := problem.boxes(t)) is not None]

    def go_on(self, state: SearchState) -> None:
        """Look at the boxes that are due after the evaluations that the search has taken so far."""
        for boxes in self._boxes:
            self._look(boxes, self._due(state) - boxes.looked, state)

    def finish(self, state: SearchState) -> None:
        """Look at all boxes that the budget has left, when the search has come to its end."""
        for boxes in self._boxes:
            most = state.left_for_boxes if state.cost < FAR else LAST - boxes.looked
            self._look(boxes, most, state)

    def _due(self, state: SearchState) -> int:
        """How many boxes of a frame may have been looked at by now."""
        searched, far = state.searched, state.cost > FAR
        due = searched - (HEAD if far else TAIL) if searched >= FIRST else 0
        return TIMES * searched if far and searched >= LONG else due

    def _look(self, boxes: Boxes, most: int, state: SearchState) -> None:
        """Look at so many boxes of one frame, and descend from those that are too small to be split."""
        starts, end = 0, min(boxes.looked + most, FEW if boxes.arm.movers >= MANY else UNBOUNDED)
        while boxes.looked < end and starts < STARTS and not (boxes.done or state.decided or state.late()):
            before = boxes.looked
            small = boxes.look(min(end - before, CHUNK, state.left_for_boxes))
            state.add_boxes(boxes.looked - before)
            if boxes.excluded:
                state.proof = Proof.BOXES
            for box in small:
                starts += 1
                if len(self._problem.targets) == 1 and state.left():
                    start = box[None, : self._problem.chain.n]
                    state.add(self._descent.refine(self._problem, start, state.left()))
            if boxes.looked == before:
                break
