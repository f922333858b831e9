from pathlib import Path

import coal
import numpy as np
import pinocchio as pin
import pytest

from pin_metaik.errors import InvalidTable
from pin_metaik.robots import DHRow, DHTable, Placement, load_robot, read_table, to_urdf, write_urdfs
from pin_metaik.robots.library import catalogue

URDF = Path(__file__).parents[2] / "urdf"
ANGLES = [0, 0, np.pi / 2, -np.pi / 2, np.pi, -np.pi, 2.0, -0.3, 1e-7]


def random_placement(rng: np.random.Generator) -> Placement:
    if rng.random() < 0.5:
        return Placement()
    return Placement(tuple(rng.normal(size=3)), tuple(rng.choice(ANGLES, size=3)))


def random_table(rng: np.random.Generator) -> DHTable:
    """A table of either convention with all kinds of joints, offsets, and the right angles at which rpy locks."""
    rows = []
    for _ in range(rng.integers(1, 8)):
        kind = rng.choice(["revolute", "continuous", "prismatic"])
        limits = {} if kind == "continuous" else {"lower": -rng.random(), "upper": rng.random()}
        if kind == "continuous":
            limits = {"lower": -np.inf, "upper": np.inf}
        a, d = rng.normal(size=2) * rng.integers(0, 2, size=2)
        rows.append(DHRow(a, rng.choice(ANGLES), d, rng.choice(ANGLES), str(kind), **limits))
    convention = str(rng.choice(["standard", "modified"]))
    return DHTable("random", convention, tuple(rows), random_placement(rng), random_placement(rng))


def joints(model: pin.Model, table: DHTable, q: np.ndarray) -> np.ndarray:
    """Joint positions as a configuration: a continuous joint is held as cosine and sine."""
    assert list(model.names)[1:] == list(table.joint_names)
    return pin.integrate(model, pin.neutral(model), q)


def random_q(table: DHTable, rng: np.random.Generator) -> np.ndarray:
    return np.array([rng.uniform(max(row.lower, -7), min(row.upper, 7)) for row in table.rows])


def assert_same_kinematics(table: DHTable, model: pin.Model, rng: np.random.Generator, times: int) -> None:
    data = model.createData()
    size = 1 + sum(abs(row.a) + abs(row.d) for row in table.rows)
    for q in [np.zeros(len(table.rows)), *(random_q(table, rng) for _ in range(times))]:
        pin.framesForwardKinematics(model, data, joints(model, table, q))
        tool, flange = (data.oMf[model.getFrameId(name)].homogeneous for name in ("tool0", "flange"))
        np.testing.assert_allclose(tool, table.fk(q), atol=1e-12 * size)
        np.testing.assert_allclose(flange, table.frames(q)[-1], atol=1e-12 * size)


@pytest.mark.parametrize("name", catalogue())
def test_a_catalogue_table_and_its_urdf_agree(name):
    assert_same_kinematics(read_table(catalogue()[name]), load_robot(name).model, np.random.default_rng(0), 100)


def test_any_table_and_its_urdf_agree():
    rng = np.random.default_rng(1)
    for _ in range(400):
        table = random_table(rng)
        assert_same_kinematics(table, pin.buildModelFromXML(to_urdf(table)), rng, 3)


def test_any_table_gives_a_model_with_its_limits_and_speeds():
    rng = np.random.default_rng(2)
    for _ in range(50):
        table = random_table(rng)
        model = pin.buildModelFromXML(to_urdf(table))
        np.testing.assert_array_equal(model.velocityLimit, [row.velocity for row in table.rows])
        for row, joint in zip(table.rows, list(model.joints)[1:], strict=True):
            assert joint.nq == (2 if row.type == "continuous" else 1)
            if joint.nq == 1:
                limits = model.lowerPositionLimit[joint.idx_q], model.upperPositionLimit[joint.idx_q]
                assert limits == (row.lower, row.upper)


def test_any_table_gives_capsules_to_collide_cylinders_to_see_and_masses():
    rng = np.random.default_rng(3)
    for _ in range(50):
        table = random_table(rng)
        urdf = to_urdf(table)
        model = pin.buildModelFromXML(urdf)
        collision = pin.buildGeomFromUrdfString(model, urdf, pin.COLLISION)
        visual = pin.buildGeomFromUrdfString(model, urdf, pin.VISUAL)
        assert all(isinstance(shape.geometry, coal.Capsule) for shape in collision.geometryObjects)
        assert all(isinstance(shape.geometry, coal.Cylinder) for shape in visual.geometryObjects)
        M = pin.crba(model, model.createData(), joints(model, table, random_q(table, rng)))
        assert np.linalg.eigvalsh(M).min() > 0


@pytest.mark.parametrize("name", catalogue())
def test_a_catalogue_robot_has_capsules_thin_against_its_length(name):
    shapes = [shape.geometry for shape in load_robot(name).collision_model.geometryObjects]
    length = sum(2 * shape.halfLength for shape in shapes)
    assert shapes
    assert all(isinstance(shape, coal.Capsule) and 0 < shape.radius < 0.05 * length for shape in shapes)


def test_the_capsules_of_an_arm_reach_from_each_axis_to_the_next():
    robot = load_robot("rv7fl")
    model, data, geometry = robot.model, robot.model.createData(), robot.collision_model
    placed = pin.GeometryData(geometry)
    q = np.full(model.nv, 0.4)
    pin.framesForwardKinematics(model, data, q)
    pin.updateGeometryPlacements(model, data, geometry, placed)
    for i in range(1, model.njoints):
        point = coal.Sphere(1e-9)
        touching = [
            coal.distance(
                shape.geometry, coal.Transform3s(M.rotation, M.translation),
                point, coal.Transform3s(np.eye(3), data.oMi[i].translation),
                coal.DistanceRequest(), coal.DistanceResult(),
            ) <= 0
            for shape, M in zip(geometry.geometryObjects, placed.oMg, strict=True)
        ]  # fmt: skip
        assert any(touching)


def test_a_slide_reaches_back_to_where_it_slides_from_wherever_it_is():
    slide = DHRow(type="prismatic", lower=-0.2, upper=0.7, d=0.1)
    urdf = to_urdf(DHTable("slide", "standard", (slide,)))
    model = pin.buildModelFromXML(urdf)
    (rail,) = pin.buildGeomFromUrdfString(model, urdf, pin.COLLISION).geometryObjects
    z = rail.placement.translation[2]
    for q in (slide.lower, slide.upper):
        assert z - rail.geometry.halfLength - 1e-12 <= -q <= z + rail.geometry.halfLength + 1e-12


@pytest.mark.parametrize("name", ['a&b<"', "it's > that", "Roboter Ü ∆", "a -- b", "&amp;"])
def test_names_that_need_escaping_come_back_as_they_were(name):
    table = DHTable(name, "standard", (DHRow(a=1.0, name=name + "1"), DHRow(a=0.5, name=name + "2")))
    urdf = to_urdf(table)
    model = pin.buildModelFromXML(urdf)
    assert model.name == name
    assert list(model.names)[1:] == [name + "1", name + "2"]
    assert pin.buildGeomFromUrdfString(model, urdf, pin.COLLISION).ngeoms == 2


@pytest.mark.parametrize("name", ["base_link", "link_1", "flange", "tool0", "tool0_joint", "world", "universe"])
def test_a_joint_cannot_take_the_name_of_a_part_of_the_urdf(name):
    with pytest.raises(InvalidTable, match=f"cannot be named '{name}'"):
        to_urdf(DHTable("r", "standard", (DHRow(name=name),)))


def test_numpy_numbers_are_written_as_numbers():
    row = DHRow(a=np.float64(0.3), lower=np.float64(-1), upper=np.float64(1), velocity=np.float64(2))
    assert "np." not in to_urdf(DHTable("r", "standard", (row,)))


def test_the_written_folder_is_what_the_catalogue_gives(tmp_path):
    written = write_urdfs(tmp_path / "urdf")
    assert sorted(file.name for file in written) == sorted(file.name for file in URDF.glob("*.urdf"))
    for file in written:
        assert file.read_bytes() == (URDF / file.name).read_bytes(), f"run: pin-metaik urdf --all ({file.name} differs)"
