from dataclasses import replace

import pytest
from numpy.testing import assert_allclose
from typer.testing import CliRunner

from pin_metaik import cli, stewart
from pin_metaik.compare.papers import Options
from pin_metaik.compare.papers import stewart as paper
from pin_metaik.stewart import Grid, Verdict


@pytest.fixture
def coarse(monkeypatch):
    """The catalogue with coarse grids."""

    def load(name):
        mechanism = stewart.load_mechanism(name)
        return replace(mechanism, grid=Grid((40, 40, 40)))

    monkeypatch.setattr(paper, "load_mechanism", load)
    monkeypatch.setattr(paper, "FINE", (20, 20, 20))
    monkeypatch.setattr(paper, "SHORT", 120)


YAW = {50: -23.2, 100: -20.3, 150: -7.8, 200: -31.6, 250: -33.2}


@pytest.mark.parametrize("mm", paper.STROKES)
def test_the_printed_platforms_are_turned_against_their_bases(mm):
    geometry = stewart.load_mechanism(f"stroke_{mm}").geometry
    assert_allclose(paper.yaw(geometry) * 57.29577951, YAW[mm], atol=0.05)


def test_the_printed_connections_are_a_misprint(coarse):
    read, printed = (paper.evaluate(50, reading).workspace for reading in ("literal", "connections as printed"))
    assert read.verdict is Verdict.REGULAR
    assert_allclose(printed.gdi, 0.469, atol=0.02)


def test_centring_gives_the_printed_volume_of_stroke_50_only(coarse):
    assert_allclose(1e6 * paper.evaluate(50, "centred").workspace.volume, 114.9, rtol=0.03)
    assert paper.evaluate(200, "centred").workspace.gdi > 1.01 * paper.GDI[200]


@pytest.mark.parametrize(
    ("ours", "printed", "said"), [(0.92, 0.918, "yes"), (0.876, 0.829, "no, +6 %"), (7978, 1344, "no, x 5.9")]
)
def test_a_number_is_reproduced_or_said_to_be_off(ours, printed, said):
    assert paper.near(ours, printed) == said


def test_the_command_says_what_is_and_what_is_not_reproduced(coarse, tmp_path):
    done = CliRunner().invoke(cli.app, ["reproduce", "stewart", "--quick", "--runs", "1", "--out", str(tmp_path)])
    assert done.exit_code == 0, done.output
    for text in (
        "GDI paper",
        "cm3 paper",
        "no, +6 %",
        "guesses",
        "Not reproducible",
        "0.78 GDI + 0.22 V / (2 stroke)^3",
    ):
        assert text in done.output
    tables = {"table_1", "readings", "lengths", "methods", "optima"}
    names = {path.name for path in tmp_path.iterdir()}
    assert names >= {"stewart.md", *(f"stewart_{table}.csv" for table in tables)}


def test_an_interrupted_job_is_no_result(coarse, monkeypatch):
    def interrupted(mechanism, rng):
        def press(at):
            raise KeyboardInterrupt

        return stewart.design(mechanism, rng=rng, watch=press)

    monkeypatch.setattr(paper, "design", interrupted)
    with pytest.raises(KeyboardInterrupt):
        paper.optimise(50, "PSO", 120, Options(1).generator(0))


def test_a_report_on_nothing_is_empty_tables():
    for section in paper.sections([], Options(1)):
        assert not section.figures
        for table in section.tables:
            assert all(len(row) == len(table.columns) for row in table.rows)
