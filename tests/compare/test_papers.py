import pytest
from rich.console import Console

from pin_metaik.cli.progress import progress_bar
from pin_metaik.compare.papers import PAPERS, Job, Options, Paper, reproduce
from pin_metaik.compare.report import Column, Section, Table


def counting(*works):
    """A paper of these jobs, reporting what they returned."""

    def sections(done, options):
        return [Section("Counted", (), (Table("counted", "Done", (Column("value"),), [(value,) for value in done]),))]

    jobs = [Job(f"job {i}", work) for i, work in enumerate(works)]
    return Paper("counting", "Counting", "nowhere, 2026", 1, lambda options: jobs, sections)


def stop():
    raise KeyboardInterrupt


@pytest.mark.parametrize("name", PAPERS)
def test_a_paper_is_registered_under_its_name_and_says_what_it_is(name):
    paper = PAPERS[name]
    assert paper.name == name
    assert paper.title and paper.source and paper.runs >= 1


@pytest.mark.parametrize("name", PAPERS)
def test_a_paper_reports_on_nothing_without_an_error(name):
    sections = PAPERS[name].sections([], Options(1))
    assert sections
    names = [table.name for section in sections for table in section.tables]
    assert len(set(names)) == len(names)


def test_the_report_is_made_of_what_the_jobs_returned():
    again = reproduce(counting(lambda: 1, lambda: 2), Options(1))
    assert again.sections[0].tables[0].rows == [(1,), (2,)]
    assert not again.partial
    assert "All 2 jobs done" in str(again)


def test_an_interrupt_keeps_what_is_done_and_says_so():
    with pytest.raises(KeyboardInterrupt) as press:
        reproduce(counting(lambda: 1, stop, lambda: 3), Options(1))
    again = press.value.result
    assert again.sections[0].tables[0].rows == [(1,)]
    assert again.partial
    assert "PARTIAL: interrupted after 1 of 3 jobs" in str(again)


def test_an_error_of_a_job_is_not_taken_for_an_interrupt():
    with pytest.raises(ZeroDivisionError):
        reproduce(counting(lambda: 1, lambda: 1 / 0), Options(1))


def test_the_progress_bar_shows_on_the_console_that_is_given():
    console = Console(record=True, force_terminal=True, width=80)
    with progress_bar("working", console) as watch:
        reproduce(counting(lambda: 1), Options(1), watch)
    assert "counting" in console.export_text()


def test_a_watch_ends_an_experiment_which_reports_on_what_is_done():
    again = reproduce(counting(lambda: 1, lambda: 2, lambda: 3), Options(1), lambda at: at.done >= 2)
    assert again.partial
    assert again.done == 2


def test_the_same_key_gives_the_same_numbers_and_another_seed_others():
    def draws(rng, *key):
        return Options(1, rng=rng).generator(*key).random(3).tolist()

    assert draws(0, 1, 2) == draws(0, 1, 2)
    assert draws(0, 1, 2) != draws(0, 2, 1)
    assert draws(0, 1, 2) != draws(1, 1, 2)
