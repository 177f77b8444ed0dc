# SPDX-License-Identifier: Apache-2.0
"""How tools/bench_report.py writes tables into the page on benchmarks."""

import bench_report
import bench_threads
import pytest

PAGE = """# Page

## Results

| a | b |
|---|---|
| old | 1 |

### Inner

| a | b |
|---|---|
| old | 2 |

Text.

## Other

| a | b |
|---|---|
| kept | 3 |
"""


def table(value):
    return f"| a | b |\n|---|---|\n| new | {value} |\n"


def test_tables_of_equal_columns_are_replaced_in_order():
    found = bench_report.replaced(PAGE, "## Results", [table(10), table(20)])
    expected = PAGE.replace("| old | 1 |", "| new | 10 |").replace("| old | 2 |", "| new | 20 |")
    assert found == expected


def test_a_section_ends_at_the_next_heading_of_its_level():
    found = bench_report.replaced(PAGE, "### Inner", [table(20)])
    assert found == PAGE.replace("| old | 2 |", "| new | 20 |")


def test_a_table_without_a_place_is_an_error():
    with pytest.raises(ValueError, match="## Other has no table"):
        bench_report.replaced(PAGE, "## Other", [table(1), table(2)])


def test_an_image_is_added_once_at_the_end_of_a_section():
    found = bench_report.with_image(PAGE, "### Inner", "plot", "What it shows")
    assert found == PAGE.replace("Text.\n", "Text.\n\n![What it shows](images/plot.png)\n")
    assert bench_report.with_image(found, "### Inner", "plot", "What it shows") == found


def test_calls_on_threads_fill_the_table_of_the_page():
    found = {"a call": {1: 0.2, 2: 0.1}, bench_threads.OPENING: {1: 0.5, 2: 0.25}}
    table = bench_threads.table(found)
    assert list(bench_report.rows(table)) == [
        {"Python": "a call", "one thread": "200", "all threads": "100", "ratio": "2.00"},
        {
            "Python": bench_threads.OPENING,
            "one thread": "500",
            "all threads": "250",
            "ratio": "2.00",
        },
    ]
    assert bench_report.header(table) in bench_report.PAGE.read_text()


def test_rows_have_the_names_of_columns():
    assert list(bench_report.rows(table(5))) == [{"a": "new", "b": "5"}]


def test_the_page_has_a_place_for_each_run():
    page = bench_report.PAGE.read_text()
    for run in bench_report.RUNS.values():
        begin, end = bench_report.section(page, run.heading)
        assert bench_report.tables(page[begin:end])
