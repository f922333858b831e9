"""Mimic tags: which joint follows which, whatever their names, and Pinocchio's model of it.

A follower is at multiplier * leader + offset. Pinocchio holds that for joints whose leader comes earlier in its order,
which is the alphabetical one of siblings, and if it cannot hold one tag it holds none. So tags are resolved here: a
follower of a follower follows the first leader, a constant is one (multiplier 0, or a leader that is fixed), siblings
are put in an order in which leaders come first, and where the tree forbids that (the leader hangs on its follower), the
equation is turned round.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from difflib import SequenceMatcher, get_close_matches
from math import inf, isfinite, nan

import numpy as np
import pinocchio as pin

from pin_metaik.errors import InvalidModel
from pin_metaik.robots.wording import NO_LIMIT

SINGLE = ("revolute", "continuous", "prismatic")  # joints with one degree of freedom
NO_ROOM = 1e-9  # rad or m; a joint with no wider range cannot move
RANK = "06d"
PINOCCHIOS = ("universe", "root_joint")  # names that Pinocchio gives


@dataclass(frozen=True)
class Coupling:
    """The follower's position is multiplier * leader's + offset (rad, m)."""

    follower: str
    leader: str
    multiplier: float
    offset: float


@dataclass(frozen=True)
class Couplings:
    """The couplings that the mimic tags of a URDF describe.

    Attributes:
        kinds: Type of each joint, by name.
        followers: Couplings of followers to joints that follow none.
        constants: Position of each follower of something that does not move, by name.
        broken: The fault of each tag that means nothing, by the name of its joint, which stays free.
    """

    kinds: Mapping[str, str]
    followers: tuple[Coupling, ...]
    constants: Mapping[str, float]
    broken: Mapping[str, str]

    @property
    def unlimited(self) -> set[str]:
        """Continuous joints to be modelled as an angle without limits: all others cannot follow, nor be followed."""
        groups = defaultdict(list)
        for coupling in self.followers:
            groups[coupling.leader].append(coupling)
        mixed = [
            {leader, *(coupling.follower for coupling in group)}
            for leader, group in groups.items()
            if any(abs(coupling.multiplier) != 1.0 for coupling in group)
            or {self.kinds[leader], *(self.kinds[coupling.follower] for coupling in group)} != {"continuous"}
        ]
        return {name for group in mixed for name in group if self.kinds[name] == "continuous"}


NO_COUPLINGS = Couplings({}, (), {}, {})


def read_couplings(robot: ET.Element, what: str) -> Couplings:
    """The mimic tags of a URDF's joints that move.

    Raises:
        InvalidModel: If a multiplier or an offset is not a number; the joint is named.
    """
    kinds = {joint.get("name", ""): joint.get("type", "") for joint in robot.iterfind("joint")}
    tags = {name: tag for name, tag in _tags(robot, what).items() if kinds[name] != "fixed"}
    broken = {name: wrong for name, tag in tags.items() if (wrong := _wrong(tag, kinds))}
    tags = {name: tag for name, tag in tags.items() if name not in broken}
    for name in tags:
        if name in (circle := _way(tags, name)[1:]):
            broken[name] = f"joint {name!r} mimics itself" + (f" by way of {circle[0]!r}" if len(circle) > 1 else "")
    tags = {name: tag for name, tag in tags.items() if name not in broken}

    followers, constants = [], {}
    for name in tags:
        multiplier, offset = 1.0, 0.0
        *way, leader = _way(tags, name)
        for link in way:
            offset += multiplier * tags[link].offset
            multiplier *= tags[link].multiplier
        if multiplier == 0.0 or kinds[leader] == "fixed":
            constants[name] = offset
        else:
            followers.append(Coupling(name, leader, multiplier, offset))
    return Couplings(kinds, tuple(followers), constants, broken)


def make_ready(motion: ET.Element, couplings: Couplings) -> bool:
    """Change a URDF's tree so that followers can follow: leaders come first, and both have the same kind of coordinate.

    Returns:
        Whether joints got other names, by which siblings sort; ``with_own_names`` gives them back.
    """
    for joint in motion.iterfind("joint"):
        for tag in joint.findall("mimic"):
            joint.remove(tag)
        if joint.get("name") in couplings.unlimited:
            joint.set("type", "revolute")
            limit = joint.find("limit")
            limit = ET.SubElement(joint, "limit", effort=NO_LIMIT, velocity=NO_LIMIT) if limit is None else limit
            limit.attrib.update(lower=f"-{NO_LIMIT}", upper=NO_LIMIT)
    names = _names_in_order(motion, couplings) if couplings.followers else {}
    for joint in motion.iterfind("joint"):
        joint.set("name", names.get(joint.get("name", ""), joint.get("name", "")))
    return bool(names)


def with_own_names(model: pin.Model) -> None:
    """Give joints that ``make_ready`` renamed their own names again."""
    cut = len(f"{0:{RANK}} ")
    for i, name in enumerate(model.names):
        model.names[i] = name if name in PINOCCHIOS else name[cut:]
    for frame in model.frames:
        if frame.type in (pin.FrameType.JOINT, pin.FrameType.FIXED_JOINT) and frame.name not in PINOCCHIOS:
            frame.name = frame.name[cut:]


def coupled(model: pin.Model, couplings: Couplings) -> tuple[pin.Model, list[str]]:
    """The model in which followers follow, constants are fixed, and followers' limits bind what they follow.

    Args:
        model: The model in which all joints are free; it is left alone.
        couplings: Their couplings.

    Returns:
        The model, and what has to be said of limits that contradict a coupling.
    """
    model = _with_constants(model, couplings.constants)
    ranges = {name: _range(model, name) for name in list(model.names)[1:]}
    groups: dict[str, dict[str, tuple[float, float]]] = defaultdict(dict)
    for c in couplings.followers:
        groups[c.leader][c.follower] = c.multiplier, c.offset
    bound, remarks = {}, []
    for leader, followers in groups.items():
        lines = {leader: (1.0, 0.0), **followers}  # position of each joint = m * leader's + o
        driver = min(lines, key=model.getJointId)
        slope, shift = lines.pop(driver)
        low, high = ranges[driver]
        for name, (m, o) in lines.items():
            multiplier, offset = m / slope, o - m * shift / slope
            model = pin.transformJointIntoMimic(
                model, model.getJointId(driver), model.getJointId(name), multiplier, offset
            )
            ends = [(end - offset) / multiplier for end in ranges[name]][:: 1 if multiplier > 0 else -1]
            narrow = max(low, ends[0]), min(high, ends[1])
            if narrow[1] - narrow[0] > NO_ROOM:
                low, high = narrow
            elif high - low > NO_ROOM:
                remarks.append(
                    f"joint {name!r} is {multiplier:g} * {driver!r} + {offset:g}, "
                    f"which its limits {list(ranges[name])} exclude: these limits are ignored"
                )
        bound[driver] = low, high
    for name, (low, high) in bound.items():
        joint = model.joints[model.getJointId(name)]
        if joint.nq == 1:
            model.lowerPositionLimit[joint.idx_q], model.upperPositionLimit[joint.idx_q] = low, high
    return model, remarks


def _tags(robot: ET.Element, what: str) -> dict[str, Coupling]:
    tags = {}
    for joint in robot.iterfind("joint[mimic]"):
        name, tag = joint.get("name", ""), joint.find("mimic")
        assert tag is not None
        numbers = []
        for key, value in (("multiplier", tag.get("multiplier", "1")), ("offset", tag.get("offset", "0"))):
            try:
                numbers.append(float(value))
            except ValueError:
                numbers.append(nan)
            if not isfinite(numbers[-1]):
                raise InvalidModel(f"{what}: joint {name!r} mimics with {key} = {value!r}, which is not a number")
        tags[name] = Coupling(name, tag.get("joint", ""), *numbers)
    return tags


def _wrong(tag: Coupling, kinds: Mapping[str, str]) -> str:
    """Why a tag means nothing; empty if it means something."""
    if tag.leader not in kinds:
        near = get_close_matches(tag.leader, sorted({*kinds} - {tag.follower}))
        near.sort(key=lambda name: -SequenceMatcher(None, name, tag.follower).ratio())  # left follows left
        hint = f" (did you mean {near[0]!r}?)" if near else ""
        return f"joint {tag.follower!r} mimics {tag.leader!r}, which does not exist{hint}"
    for name in (tag.follower, tag.leader):
        if kinds[name] not in (*SINGLE, "fixed"):
            return f"joint {tag.follower!r} mimics {tag.leader!r}, but {name!r} ({kinds[name]}) has several coordinates"
    return ""


def _way(tags: Mapping[str, Coupling], name: str) -> list[str]:
    """A joint, the one it follows, the one which that follows ..., up to one that follows none or came before."""
    way = [name]
    while way[-1] in tags:
        way.append(tags[way[-1]].leader)
        if way[-1] in way[:-1]:
            break
    return way


def _link(joint: ET.Element, end: str) -> str:
    element = joint.find(end)
    return "" if element is None else element.get("link", "")


def _names_in_order(robot: ET.Element, couplings: Couplings) -> dict[str, str]:
    """New names of all joints, by which siblings sort with leaders before followers; none if they do already."""
    joints = {joint.get("name", ""): joint for joint in robot.iterfind("joint")}
    above = {_link(joint, "child"): name for name, joint in joints.items()}
    siblings = defaultdict(list)
    for name, joint in joints.items():
        siblings[_link(joint, "parent")].append(name)

    def limb(name: str) -> list[str]:
        """The joints from the root to this one."""
        way = [name]
        while (upper := above.get(_link(joints[way[-1]], "parent"))) and upper not in way:
            way.append(upper)
        return way[::-1]

    pairs = ((limb(coupling.leader), limb(coupling.follower)) for coupling in couplings.followers)
    forks = (next(((a, b) for a, b in zip(*pair, strict=False) if a != b), None) for pair in pairs)
    earlier = {fork for fork in forks if fork is not None}
    orders = [_sorted(names, earlier) for names in siblings.values()]
    if all(order == sorted(order) for order in orders):
        return {}
    return {name: f"{rank:{RANK}} {name}" for order in orders for rank, name in enumerate(order)}


def _sorted(names: list[str], earlier: set[tuple[str, str]]) -> list[str]:
    """Names by the alphabet, but those of each pair ``earlier`` in its order, as far as no circle forbids it."""
    rest, order = sorted(names), []
    while rest:
        free = (name for name in rest if not any((other, name) in earlier for other in rest))
        order.append(next(free, rest[0]))
        rest.remove(order[-1])
    return order


def _with_constants(model: pin.Model, constants: Mapping[str, float]) -> pin.Model:
    q = pin.neutral(model)
    for name, value in constants.items():
        joint = model.joints[model.getJointId(name)]
        q[joint.idx_q : joint.idx_q + joint.nq] = [value] if joint.nq == 1 else [np.cos(value), np.sin(value)]
    return pin.buildReducedModel(model, [model.getJointId(name) for name in constants], q) if constants else model


def _range(model: pin.Model, name: str) -> tuple[float, float]:
    """Limits of a joint with one degree of freedom; none, if it is written as a pair."""
    joint = model.joints[model.getJointId(name)]
    if joint.nq > 1:
        return -inf, inf
    return float(model.lowerPositionLimit[joint.idx_q]), float(model.upperPositionLimit[joint.idx_q])
