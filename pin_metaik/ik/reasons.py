"""Why a target is not met, in words: what is out of reach and of what, which joints cannot move, what collides."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pin_metaik.collision import CollisionWorld, Contact
from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.proof import Proof
from pin_metaik.kinematics import Chain

SHOWN = 3  # contacts in a sentence
FAR = 20.0  # m; farther than anybody means to reach with an arm
FAR_OFF = " (positions are in metres)"


def out_of_reach(problem: IKProblem, nearest: str) -> str:
    """What is proved to be out of reach, and by which means; where no bound says how far, ``nearest`` does."""
    if problem.limits.rigid:
        return f"out of reach: {cannot_move(problem)}"
    if problem.gap > 0.0:
        return too_far(problem)
    formed = problem.nominal_branches
    if formed is not None and formed.proved:
        return f"out of reach: {formed.why()}; {nearest}"
    return f"out of reach: every box of configurations inside the limits is excluded; {nearest}"


def too_far(problem: IKProblem) -> str:
    """Which frame, or the wrist behind it, is proved to be farther away than the links can span."""
    gaps = [max(problem.gaps(t)) for t in range(len(problem.targets))]
    t = int(np.argmax(gaps))
    at, behind = problem.gaps(t)
    whose = f"{problem.chain.frames[t]} is " if len(gaps) > 1 else ""
    if at > 0.0:
        return f"{whose}out of reach: at least {at:.3g} m beyond what the links can span{FAR_OFF if at > FAR else ''}"
    return (
        f"{whose}out of reach with this orientation: it puts the wrist, a point of the last joint's axis, at least "
        f"{behind:.3g} m beyond what the links before it can span"
    )


def cannot_move(problem: IKProblem) -> str:
    """The joints that cannot move, because their limits leave them no range; empty if there are none."""
    stuck = problem.limits.stuck
    if not stuck:
        return ""
    return f"{', '.join(stuck)} cannot move: {'its' if len(stuck) == 1 else 'their'} limits are equal"


def in_collision(proof: Proof | None, resolution: float | None) -> str:
    """That a target is met only in collision, and how well its solutions were looked at."""
    if proof is not None:
        return "every solution collides"
    if resolution is not None:
        return f"every solution found collides, one in each box of half width {resolution:g} rad"
    return "every solution found collides, but others may exist"


def collisions(chain: Chain, world: CollisionWorld | None, contacts: Sequence[Contact]) -> str:
    """What collides, and of bodies that the chain does not move what would help."""
    said = "; ".join(str(one) + _remedy(chain, world, one) for one in contacts[:SHOWN])
    return said + ("; ..." if len(contacts) > SHOWN else "")


def _remedy(chain: Chain, world: CollisionWorld | None, contact: Contact) -> str:
    """What to do about two bodies that the chain does not move; empty if it moves one of them."""
    if world is None:
        return ""
    supports = chain.model.supports
    on = [body.joint for body in world.checker.bodies if body.link in (contact.first, contact.second)]
    ways = {j for joint in on for j in supports[joint] if j}
    if ways & chain.movers:
        return ""
    move = "move it in q0" if ways else "move the obstacle"
    return f" (neither moves with the chain: {move}, or world.allow({contact.first!r}, {contact.second!r}))"
