"""Small parts of the stress of operations (machining_stress.py), with a fixed seed."""

import pytest
from machining_stress import Run


@pytest.mark.parametrize(("kind", "number"), [("terrain", 1), ("bodies", 3)])
def test_a_random_part_is_machined_without_a_fault(kind, number):
    run = Run(number, seed=3, threads=("1", "3"), names=(kind,), scale=0.4)
    assert run.run() == [], run.lines
    assert len(run.lines) >= 9
