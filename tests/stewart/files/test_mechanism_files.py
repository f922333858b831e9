from dataclasses import replace
from decimal import Decimal

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from pin_metaik.errors import InvalidBounds, InvalidGeometry, InvalidSetting, InvalidTable, UnknownName
from pin_metaik.optimize import ALGORITHMS, make
from pin_metaik.optimize.pso import PSO
from pin_metaik.stewart import (
    DesignTask,
    Dexterity,
    Grid,
    LegLimits,
    Mechanism,
    Ranges,
    design,
    load_mechanism,
    mechanism_names,
    read_mechanism,
    save_mechanism,
    standard_geometry,
    to_toml,
)
from pin_metaik.stewart.files.library import FOLDER
from pin_metaik.units import ANGLES, LENGTHS
from tests.stewart.cases import cube, reference, stroke

FILE = """
name = "octahedron"
length = "mm"
angle = "deg"

[base]
radius = 200
angles = [0, 120, 240]

[platform]
radius = 100
angles = [60, 180, 300]
reference = [0, 0, 20]

[legs]
base = [1, 1, 2, 2, 3, 3]
platform = [3, 1, 1, 2, 2, 3]
shortest = 250
longest = 350
base_angle = 45
distance = 20
home = [0, 0, 250]

[workspace]
counts = [20, 20, 20]
x = [-100, 100]
steps = [5, 5, 1]
roll = [-10, 10]
pitch = [-10, 10]

[dexterity]
norm = "two"
length = 120

[design]
algorithm = "qpso"
evaluations = 600
seed = 4
from_current = true
index = "lci"
threshold = 0.3
weights = [0.5, 0.5]
cube = 150
least_workspace = 0.01
joint_gap = 42
settings = { agents = 30, beta_end = 0.4 }

[design.ranges]
base_radius = [42, 315]
base_angles = [0, [60, 180], [180, 300]]
longest = [340, 360]

[design.workspace]
counts = [14, 14, 14]
"""


@pytest.fixture
def write(tmp_path):
    def write(text: str):
        path = tmp_path / "platform.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return write


def test_a_file_is_read_into_metres_and_radians(write):
    mechanism = read_mechanism(write(FILE))
    geometry, limits, task = mechanism.geometry, mechanism.limits, mechanism.task
    assert (geometry.base_radius, geometry.platform_radius, geometry.reference) == (0.2, 0.1, (0, 0, 0.02))
    assert geometry.legs == ((0, 2), (0, 0), (1, 0), (1, 1), (2, 1), (2, 2))
    assert_allclose(geometry.base_angles, np.radians([0, 120, 240]), rtol=1e-15)
    assert (limits.shortest, limits.longest, limits.distance, limits.home) == (0.25, 0.35, 0.02, (0, 0, 0.25))
    assert_allclose([limits.base_angle, limits.platform_angle], [np.pi / 4, np.pi], rtol=1e-15)
    assert mechanism.grid.x == (-0.1, 0.1)
    assert mechanism.grid.y is None
    assert mechanism.grid.steps == (5, 5, 1)
    assert mechanism.dexterity == Dexterity("two", 0.12)
    assert task.ranges.base_angles[0] == 0.0
    assert_allclose(task.ranges.base_angles[1:], np.radians([[60, 180], [180, 300]]), rtol=1e-15)
    assert (task.algorithm.agents, task.algorithm.beta_end, task.algorithm.beta_start) == (30, 0.4, 1.0)
    assert (task.index, task.threshold, task.weights, task.cube, task.joint_gap) == (
        "lci",
        0.3,
        (0.5, 0.5),
        0.15,
        0.042,
    )
    assert (task.evaluations, task.seed, task.from_current) == (600, 4, True)
    assert task.grid == Grid((14, 14, 14))


@pytest.mark.parametrize("name", mechanism_names())
def test_the_catalogue_is_written_as_this_package_writes(name):  # A14
    mechanism = load_mechanism(name)
    assert mechanism.name == name
    assert to_toml(mechanism) == (FOLDER / f"{name}.toml").read_text(encoding="utf-8")


def test_saving_loading_and_running_again_changes_nothing(tmp_path):  # A14
    mechanism = replace(stroke(100), task=replace(stroke(100).task, evaluations=180))
    first = save_mechanism(mechanism, tmp_path / "first.toml")
    loaded = load_mechanism(first)
    assert loaded == mechanism
    assert save_mechanism(loaded, tmp_path / "second.toml").read_bytes() == first.read_bytes()
    found, again = design(mechanism), design(loaded)
    assert found.mechanism == again.mechanism
    assert found.score == again.score
    assert_array_equal(found.history, again.history)
    designed = save_mechanism(found.mechanism, tmp_path / "designed.toml")
    reloaded = load_mechanism(designed)
    assert reloaded == found.mechanism  # to the last bit
    assert reloaded.survey().gdi == found.mechanism.survey().gdi
    rerun = design(reloaded)
    assert save_mechanism(rerun.mechanism, tmp_path / "rerun.toml").read_bytes() == designed.read_bytes()


def test_everything_there_is_survives_a_file(write):
    rng = np.random.default_rng(0)
    for unit in LENGTHS:
        angles = tuple(np.sort(rng.uniform(0, 6, 3)))
        mechanism = Mechanism(
            'a "name" with \\ and ü',
            replace(cube(0.1), base_radius=rng.uniform(), base_angles=angles, reference=tuple(rng.normal(size=3) / 7)),
            LegLimits(0.1 / 3, 1 / 3, 0.7, 1 / 7, 1e-9, tuple(rng.normal(size=3))),
            Grid((3, 4, 5), (-1 / 3, 1 / 7), None, (0, 1e-12), (2, 3, 1), (-0.1, 0.1), (0.3, 0.3), (-1, 2)),
            Dexterity("two", 1 / 9),
            DesignTask(
                Ranges((0.1, 1 / 3), 1 / 7, (0.0, (1 / 3, 2.0), 3.0), None, 0.1, (0.2, 0.7)),
                "lci",
                1 / 3,
                (1 / 3, 2 / 3),
                0.1 / 3,
                0.01 / 7,
                1e-3 / 7,
                Grid((2, 2, 2)),
                PSO(agents=7, v_max=0.3, c1=1 / 3),
                77,
                5,
                True,
            ),
            unit,
            "one\nline and another",
            "somewhere",
        )
        text = to_toml(mechanism)
        path = write(text)
        assert read_mechanism(path) == mechanism
        assert to_toml(read_mechanism(path)) == text


@pytest.mark.parametrize("algorithm", sorted(set(ALGORITHMS) - {"cmaes"}))
def test_every_metaheuristic_can_be_saved(algorithm, write):
    mechanism = replace(stroke(50), task=replace(stroke(50).task, algorithm=algorithm))
    assert read_mechanism(write(to_toml(mechanism))).task.algorithm == make(algorithm)


def test_a_metaheuristic_of_ones_own_has_no_name_to_save():
    class Mine:
        def search(self, run):
            while True:
                yield run.start(1)

    with pytest.raises(InvalidSetting, match=r"has no name to save; known: .*pso"):
        to_toml(replace(stroke(50), task=replace(stroke(50).task, algorithm=Mine())))


def test_numbers_survive_their_unit():
    rng = np.random.default_rng(1)
    for unit in (*LENGTHS.values(), *ANGLES.values()):
        for value in [0.0, -0.0, 1.0, 0.1, 1 / 3, np.pi, *rng.normal(size=200), *(10.0 ** rng.uniform(-12, 6, 200))]:
            assert unit.read(Decimal(unit.write(float(value)))) == value
    assert LENGTHS["mm"].write(0.0451) == "45.1"
    assert ANGLES["deg"].write(np.radians(121.1)) == "121.1"


def test_a_connection_matrix_may_stand_for_the_two_lists(write):
    text = FILE.replace(
        "base = [1, 1, 2, 2, 3, 3]\nplatform = [3, 1, 1, 2, 2, 3]", "connection = [[1, 0, 1], [1, 1, 0], [0, 1, 1]]"
    )
    assert set(read_mechanism(write(text)).geometry.legs) == set(read_mechanism(write(FILE)).geometry.legs)


def test_the_tables_that_are_not_needed_can_be_left_out(write):
    short = read_mechanism(write(FILE[: FILE.index("[workspace]")]))
    assert (short.grid, short.dexterity, short.task) == (Grid(), Dexterity(), None)


# fmt: off
WRONG = {
    "an unknown key":
        ('name = "octahedron"', 'name = "octahedron"\ncolour = "red"', InvalidTable, "unknown key 'colour'"),
    "a misspelt key":
        ("radius = 200", "radus = 200", InvalidTable, r"base: unknown key 'radus'; did you mean 'radius'\?"),
    "a misspelt table": ("[workspace]", "[workspac]", InvalidTable, "unknown key 'workspac'; did you mean 'workspace'"),
    "a misspelt limit": ("distance = 20", "distence = 20", InvalidTable, "legs: unknown key 'distence'; did you mean"),
    "a misspelt range":
        ("longest = [340, 360]", "longst = [340, 360]", InvalidTable, "design.ranges: unknown key 'longst'"),
    "a misspelt setting": ("agents = 30", "agent = 30", InvalidTable, "design.settings: unknown key 'agent'; did you"),
    "a misspelt step":
        ("counts = [14, 14, 14]", "count = [14, 14, 14]", InvalidTable, "design.workspace: unknown key 'count'"),
    "a misspelt norm key": ('norm = "two"', 'nrom = "two"', InvalidTable, "dexterity: unknown key 'nrom'"),
    "no name": ('name = "octahedron"', "", InvalidTable, "name is missing"),
    "no unit": ('length = "mm"', "", InvalidTable, "length is missing"),
    "no radius": ("radius = 100", "", InvalidTable, "platform: radius is missing"),
    "no legs": ("base = [1, 1, 2, 2, 3, 3]\n", "", InvalidTable, "legs: base is missing"),
    "no ranges": ("[design.ranges]", "[design.other]", InvalidTable, "design: unknown key 'other'"),
    "an unknown unit": ('"mm"', '"inch"', InvalidTable, "length = 'inch' is not one of the units m, cm, mm"),
    "an unknown norm": ('norm = "two"', 'norm = "three"', InvalidSetting, "platform.toml: norm must be one of"),
    "an unknown length": ("length = 120", 'length = "rb"', InvalidSetting, "length is 'rm', 'best' or"),
    "an unknown algorithm": ('"qpso"', '"qqpso"', UnknownName, "no metaheuristic named 'qqpso'; did you mean 'qpso'"),
    "an unknown index": ('"lci"', '"lcd"', InvalidSetting, "index must be one of"),
    "text for a number":
        ("radius = 200", 'radius = "200"', InvalidTable, "base: radius = '200': '200' is not a number"),
    "true for a number": ("radius = 200", "radius = true", InvalidTable, "true is not a number"),
    "nan for a number": ("radius = 200", "radius = nan", InvalidTable, "nan is not finite"),
    "a number for a list": ("angles = [0, 120, 240]", "angles = 3", InvalidTable, "angles = 3 is not a list"),
    "a list for a table": ("[dexterity]\n", "[[dexterity]]\n", InvalidTable, "dexterity = .* is not a table"),
    "half a count":
        ("counts = [20, 20, 20]", "counts = [20.5, 20, 20]", InvalidTable, "counts = .* list of whole numbers"),
    "too few counts": ("counts = [20, 20, 20]", "counts = [20, 20]", InvalidTable, "is not a list of 3 numbers"),
    "half an evaluation":
        ("evaluations = 600", "evaluations = 6.5", InvalidTable, "evaluations = 6.5 is not a whole number"),
    "a flag that is none": ("from_current = true", "from_current = 1", InvalidTable, "is neither true nor false"),
    "a range of three": ("[42, 315]", "[42, 315, 400]", InvalidTable, "neither a number nor a range of two"),
    "a crossed range":
        ("[42, 315]", "[315, 42]", InvalidBounds, "platform.toml: the range of base_radius is two finite"),
    "a radius of zero": ("radius = 200", "radius = 0", InvalidGeometry, "platform.toml: base_radius is above zero"),
    "legs the wrong way":
        ("shortest = 250", "shortest = 400", InvalidGeometry, "0.4 m, is longer than the longest, 0.35 m"),
    "angles out of order":
        ("[60, 180, 300]", "[180, 60, 300]", InvalidGeometry, "M2 at 60 deg does not come after M1 at 180"),
    "a joint that does not exist":
        ("[3, 1, 1, 2, 2, 3]", "[3, 1, 1, 2, 2, 4]", InvalidGeometry, "leg 6 is joined to M4, which"),
    "more ends than others":
        ("[1, 1, 2, 2, 3, 3]", "[1, 1, 2, 2, 3]", InvalidTable, "base names 5 joints and platform 6"),
    "a bad setting": ("agents = 30", "agents = 0", InvalidSetting, "design.settings: agents must be a whole number"),
    "a setting of the wrong kind":
        ("agents = 30", 'agents = "many"', InvalidSetting, "design.settings: agents must be"),
    "settings of nothing": ('algorithm = "qpso"\n', "", InvalidTable, "name it, e.g. algorithm = 'pso'"),
    "an empty name": ('"octahedron"', '" "', InvalidSetting, "a mechanism has a name"),
    "a name that is no text": ('"octahedron"', "3", InvalidTable, "name = 3 is not text"),
    "a broken line": ("radius = 200", "radius = ", InvalidTable, "is not TOML"),
}
# fmt: on


@pytest.mark.parametrize("what", WRONG)
def test_a_mistake_is_named_with_its_place(what, write):
    old, new, error, message = WRONG[what]
    assert old in FILE
    with pytest.raises(error, match=message):
        read_mechanism(write(FILE.replace(old, new, 1)))


def test_files_that_are_none_are_named(tmp_path):
    with pytest.raises(InvalidTable, match=r"cannot read .*nowhere\.toml"):
        load_mechanism(tmp_path / "nowhere.toml")
    (tmp_path / "latin.toml").write_bytes(b'name = "\xff"')
    with pytest.raises(InvalidTable, match="not UTF-8"):
        load_mechanism(tmp_path / "latin.toml")
    with pytest.raises(UnknownName, match=r"no mechanism named 'stroke_10'.*stroke_100"):
        load_mechanism("stroke_10")


def test_a_unit_that_is_none_is_refused():
    with pytest.raises(InvalidSetting, match="unit is one of m, cm, mm, got 'inch'"):
        Mechanism("x", standard_geometry("3x3", 0.2, 0.1), LegLimits(0.2, 0.3), unit="inch")


def test_the_reference_is_written_in_its_unit():
    assert 'length = "mm"' in to_toml(reference())
    assert "radius = 250\n" in to_toml(reference())
    assert "radius = 0.25\n" in to_toml(replace(reference(), unit="m"))
