"""Followers follow, whatever names and order their tags have."""

import itertools
import pickle
import xml.etree.ElementTree as ET

import numpy as np
import pinocchio as pin
import pytest

import pin_metaik as mik
from pin_metaik.robots import load_robot
from pin_metaik.robots.library import example_robots
from tests.robots.plain_kinematics import link_placements


def joint(name, parent, child, kind="revolute", mimic="", limit='lower="-2" upper="2" effort="1" velocity="1"'):
    tag = f"<mimic {mimic}/>" if mimic else ""
    return (
        f'<link name="{child}"/><joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="0.3 0.1 0.2" rpy="0.3 -0.4 0.5"/><axis xyz="0.6 0 0.8"/><limit {limit}/>{tag}</joint>'
    )


def robot(*joints):
    return f'<robot name="r"><link name="base"/>{"".join(joints)}</robot>'


def led(urdf, x):
    """Coordinates of leaders that the model has as followers, from those of the joints that mimic them."""
    tags = {joint.get("name"): joint.find("mimic") for joint in ET.fromstring(urdf).iterfind("joint[mimic]")}
    return {
        tag.get("joint"): (x[name] - float(tag.get("offset", 0))) / float(tag.get("multiplier", 1))
        for name, tag in tags.items()
        if name in x
    }


def assert_moves_by_the_textbook(urdf, expected_names, **settings):
    """Pinocchio places every link where the textbook does, the model's coordinates being the joints expected."""
    model = load_robot(urdf, **settings).model
    free = [name for i, name in enumerate(model.names) if i and i not in set(model.mimicking_joints)]
    assert sorted(free) == sorted(expected_names)
    data, rng = model.createData(), np.random.default_rng(0)
    for _ in range(5):
        x = dict(zip(free, rng.uniform(-1.5, 1.5, len(free)), strict=True))
        v = np.zeros(model.nv)
        for name, value in x.items():
            v[model.joints[model.getJointId(name)].idx_v] = value
        pin.framesForwardKinematics(model, data, pin.integrate(model, pin.neutral(model), v))
        for link, placement in link_placements(urdf, x | led(urdf, x)).items():
            frame = model.getFrameId(link, pin.FrameType.BODY)
            np.testing.assert_allclose(data.oMf[frame].homogeneous, placement, atol=1e-12, err_msg=link)
    return model


TREES = {
    "a follower behind its leader": (robot(joint("l", "base", "a"), joint("f", "a", "b", mimic='joint="l"')), ["l"]),
    "a follower named before its leader": (
        robot(joint("z", "base", "a"), joint("b", "base", "b", mimic='joint="z" multiplier="-2" offset="0.3"')),
        ["z"],
    ),
    "a leader that hangs on its follower": (
        robot(joint("f", "base", "a", mimic='joint="l" multiplier="0.5" offset="0.2"'), joint("l", "a", "b")),
        ["f"],
    ),
    "followers of a follower": (
        robot(
            joint("a", "base", "a", mimic='joint="b" multiplier="2" offset="0.1"'),
            joint("b", "base", "b", mimic='joint="c" multiplier="-0.5" offset="0.2"'),
            joint("c", "base", "c"),
        ),
        ["c"],
    ),
    "two limbs whose leaders come first in one order only": (
        robot(
            joint("a", "base", "a"),
            joint("b", "base", "b"),
            joint("c", "a", "c", mimic='joint="d" multiplier="2"'),
            joint("d", "b", "d"),
        ),
        ["a", "b", "d"],
    ),
    "two limbs that lead each other": (
        robot(
            joint("a", "base", "a"),
            joint("b", "base", "b"),
            joint("c", "a", "c", mimic='joint="d" multiplier="2"'),
            joint("d", "b", "d"),
            joint("e", "b", "e", mimic='joint="f" offset="0.5"'),
            joint("f", "a", "f"),
        ),
        ["a", "b", "c", "f"],
    ),
    "a multiplier of zero": (
        robot(joint("l", "base", "a"), joint("f", "a", "b", mimic='joint="l" multiplier="0" offset="0.7"')),
        ["l"],
    ),
    "a leader that is fixed": (
        robot(
            joint("l", "base", "a", "fixed"), joint("f", "a", "b", mimic='joint="l" offset="0.7"'), joint("m", "b", "c")
        ),
        ["m"],
    ),
    "a follower that is fixed": (
        robot(joint("l", "base", "a"), joint("f", "a", "b", "fixed", mimic='joint="l"')),
        ["l"],
    ),
    "followers of one that is constant": (
        robot(
            joint("l", "base", "a"),
            joint("f", "a", "b", "continuous", mimic='joint="l" multiplier="0" offset="0.7"'),
            joint("g", "b", "c", mimic='joint="f" multiplier="3"'),
        ),
        ["l"],
    ),
}
TREES |= {
    f"a {kind} follower of a {followed} leader, {name}": (
        robot(
            joint("l", "base", "a", followed), joint(name, "base", "b", kind, 'joint="l" multiplier="-0.5" offset="1"')
        ),
        ["l"],
    )
    for kind, followed in itertools.product(["revolute", "continuous", "prismatic"], repeat=2)
    for name in ("k", "m")
}


@pytest.mark.parametrize("base", [False, True], ids=["fixed base", "free flyer"])
@pytest.mark.parametrize("what", TREES)
def test_a_coupled_joint_is_where_its_tag_has_it(what, base):
    urdf, names = TREES[what]
    if not base:
        assert_moves_by_the_textbook(urdf, names)
    assert load_robot(urdf, free_flyer=base).free_mimics == ()
    assert load_robot(urdf, free_flyer=base).model.nv == len(names) + 6 * base


def test_names_of_joints_and_frames_are_those_of_the_file():
    urdf = robot(joint("z", "base", "a"), joint("b", "base", "b", mimic='joint="z"'), joint("t", "b", "t", "fixed"))
    model = load_robot(urdf).model
    assert list(model.names) == ["universe", "z", "b"]
    assert [frame.name for frame in model.frames] == ["universe", "base", "z", "a", "b", "b", "t", "t"]
    free = load_robot(urdf, free_flyer=True).model
    assert list(free.names) == ["universe", "root_joint", "z", "b"]


@pytest.mark.parametrize("name", ["baxter", "panda", "pr2", "tiago_pro"])
@pytest.mark.filterwarnings("ignore:.*these limits are ignored")
def test_where_pinocchio_can_hold_the_tags_the_model_is_pinocchios(name):
    ours, theirs = load_robot(name).model, pin.buildModelFromUrdf(str(example_robots()[name].urdf), mimic=True)
    theirs.lowerPositionLimit, theirs.upperPositionLimit = ours.lowerPositionLimit, ours.upperPositionLimit
    assert ours == theirs


def test_the_same_gripper_gives_the_same_answer_whatever_its_followers_name():
    def finger(name, child, side, tag=""):
        return (
            f'<link name="{child}"/><joint name="{name}" type="prismatic"><parent link="hand"/><child link="{child}"/>'
            f'<axis xyz="0 {side} 0"/><limit lower="0" upper="0.05" effort="1" velocity="1"/>{tag}</joint>'
        )

    answers = []
    for follower in ("left", "zleft"):
        fingers = finger("right", "a", 1) + finger(follower, "b", -1, '<mimic joint="right"/>')
        arm = load_robot(robot(joint("arm", "base", "hand"), fingers))
        chain = mik.Chain(arm.model, ["a", "b"], locked=["arm"])
        apart, together = (
            [mik.Target.at(T.translation, frame=f) for T, f in zip(chain.placements(q), "ab", strict=True)]
            for q in (chain.q([0.01]), chain.q([0.04]))
        )
        assert chain.names == ("right",)
        assert mik.solve_ik(chain, apart).status.name == "SOLVED"
        answers.append(mik.solve_ik(chain, [apart[0], together[1]]).status.name)
    assert answers == ["OUT_OF_TOLERANCE"] * 2 or answers == ["UNREACHABLE"] * 2


MEANINGLESS = {
    "a leader that does not exist": (
        robot(joint("left_q1", "base", "a"), joint("left_q2", "a", "b", mimic='joint="ft_q1"')),
        r"'left_q2' mimics 'ft_q1', which does not exist \(did you mean 'left_q1'\?\): it is free",
    ),
    "no leader": (
        robot(joint("a", "base", "a"), joint("b", "a", "b", mimic='multiplier="2"')),
        "'b' mimics '', which does not exist: it is free",
    ),
    "itself": (
        robot(joint("a", "base", "a"), joint("b", "a", "b", mimic='joint="b"')),
        "'b' mimics itself: it is free",
    ),
    "a circle": (
        robot(joint("a", "base", "a", mimic='joint="b"'), joint("b", "a", "b", mimic='joint="a"')),
        "'a' mimics itself by way of 'b': it is free",
    ),
    "a leader with six degrees of freedom": (
        robot(joint("a", "base", "a", "floating"), joint("b", "a", "b", mimic='joint="a"')),
        r"'b' mimics 'a', but 'a' \(floating\) has several coordinates: it is free",
    ),
    "a follower with three": (
        robot(joint("a", "base", "a"), joint("b", "a", "b", "planar", mimic='joint="a"')),
        r"'b' mimics 'a', but 'b' \(planar\) has several coordinates: it is free",
    ),
}


@pytest.mark.filterwarnings("ignore:.*it is free")
@pytest.mark.parametrize("what", MEANINGLESS)
def test_a_tag_that_means_nothing_leaves_its_joint_free_and_is_said(what):
    urdf, message = MEANINGLESS[what]
    with pytest.warns(UserWarning, match=message):
        arm = load_robot(urdf)
    assert "b" in arm.free_mimics or "left_q2" in arm.free_mimics
    assert arm.model.nv == load_robot(urdf, mimic=False).model.nv


def test_who_follows_a_circle_follows_the_joint_of_it_that_is_free():
    tags = {"a": 'joint="b"', "b": 'joint="a"', "c": 'joint="b" multiplier="2"'}
    urdf = robot(*(joint(name, "base", name, mimic=tag) for name, tag in tags.items()))
    with pytest.warns(UserWarning, match="itself by way of"):
        arm = load_robot(urdf)
    assert arm.free_mimics == ("a", "b")
    assert [arm.model.names[i] for i in arm.model.mimicking_joints] == ["c"]


@pytest.mark.parametrize(("key", "value"), [("multiplier", "two"), ("offset", "nan"), ("multiplier", "inf")])
def test_a_factor_that_is_no_number_is_named_with_its_joint(key, value):
    urdf = robot(joint("a", "base", "a"), joint("b", "a", "b", mimic=f'joint="a" {key}="{value}"'))
    with pytest.raises(mik.MetaIKError, match=f"joint 'b' mimics with {key} = '{value}', which is not a number"):
        load_robot(urdf)


@pytest.mark.parametrize(
    ("tag", "limit", "expected"),
    [
        ('joint="a"', 'lower="-0.5" upper="1"', (-0.5, 1.0)),
        ('joint="a" multiplier="2" offset="1"', 'lower="0" upper="2"', (-0.5, 0.5)),
        ('joint="a" multiplier="-1"', 'lower="-3" upper="1"', (-1.0, 2.0)),
        ('joint="a" multiplier="-1"', 'lower="-9" upper="9"', (-2.0, 2.0)),
    ],
)
def test_the_limits_of_a_follower_bind_its_leader(tag, limit, expected):
    urdf = robot(joint("a", "base", "a"), joint("b", "base", "b", mimic=tag, limit=f'{limit} effort="1" velocity="1"'))
    model = load_robot(urdf).model
    np.testing.assert_allclose((model.lowerPositionLimit[0], model.upperPositionLimit[0]), expected, atol=1e-12)


@pytest.mark.parametrize("limit", ['lower="0" upper="0"', 'lower="5" upper="6"', 'lower="1" upper="-1"'])
def test_limits_that_contradict_a_coupling_are_not_kept_and_said(limit):
    urdf = robot(
        joint("a", "base", "a"), joint("b", "a", "b", mimic='joint="a"', limit=f'{limit} effort="1" velocity="1"')
    )
    with pytest.warns(UserWarning, match=r"joint 'b' is 1 \* 'a' \+ 0, which its limits .* exclude"):
        model = load_robot(urdf).model
    assert (model.lowerPositionLimit[0], model.upperPositionLimit[0]) == (-2.0, 2.0)


def test_the_description_of_a_robot_with_followers_pickles_and_makes_the_same_model():
    for urdf, _ in TREES.values():
        arm = load_robot(urdf)
        assert pickle.loads(pickle.dumps(arm.description)).model() == arm.model
