"""Forward kinematics of one frame by Pinocchio: only the joints that move the frame are computed."""

from __future__ import annotations

from threading import local

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.kinematics.coordinates import consecutive


class PinocchioData(local):
    """A ``pin.Data`` for each thread, and the placement of one frame in it."""

    def __init__(self, model: pin.Model, frame: int = 0) -> None:
        self.data = model.createData()
        self.placement = self.data.oMf[frame]


class FrameFK:
    """World placements of one frame, by a reduced model.

    The reduced model has the joints on the way to the frame, and no other frame, so that
    ``pin.framesForwardKinematics`` computes nothing else: 0.3 us. With the whole model it takes 0.5 us on an arm and
    1 us on a humanoid.

    Attributes:
        reduced: The reduced model; the whole model where a joint on the way mimics another.
    """

    def __init__(self, model: pin.Model, frame: int) -> None:
        """``frame`` is an id."""
        way = sorted(set(model.supports[model.frames[frame].parentJoint]) - {0})
        self._entries: NDArray[np.int64] | slice | None = None
        if any(model.joints[j].nq == 0 for j in way):  # a joint that mimics another, perhaps of another limb
            self.reduced = model
        else:
            self.reduced, frame = _reduced(model, way, frame), 1
            joints = [model.joints[j] for j in way]
            entries = np.concatenate([np.arange(joint.idx_q, joint.idx_q + joint.nq) for joint in joints])
            if len(entries) < model.nq:
                self._entries = consecutive(entries)
        self._frame = frame
        self._own = PinocchioData(self.reduced, frame)
        self._spare: list[pin.Data] = []

    def fk(self, q: NDArray[np.float64]) -> pin.SE3:
        """World placement at a configuration q (nq,): a view into ``pin.Data``, which the next call overwrites."""
        own = self._own
        pin.framesForwardKinematics(self.reduced, own.data, q if self._entries is None else q[self._entries])
        return own.placement

    def fk_batch(self, q: NDArray[np.float64]) -> NDArray[np.float64]:
        """World placements at configurations q (k, nq), as positions and quaternions (k, 7).

        ``pin.Data`` objects are pooled, because short-lived threads would make a new one each. Numbers leave Pinocchio
        quickest as a list.
        """
        forward, write, reduced = pin.framesForwardKinematics, pin.SE3ToXYZQUATtuple, self.reduced
        try:
            data = self._spare.pop()
        except IndexError:
            data = reduced.createData()
        placement = data.oMf[self._frame]
        places: list[float] = []
        for one in q if self._entries is None else np.ascontiguousarray(q[:, self._entries]):
            forward(reduced, data, one)
            places += write(placement)
        self._spare.append(data)
        return np.array(places, dtype=float).reshape(-1, 7)


def _reduced(model: pin.Model, way: list[int], frame: int) -> pin.Model:
    """A model with the joints on the way, given by id, and the frame."""
    reduced, parent = pin.Model(), 0
    for j in way:
        parent = reduced.addJoint(parent, model.joints[j], model.jointPlacements[j], model.names[j])
    tip = model.frames[frame]
    reduced.addFrame(pin.Frame(tip.name, parent, 0, tip.placement, tip.type))
    return reduced
