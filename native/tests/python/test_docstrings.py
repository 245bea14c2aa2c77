"""Every public function, method and class has a docstring with an example, and the example is right."""

import doctest
import functools
import inspect
import os
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
import riffler

# Names that have no example yet, one a line: the list may only shrink.
ALLOWANCE = Path(__file__).with_name("without_example.txt")
MODULES = ("", "plan", "job", "pen", "cluster", "shape", "cad")
# Classes whose objects are given and not made by users; what their attributes mean is in their docstrings.
RESULTS = (riffler.deprecated.DictResult, tuple, Exception)


def is_made_by_users(cls):
    return not issubclass(cls, RESULTS) and "__init__" in vars(cls)


def public():
    """(name, object) of everything that should have an example."""
    for module in MODULES:
        owner = getattr(riffler, module) if module else riffler
        for name in owner.__all__:
            value, full = getattr(owner, name), f"{module}.{name}".lstrip(".")
            if inspect.isclass(value):
                if is_made_by_users(value):
                    yield full, value
                yield from methods(full, value)
            elif callable(value):
                yield full, value


def methods(full, cls):
    for name, member in vars(cls).items():
        if name.startswith("_") or isinstance(member, property | riffler.deprecated.OldAttribute):
            continue
        if callable(getattr(cls, name)) and not inspect.isclass(getattr(cls, name)):
            yield f"{full}.{name}", getattr(cls, name)


NAMES = dict(public())


def doc_of(value):
    return inspect.getdoc(value) or ""


def has_example(value):
    """Or says where it is: "See `save`."."""
    doc = doc_of(value)
    return ">>> " in doc or "See `" in doc or "see `" in doc


def test_the_list_of_missing_examples_is_exact():
    missing = sorted(name for name, value in NAMES.items() if not has_example(value))
    if os.environ.get("RIFFLER_UPDATE"):
        ALLOWANCE.write_text("".join(f"{name}\n" for name in missing))
    allowed = ALLOWANCE.read_text().split()
    assert set(missing) - set(allowed) == set(), "no example"
    assert set(allowed) - set(missing) == set(), "these have an example now: RIFFLER_UPDATE=1 takes them off the list"


@functools.cache
def step_file():
    """The assembly in inches of test_cad.py."""
    if find_spec("OCP") is None:
        pytest.skip("the package cadquery-ocp-novtk is not installed")
    with tempfile.TemporaryDirectory() as folder:
        program = Path(__file__).with_name("cad_files.py")
        subprocess.run([sys.executable, str(program), folder], check=True, capture_output=True)
        return Path(folder, "assembly.step").read_bytes()


@pytest.mark.parametrize("name", [name for name, value in NAMES.items() if ">>> " in doc_of(value)])
def test_an_example_gives_its_stated_result(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    if 'read("part.step"' in doc_of(NAMES[name]):
        (tmp_path / "part.step").write_bytes(step_file())
    found = doctest.DocTestParser().get_doctest(
        doc_of(NAMES[name]), {"riffler": riffler, "np": np}, name, None, None
    )  # fmt: skip
    said = []
    failed = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE).run(found, out=said.append).failed
    assert not failed, "".join(said)


SECTIONS = ("Parameters", "Returns", "Raises", "Examples")


@pytest.mark.parametrize("name", [name for name, value in NAMES.items() if "Parameters\n---" in doc_of(value)])
def test_documented_arguments_are_those_of_the_signature(name):
    """So that messages on wrong arguments find what each must be."""
    documented = set(riffler.hints._documented(doc_of(NAMES[name])))
    there = {p.name for p in inspect.signature(NAMES[name]).parameters.values()} - {"self", "args", "kwargs"}
    assert there <= documented, f"not documented: {there - documented}"
    assert documented <= there, f"no such argument: {documented - there}"
