"""The default tip of a robot, found by the names of its links and the tree of its joints."""

from __future__ import annotations

import re
from collections import Counter

import pinocchio as pin

_LINKS = (pin.FrameType.BODY, pin.FrameType.OP_FRAME)
# Names of frames to reach with, the clearest word first.
_SAYS = [
    re.compile(pattern)
    for pattern in (
        r"\btool 0\b",
        r"\btcp\b|\btool cent",
        r"tool",
        r"\bee\b|\beef\b|\bend ?eff|\bendeff",
        r"\bgrasp",
        r"\bflange\b",
        r"\bhand\b|\bpalm\b|\bgripper\b",
        r"\btip\b",
    )
]
_CLEAR = 5  # of these words the first that a gripper's joint does not contradict
# Never the tip: parts of a gripper, of a sensor, of a drive, or shapes of another link.
_NEVER = re.compile(
    r"\b(finger|thumb|knuckle|jaw|claw|camera|optical|aruco|marker|propeller|sensor|laser|lidar|wheel|caster|collision|"
    r"visual|kinect|realsense|acceler|fixture|toolbox)|\b(index|middle|ring|pinky|little|pads?|cam|lens|prop|rotor|imu|"
    r"gyro|led|sc|com|cover|cable|screw|infra\d*|depth|color|rgb|mic|gps)\b"
)
_FINGERS = re.compile(r"\b(finger|thumb|knuckle|jaw|claw)")
_GRIPS = re.compile(r"\b(gripper|grip)\b")
_TURNS_A_WRIST = re.compile(r"\b(roll|pitch|yaw|rotat|rot|wrist)")


def default_tip(model: pin.Model) -> str:
    """The frame that is meant, or an empty name, if no joint moves any.

    Frames are links (or sites of MJCF) that a joint moves, under a name no other of them has. Those whose name says
    that they are a finger, a camera or the like are left out, and so are those that a gripper opens and closes; of the
    others the clearest name counts, and if no name says it, the leaf with the most joints on its way, a leaf of a
    fixed joint before others. Equals are taken by the alphabet.
    """
    count = Counter(frame.name for frame in model.frames if frame.type in _LINKS)
    links = [
        i
        for i, frame in enumerate(model.frames)
        if frame.parentJoint > 0 and frame.type in _LINKS and count[frame.name] == 1
    ]
    words = {i: _words(model.frames[i].name) for i in links}
    gripped = {i for i in links if _is_gripped(model, model.frames[i].parentJoint)}
    says = {i: next((k for k, word in enumerate(_SAYS) if word.search(words[i])), len(_SAYS)) for i in links}
    meant = [i for i in links if not _NEVER.search(words[i])]
    meant = [i for i in meant if i not in gripped or says[i] < _CLEAR] or meant or links
    if not meant:
        return ""
    depth = {i: len(model.supports[model.frames[i].parentJoint]) - 1 for i in meant}
    leaves = set(meant) - {upper for i in meant for upper in _above(model, i)}
    far = 0.5 * max(depth.values())

    def order(i: int) -> tuple[object, ...]:
        clear = says[i] if depth[i] >= far else len(_SAYS)
        fixed = model.frames[model.frames[i].parentFrame].type == pin.FrameType.FIXED_JOINT
        return clear, i not in leaves, -depth[i], not fixed, model.frames[i].name

    return str(model.frames[min(meant, key=order)].name)


def _words(name: str) -> str:
    """A name as words in small letters: "EndEffector_Link" and "tool0" are "end effector link" and "tool 0"."""
    return " ".join(re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+", name)).lower()


def _above(model: pin.Model, frame: int) -> set[int]:
    """The frames on the way from a frame to the root."""
    way: set[int] = set()
    while (frame := model.frames[frame].parentFrame) > 0 and frame not in way:  # some models' frames name themselves
        way.add(frame)
    return way


def _is_gripped(model: pin.Model, joint: int) -> bool:
    """Whether a gripper's joint moves it: one that follows another, one followed by its sibling, or one named so."""
    if joint in set(model.mimicking_joints):
        return True
    for mimicking, mimicked in zip(model.mimicking_joints, model.mimicked_joints, strict=True):
        if mimicked == joint and model.parents[mimicking] == model.parents[mimicked]:
            return True
    return any(_FINGERS.search(_words(model.names[j])) for j in list(model.supports[joint])[1:]) or (
        bool(_GRIPS.search(_words(model.names[joint])))
        and not _TURNS_A_WRIST.search(_words(model.names[joint]))
        and joint not in set(model.parents)  # else it carries the gripper
    )
