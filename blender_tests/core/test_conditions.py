"""The text that explains why a window's script waited in vain."""

import sys
from pathlib import Path
from types import SimpleNamespace

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from support.conditions import LONGEST, explain

LIMIT = 100


def test_a_lambda_shows_its_operands():
    run = SimpleNamespace(torque=31.5, touching="cutter")
    lines = explain(lambda: run.torque > LIMIT and run.touching == "cutter" and not run.missing).splitlines()
    assert lines[0].endswith("False now") and lines[0].startswith("run.torque > LIMIT and run.touching")
    assert "  run.torque = 31.5" in lines and "  LIMIT = 100" in lines and "  run.touching = 'cutter'" in lines
    assert any(line.startswith("  run.missing = AttributeError") for line in lines)


def test_operands_within_calls_and_differences_are_shown():
    point, goal = SimpleNamespace(at=7), 18
    lines = explain(lambda: abs(point.at - goal) <= 1).splitlines()
    assert lines[0] == "abs(point.at - goal) <= 1: False now"
    assert {"  abs(point.at - goal) = 11", "  point.at = 7", "  goal = 18"} <= set(lines)


def test_a_function_shows_its_variables_and_those_it_shares():
    said, count = None, 3

    def shown():
        nonlocal said
        said = ("free", True)
        known = [number for number in range(count) if number < LIMIT]
        return len(known) > count and said[1]

    text = explain(shown)
    assert text.startswith("len(known) > count and said[1]: False now")
    assert all(line in text.splitlines() for line in ("  len(known) = 3", "  said[1] = True", "  known: [0, 1, 2]"))
    assert "  said: ('free', True)" in text.splitlines()


def test_operands_with_comprehensions_see_the_variables():
    names, wanted = ["Stock", "Cube"], "Ball"
    text = explain(lambda: wanted in [name for name in names if name != wanted])
    assert "  [name for name in names if name != wanted] = ['Stock', 'Cube']" in text.splitlines()


def test_an_error_and_a_long_value_do_not_hide_the_rest():
    def broken():
        return {}["key"]

    assert "KeyError" in explain(broken)
    many = list(range(1000))
    lines = explain(lambda: many == 0).splitlines()
    assert max(map(len, lines)) < LONGEST + 30


def test_a_condition_that_is_no_python_function_shows_its_result():
    assert explain([].__len__) == "the condition is 0 now"
