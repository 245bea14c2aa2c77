"""_core.pyi is what the built module says of itself."""

import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest

TOOLS = Path(__file__).parents[3] / "tools"


def check():
    return subprocess.run([sys.executable, TOOLS / "stubs.py", "--check"], capture_output=True, text=True, timeout=300)


@pytest.mark.skipif(importlib.util.find_spec("pybind11_stubgen") is None, reason="pybind11-stubgen is not installed")
def test_the_shipped_stub_matches_the_built_module():
    done = check()
    assert done.returncode == 0, done.stdout + done.stderr
