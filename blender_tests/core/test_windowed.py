"""Scripts of windows: steps that never run would be tests that cannot fail."""

import ast
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(HERE))
import run  # noqa: E402

SCRIPTS = sorted((HERE / "windowed").glob("*.py"))
TREES = {script: ast.parse(script.read_text()) for script in SCRIPTS}


def functions(tree):
    """Names, and whether each is a generator: a part of a script's steps."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef):
            yield node.name, any(isinstance(n, ast.Yield | ast.YieldFrom) for n in ast.walk(node))


EVERYWHERE = [f for tree in TREES.values() for f in functions(tree)]


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_all_steps_are_taken(script):
    parts = {name for name, generates in EVERYWHERE if generates} - {name for name, g in EVERYWHERE if not g}
    assert {"steps", "picture", "drag"} <= parts
    parts |= {name for name, generates in functions(TREES[script]) if generates}
    taken = {id(node.value) for node in ast.walk(TREES[script]) if isinstance(node, ast.YieldFrom)}
    for node in ast.walk(TREES[script]):
        if isinstance(node, ast.Call) and (name := getattr(node.func, "attr", getattr(node.func, "id", ""))) in parts:
            taken_by_the_driver = name in ("steps", "in_vain")
            assert id(node) in taken or taken_by_the_driver, f"{script.name}, line {node.lineno}: no step runs {name}"


def test_those_that_wait_for_an_autosave_begin_first():
    waiting = {script for script in SCRIPTS if "auto_save_time" in script.read_text()}
    first = run.longest_first()
    assert waiting and set(first[: len(waiting)]) == waiting
    assert set(first) == {script for script in SCRIPTS if script.stem.startswith(("tutorial_", "window_"))}
