# SPDX-License-Identifier: Apache-2.0
"""How tools/bench_report.py writes tables into the page on benchmarks."""

import bench_report
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


def test_rows_have_the_names_of_columns():
    assert list(bench_report.rows(table(5))) == [{"a": "new", "b": "5"}]


def test_the_page_has_a_place_for_each_run():
    page = bench_report.PAGE.read_text()
    for run in bench_report.RUNS.values():
        begin, end = bench_report.section(page, run.heading)
        assert bench_report.tables(page[begin:end])
