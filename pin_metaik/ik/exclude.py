"""Boxes of configurations, by turns with the descents of a search: they prove that it is in vain, or help."""

from __future__ import annotations

from pin_metaik.ik.ledger import Ledger
from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.proof import Proof
from pin_metaik.ik.refine import Refiner
from pin_metaik.kinematics.proofs.boxes import Boxes

STAGES = (300, 400), (1_000, 3_000), (3_000, 30_000)  # after so many evaluations of a search, so many boxes
MANY = 9  # joints from which on the last stage proves next to nothing: of talos' nine 2 targets of 18
CHUNK = 1_000  # boxes between two looks at the clock, where Ctrl-C is heard, too
STARTS = 8  # boxes too small to be split, of one stage, that are descended from


class Exclusion:
    """The boxes of one problem, for each of its frames: when one frame cannot be where it shall, not all can.

    A box takes about as long as an evaluation and counts as one. Few are looked at early: most targets that are out of
    reach need few, and most that are not are solved by then.
    """

    def __init__(self, problem: IKProblem, refiner: Refiner) -> None:
        """Begin with all configurations inside the limits."""
        self._problem, self._refiner = problem.whole, refiner
        frames = range(len(problem.targets))
        self._boxes = [boxes for t in frames if (boxes := problem.boxes(t)) is not None]
        self._stages = list(STAGES if problem.chain.n < MANY else STAGES[:-1])

    def go_on(self, ledger: Ledger) -> None:
        """Look at the boxes that are due after the evaluations that the search has taken so far."""
        while self._stages and ledger.searched >= self._stages[0][0]:
            _, most = self._stages.pop(0)
            for boxes in self._boxes:
                self._look(boxes, most, ledger)

    def _look(self, boxes: Boxes, most: int, ledger: Ledger) -> None:
        """Look at so many boxes of one frame, and descend from those that are too small to be split."""
        starts, end = 0, boxes.looked + most
        while starts < STARTS and not boxes.done and not ledger.over():
            before = boxes.looked
            small = boxes.look(min(end - before, CHUNK, ledger.left_for_boxes))
            ledger.add_boxes(boxes.looked - before)
            if boxes.excluded:
                ledger.proof = Proof.BOXES
            for box in small:
                starts += 1
                if len(self._problem.targets) == 1:
                    start = box[None, : self._problem.chain.n]
                    ledger.add(self._refiner.refine(self._problem, start, ledger.left()))
            if boxes.looked == before:
                break
