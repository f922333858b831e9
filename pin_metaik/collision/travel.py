"""How far the bodies of a world travel, at most, while joints move: the tables for ``spans``, and its results."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from pin_metaik.collision.checker import Checker
from pin_metaik.collision.screws import Screws
from pin_metaik.collision.solids import Placed


@dataclass(frozen=True, eq=False)
class Carriers:
    """Which joints carry the bodies of a world that move, and how far these reach from them.

    Attributes:
        checker: The checks of the world.
    """

    checker: Checker

    @cached_property
    def screws(self) -> Screws:
        """How the joints move."""
        return Screws(self.checker.solids.model)

    @cached_property
    def supports(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """The joints (m, D) that carry each moving body, from the base on, and how many (m,)."""
        model, bodies = self.checker.solids.model, self.checker.solids.moving
        ways = [list(model.supports[body.joint])[1:] for body in bodies]
        supports = np.zeros((len(ways), max(map(len, ways), default=0) + 1), dtype=np.int64)
        for row, way in zip(supports, ways, strict=True):
            row[: len(way)] = way
        return supports, np.array([len(way) for way in ways], dtype=np.int64)

    @cached_property
    def common(self) -> NDArray[np.int64]:
        """How many joints (p,) carry both bodies of a pair that moves."""
        supports, depths = self.supports
        shared = [
            int((supports[i, :d] == supports[j, :d]).cumprod().sum())
            for i, j in self.checker.asked.own.tolist()
            for d in [min(depths[i], depths[j])]
        ]
        return np.array(shared, dtype=np.int64)

    @cached_property
    def balls(self) -> NDArray[np.float64]:
        """(m, 5) a ball around each moving body in its joint's frame, and how far it reaches from that joint's axis."""
        rows = []
        for body in self.checker.solids.moving:
            box, axis = body.solid.box, self.screws.axes[body.joint]
            corners = body.solid.corners
            middle = body.placement.act(box[:3])
            points = corners @ body.placement.rotation.T + body.placement.translation
            radius = np.linalg.norm(points - middle, axis=1).max()
            lever = np.linalg.norm(np.cross(points - axis[:3], axis[3:]), axis=1).max()
            rows.append([*middle, radius, math.inf if np.isnan(lever) else lever])
        return np.array(rows).reshape(-1, 5)


class Travel:
    """Bounds of how far bodies travel; room for those of one motion, or of one part of it, at a time.

    Attributes:
        moved: (m, D + 1) how far (m) each moving body travels at most by the joints from a number on; its first column
            is the way in the world.
        reaches: (p,) by how much (m) the distance of each pair of bodies that move changes at most.
    """

    def __init__(self, carriers: Carriers) -> None:
        from pin_metaik.collision.spans import span

        solids, asked = carriers.checker.solids, carriers.checker.asked
        supports, depths = carriers.supports
        self.moved, self.reaches = np.zeros(supports.shape), np.zeros(len(asked.margins))
        self._boxes, self._wide = solids.boxes.copy(), asked.margins.copy()
        self._asked = replace(asked, margins=self._wide)
        self._span = cast(Any, span).compiled()  # a frame less
        self._given = (
            supports, depths, carriers.balls, asked.own, carriers.common, asked.margins,
            np.ascontiguousarray(solids.boxes[:, 7]), self.moved, self.reaches, self._wide, self._boxes,
        )  # fmt: skip

    def measure(self, share: float, joints: NDArray[np.float64], screws: NDArray[np.float64]) -> None:
        """Bound the travel from one configuration on, whichever way the joints go.

        Args:
            share: Of what ``screws`` say, how much the joints do at most.
            joints: (J, 12) where the joints are at that configuration, as ``Placed`` has them.
            screws: (J, 8) what each joint does, as ``Screws.along`` has it.
        """
        self._span(share, joints, screws, *self._given)

    def of(self, i: int, own: int) -> float:
        """How much nearer a pair comes at most, m; ``own`` is its row among the pairs that move, or -1."""
        return float(self.reaches[own] if own >= 0 else self.moved[i, 0])

    def near(self, placed: Placed, beyond: float = 0.0) -> list[list[int]]:
        """The pairs whose boxes are not farther apart than their margin, what they travel, and ``beyond``, m."""
        return placed.near(self._asked, beyond, self._boxes)
