"""tools/bench_docs.py: what a mark selects of a measured table."""

from __future__ import annotations

import pytest

from bench_docs import BLOCK, select
from shell import StepError

TABLE = """| part | h mm | time |
|---|---|---|
| box | 0.5 | 1 ms |
| box | 0.1 | 9 ms |
| ball | 0.5 | |

Medians of three.
"""


def test_without_a_selection_a_table_stays():
    assert select("a/b", TABLE, "") == TABLE.replace("| |", "|  |")


def test_rows_columns_and_note_are_copied():
    chosen = select("a/b", TABLE, ' rows="^. box" columns="part; time" note="no"')
    assert chosen == "| part | time |\n|---|---|\n| box | 1 ms |\n| box | 9 ms |\n"


def test_text_without_a_table_stays():
    assert select("a/about", "riffler 0.1.0\n", "") == "riffler 0.1.0\n"


@pytest.mark.parametrize("selection", [' columns="part; weight"', ' rows="cone"', ' row="box"'])
def test_a_selection_that_does_not_fit_is_an_error(selection):
    with pytest.raises(StepError, match="a/b"):
        select("a/b", TABLE, selection)


def test_a_mark_is_read_with_and_without_a_selection():
    marks = '<!-- bench a/b -->\nx\n<!-- end -->\n<!-- bench c/d rows="1" note="no" -->\ny\n<!-- end -->\n'
    assert [(m[1], m[2], m[3]) for m in BLOCK.findall(marks)] == [
        ("a/b", "", "x\n"), ("c/d", ' rows="1" note="no"', "y\n")
    ]  # fmt: skip
