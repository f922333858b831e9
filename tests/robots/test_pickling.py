"""Pickles of models: the same joints, to the last bit, also where one follows another."""

import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_array_equal

import pin_metaik as mik
from pin_metaik.errors import InvalidModel
from pin_metaik.robots.library import catalogue, example_robots

AXIS = np.array([1.0, 2.0, 3.0]) / np.sqrt(14.0)
KINDS = {
    **dict.fromkeys(("RX", "RY", "RZ", "PX", "PY", "PZ", "RUBX", "RUBY", "RUBZ"), ()),
    **dict.fromkeys(("HX", "HY", "HZ"), (0.3,)),
    "RevoluteUnaligned": (AXIS,),
    "PrismaticUnaligned": (AXIS,),
}
CONTINUOUS = """<robot name="r"><link name="a"/><link name="b"/><link name="c"/>
<joint name="j" type="continuous"><parent link="a"/><child link="b"/><axis xyz="1 2 3"/></joint>
<joint name="k" type="continuous"><parent link="b"/><child link="c"/><axis xyz="1 2 3"/><mimic joint="j"/></joint>
</robot>"""
WORKER = """
import pickle, sys
chains, poses = pickle.load(sys.stdin.buffer)
import pin_metaik as mik
pickle.dump([mik.solve_ik(chain, pose) for chain, pose in zip(chains, poses)], sys.stdout.buffer)
"""


def placements(model: pin.Model) -> list[np.ndarray]:
    data = model.createData()
    pin.forwardKinematics(model, data, pin.integrate(model, pin.neutral(model), np.linspace(-0.7, 0.9, model.nv)))
    return [placement.homogeneous for placement in data.oMi]


def test_every_named_robot_solves_in_another_process_what_it_solves_here_to_the_last_bit():
    robots = [mik.load_robot(name) for name in (*catalogue(), *example_robots())]
    chains = [mik.Chain(robot.model, robot.frame) for robot in robots]
    poses = [chain.poses(0.6 * chain.box.lower + 0.4 * chain.box.upper)[0, 0] for chain in chains]
    work = pickle.dumps((chains, poses))
    assert len(work) < 10_000 * len(chains)
    done = subprocess.run([sys.executable, "-c", WORKER], input=work, capture_output=True)
    assert done.returncode == 0, done.stderr.decode()
    for chain, pose, there in zip(chains, poses, pickle.loads(done.stdout), strict=True):
        here = mik.solve_ik(chain, pose)
        assert_array_equal(here.q, there.q, chain.model.name)
        assert here.status is there.status


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("scaling", [1.0, -0.7246])
def test_a_model_of_ones_own_keeps_a_joint_of_any_kind_that_follows_another(kind, scaling):
    model, joint = pin.Model(), getattr(pin, f"JointModel{kind}")(*KINDS[kind])
    first = model.addJoint(0, joint, pin.SE3.Random(), "first")
    second = model.addJoint(first, joint, pin.SE3.Random(), "second")
    third = model.addJoint(second, pin.JointModelRX(), pin.SE3.Random(), "third joint")
    model.addFrame(pin.Frame("tip of it", third, 0, pin.SE3.Random(), pin.FrameType.OP_FRAME))
    model.upperPositionLimit[:] = np.inf
    coupled = pin.transformJointIntoMimic(model, first, second, scaling, 0.1)
    again = pickle.loads(pickle.dumps(coupled))
    assert again == coupled
    assert_array_equal(placements(again), placements(coupled))


def test_changes_of_a_loaded_model_are_pickled():
    model = mik.load_robot("panda").model
    model.addFrame(pin.Frame("pen", 7, 0, pin.SE3.Random(), pin.FrameType.OP_FRAME))
    model.upperPositionLimit[0] = 0.125
    again = pickle.loads(pickle.dumps(model))
    assert again == model
    assert again.existFrame("pen")


def test_a_follower_that_pinocchio_cannot_make_comes_from_its_urdf_or_is_refused_by_name(tmp_path: Path):
    path = tmp_path / "r.urdf"
    path.write_text(CONTINUOUS)
    model = mik.load_robot(path).model
    assert len(model.mimicking_joints) == 1
    assert_array_equal(placements(pickle.loads(pickle.dumps(model))), placements(model))
    with pytest.raises(InvalidModel, match=r"cannot be pickled.*'k'"):
        pickle.dumps(pin.buildModelFromXML(CONTINUOUS, mimic=True))


def test_a_robot_is_pickled_without_its_meshes():
    robot = mik.load_robot("panda")
    assert robot.collision_model.ngeoms > 0
    pickled = pickle.dumps(robot)
    assert len(pickled) < 100_000
    again = pickle.loads(pickled)
    assert again.model == robot.model
    assert (again.name, again.frame, again.urdf) == (robot.name, robot.frame, robot.urdf)
    assert again.collision_model.ngeoms == robot.collision_model.ngeoms
