"""Where Pinocchio places a frame: the joints that move it, and no others, are computed."""

from __future__ import annotations

from threading import local

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.kinematics.coordinates import consecutive

MANY = 16  # joints from which on it pays to leave the others out: taking the entries of q costs 0.1 us


class Scratch(local):
    """A ``pin.Data``, one a thread."""

    def __init__(self, model: pin.Model) -> None:
        self.data = model.createData()


class Placing:
    """World placements of one frame.

    Of a model with many limbs they are those of a reduced one (``pin.buildReducedModel``), which has only the joints on
    the way to the frame.
    """

    def __init__(self, model: pin.Model, frame: int, reference: NDArray[np.float64]) -> None:
        """``frame`` is an id; ``reference`` (nq,) is where the other joints are, which is of no account."""
        self.model, self.frame = model, frame
        self._entries: NDArray[np.int64] | slice | None = None
        way = sorted(set(model.supports[model.frames[frame].parentJoint]) - {0})
        mimics = any(model.joints[j].nq == 0 for j in way)  # they may follow a joint elsewhere
        if model.njoints > MANY and not mimics:
            others = [j for j in range(1, model.njoints) if j not in way]
            self.model = pin.buildReducedModel(model, others, reference)
            self.frame = self.model.getFrameId(model.frames[frame].name, model.frames[frame].type)
            joints = [model.joints[j] for j in way]
            entries = [np.arange(joint.idx_q, joint.idx_q + joint.nq) for joint in joints]
            self._entries = consecutive(np.concatenate(entries))
        self._own = Scratch(self.model)
        self._spare: list[pin.Data] = []

    def place(self, q: NDArray[np.float64]) -> pin.SE3:
        """At a configuration q (nq,); not to be kept, for it is part of Pinocchio's scratch."""
        data = self._own.data
        pin.forwardKinematics(self.model, data, q if self._entries is None else q[self._entries])
        return pin.updateFramePlacement(self.model, data, self.frame)

    def places(self, q: NDArray[np.float64]) -> NDArray[np.float64]:
        """At configurations q (k, nq), as positions and quaternions (k, 7).

        Threads that do not live long take turns with ``pin.Data``, which takes a while to make. A list of numbers is
        the quickest way out of Pinocchio.
        """
        forward, update, write = pin.forwardKinematics, pin.updateFramePlacement, pin.SE3ToXYZQUATtuple
        model, frame = self.model, self.frame
        try:
            data = self._spare.pop()
        except IndexError:
            data = model.createData()
        places: list[float] = []
        for one in q if self._entries is None else np.ascontiguousarray(q[:, self._entries]):
            forward(model, data, one)
            places += write(update(model, data, frame))
        self._spare.append(data)
        return np.array(places, dtype=float).reshape(-1, 7)
