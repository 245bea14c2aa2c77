"""Readers in Python: what fuzzing found stays refused, and a few hundred inputs more at each check."""

import random
import sys
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).parents[3] / "tools"))
sys.path.append(str(Path(__file__).parents[3]))
import fuzz_python

RUNS = {"plan": 300, "curves": 300, "record": 300, "tools": 150, "threemf": 40}


@pytest.mark.parametrize("name", fuzz_python.TARGETS)
def test_inputs_are_read_or_refused(name):
    if name == "threemf":
        pytest.importorskip("lib3mf")
    inputs = []
    for place, data in fuzz_python.beginnings(name):
        try:
            fuzz_python.check(name, data)
        except Exception as error:
            pytest.fail(f"{place}: {type(error).__name__}: {error}")
        inputs.append(data)
    choose = random.Random(7)
    for _ in range(RUNS[name]):
        fuzz_python.check(name, fuzz_python.mutated(choose.choice(inputs), choose.choice(inputs), choose))
