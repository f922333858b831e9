"""The page of promises has the figures of the pages that programs wrote, and names tests that exist."""

import trust


def test_the_page_of_promises_is_what_its_program_writes_of_the_others() -> None:
    assert trust.OUT.read_text(encoding="utf-8") == trust.text()
    assert all((trust.ROOT / test).exists() for promise in trust.PROMISES for test in promise.tests)
