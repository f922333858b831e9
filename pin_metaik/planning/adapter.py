"""A chain in a world for OMPL: a state space, and the validity of states and motions."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import checked, instance
from pin_metaik.collision import CollisionWorld
from pin_metaik.errors import InvalidSetting
from pin_metaik.kinematics import Chain
from pin_metaik.lookup import need


@checked
class Adapter:
    """A chain in a world as a planning problem of OMPL; ``setup()`` returns it for any planner and goal.

    A state is a compound state: a real vector of the joints with limits, then one SO(2) state for each continuous
    joint. It is valid if it is free of collisions in the world. A motion is valid if ``CollisionWorld.clear_between``
    proves it free, so that a path has no collisions between its states either, whatever OMPL's resolution.

    Attributes:
        chain: The chain, with its held joints as in ``base``.
        world: The world.
        base: (nq,) configuration with the values of the joints that the chain does not move.
        space: OMPL's space, an ``ompl.base.CompoundStateSpace``.
    """

    def __init__(self, chain: Chain, world: CollisionWorld, q0: ArrayLike | None = None) -> None:
        """Lay out the space.

        Args:
            chain: The joints that move.
            world: What must not collide.
            q0: (nq,) configuration of the joints that the chain does not move; default: the chain's reference.

        Raises:
            MissingExtra: OMPL is not installed.
            InvalidBounds: If a sliding joint of the chain has no limits.
            InvalidConfiguration: If ``q0`` is not a configuration of the model.
            InvalidSetting: If the world is another model's than the chain.
        """
        need("planning joint moves", "ompl", "ompl")
        from ompl import base as ob

        if world.model is not chain.model and world.model != chain.model:
            raise InvalidSetting(f"the world is of {world.model.name!r}, not of the chain's model {chain.model.name!r}")
        self.chain = chain if q0 is None else chain.at(q0)
        self.world = world
        self.base = chain.reference if q0 is None else chain.configuration(q0)
        self._turning = np.flatnonzero(chain.limits.periodic)
        self._limited = np.flatnonzero(~chain.limits.periodic)
        self._kind = ob.CompoundState
        self.space = ob.CompoundStateSpace()
        if len(self._limited):
            box = chain.box
            bounds, real = ob.RealVectorBounds(len(self._limited)), ob.RealVectorStateSpace(len(self._limited))
            for place, joint in enumerate(self._limited.tolist()):
                bounds.setLow(place, float(box.lower[joint]))
                bounds.setHigh(place, float(box.upper[joint]))
            real.setBounds(bounds)
            self.space.addSubspace(real, 1.0)
        for _ in self._turning:
            self.space.addSubspace(ob.SO2StateSpace(), 1.0)

    def setup(self) -> Any:
        """An ``ompl.geometric.SimpleSetup`` with the space and both checks; give it a start, a goal and a planner."""
        from ompl import base as ob
        from ompl import geometric as og

        adapter, setup = self, og.SimpleSetup(self.space)

        class Motions(ob.MotionValidator):  # type: ignore[misc]  # OMPL carries no types
            """Motions that are proved free."""

            def checkMotion(self, first: Any, second: Any, *_: Any) -> bool:
                """Whether the straight joint move between two states is."""
                return adapter.world.clear_between(adapter.q(first), adapter.q(second))

        information = setup.getSpaceInformation()
        setup.setStateValidityChecker(lambda state: not adapter.world.in_collision(adapter.q(state)))
        information.setMotionValidator(Motions(information))
        return setup

    def state(self, q: ArrayLike) -> Any:
        """A configuration (nq,) as a state of the space.

        Raises:
            InvalidConfiguration: If q is not a configuration of the model.
        """
        x, state = self.chain.x(self.chain.configuration(q)), self.space.allocState()
        for place, joint in enumerate(self._limited.tolist()):
            state[0][place] = float(x[joint])
        for place, joint in enumerate(self._turning.tolist()):
            state[self._first + place].value = float(x[joint])
        return state

    def q(self, state: Any) -> NDArray[np.float64]:
        """A state of the space as a configuration (nq,).

        Raises:
            InvalidSetting: If it is not a compound state.
        """
        instance(self._kind, state=state)
        x = np.empty(self.chain.n)
        for place, joint in enumerate(self._limited.tolist()):
            x[joint] = state[0][place]
        for place, joint in enumerate(self._turning.tolist()):
            x[joint] = state[self._first + place].value
        return self.chain.q(x, self.base)

    @property
    def _first(self) -> int:
        """Number of the first part of a state that is of SO(2)."""
        return 1 if len(self._limited) else 0
